"""Decisions where the documents of this control are silent."""

from twin.nc.control.dialect import Decision

DECISIONS = (
    Decision(
        "How is the centre's deviation of 10 % measured?",
        "r_s = start to centre, r_e = end to centre: if |r_s - r_e| <= 0.1 max(r_s, r_e) the "
        "centre is projected on the perpendicular bisector (with a warning if it moved by more "
        "than 1 µm), else the block becomes a straight line, with a warning.",
        "The page names 10 % and no measure; its hint says that inconsistent arcs become lines.",
        example="centre_within_ten_per_cent",
    ),
    Decision(
        "What does R shorter than half the chord give?",
        "A straight line, with a warning.",
        "The page says so.",
        example="radius_too_short",
    ),
    Decision(
        "What does R give where start and end are one point?",
        "A program error: the centre is undefined.",
        "The page's sentence on full circles fits the centre method alone.",
        example="full_circle_by_radius",
    ),
    Decision(
        "What do I, J, K give where start and end are one point?",
        "A full circle.",
        "The page says that the system inserts a full circle.",
        example="full_circle_by_centre",
    ),
    Decision(
        "Which opening angles are allowed?",
        "Above 0 and up to 1080 degrees; others are a program error.",
        "The page allows three turns at most and no negative angle.",
        example="opening_above_three_turns",
    ),
    Decision(
        "What if T is programmed together with a target in the plane?",
        "T wins, with a warning.",
        "The page computes the target from T.",
        example="opening_wins",
    ),
    Decision(
        "Which way do arcs turn in G18?",
        "By ISO: seen from +Y; G18 G2 X200 R50 from X100 Z0 passes Z -50.",
        "The page does not say.",
        example="arc_in_g18",
    ),
    Decision(
        "Is the mode 2D or 3D when a program starts?",
        "2D (G15): arcs lie in X Y and Z runs along.",
        "The application decides; without b3DMode the decoder starts in 2D.",
        example="two_dimensions_at_start",
    ),
    Decision(
        "What is a centre coordinate that G98 leaves out?",
        "The start's.",
        "The centre then lies beside the start along the axis that was given.",
        example="absolute_centre_left_out",
    ),
    Decision(
        "Which unit have the angles of SIN, COS and TAN?",
        "Radians.",
        "They are functions of IEC 61131-3.",
        example="angles_in_radians",
    ),
    Decision(
        "How do additional axes move?",
        "Linearly with the path, A B C too; their slopes U V W are refused.",
        "A polynomial of third degree with the slopes of the straight path at both ends is the line.",
        example="additional_axes",
    ),
    Decision(
        "How does an axis go from G71 to G70?",
        "With one slope over the length of the path, from where it is at G71 to where the program "
        "has it at G70, or at its end.",
        "The library's page promises one slope and does not say what targets between them do.",
        example="evenly_over_several_moves",
    ),
    Decision(
        "How fast is G0?",
        "FF, else F; as fast as the machine can where the program has set neither.",
        "The manual says so; the defaults of FF and F are inputs of the application.",
        example="feed_of_g0",
    ),
    Decision(
        "How long are a spline's tangents?",
        "Half the distance of the neighbouring points; at the ends as long as the chord.",
        "The manual gives their directions only; this is a cardinal spline without tension.",
        example="spline_tangents",
    ),
    Decision(
        "Which arc does G52, which spline does G51 put into a corner?",
        "G52 one arc, or two of which each touches its move, between the points where the moves are "
        "cut; G51 a curve of degree 5 without a jump of curvature between straight moves.",
        "The manual says where the moves are cut, not what lies between.",
        example="what_fills_a_corner",
    ),
    Decision(
        "In which order do smoothing, radius compensation and loop avoidance act?",
        "In this order.",
        "The application chains its function blocks; the manual's examples differ.",
        example="smoothing_before_compensation",
    ),
    Decision(
        "How long may a loop be that G61 cuts out?",
        "32 moves.",
        "The control is limited by a buffer of the application.",
        example="loop_cut_out",
    ),
    Decision(
        "How does a path jump (G92)?",
        "Before the first move the given position is where it begins; later the axes travel there as "
        "fast as they can.",
        "A machine cannot jump; the manual's bAvoidGaps does the same.",
        example="position_set",
    ),
    Decision(
        "Which plane has G16 without I, J and K?",
        "The one in force.",
        "The manual's example of a jump begins so.",
        example="plane_without_normal",
    ),
    Decision(
        "What does G56 do?",
        "The place where the machine is gets the given coordinates.",
        "The manual calls it set reference.",
        example="reference_here",
    ),
    Decision(
        "How does a path pass its corners?",
        "Exactly; the speed falls to 0 where the direction changes and next to G0.",
        "The documentation's block transition speed.",
        example="exact_path",
    ),
)
