"""Decisions where the documents of this control are silent."""

from twin.nc.control.dialect import Decision

DECISIONS = (
    Decision(
        "What do an omitted R or Q keep after a Cartesian move or a new G30?",
        "The current point's polar value about the current origin.",
        "It is identical where the last move was polar and the origin is unchanged.",
        example="omitted_after_cartesian",
    ),
    Decision(
        "Is R0 allowed?",
        "For G00 and G01; for arcs it is a program error.",
        "The manual's own example ends with R0 Q90; an arc of radius 0 is none.",
        example="radius_zero",
    ),
    Decision(
        "What if a helix's end point and pitch disagree?",
        "The end point and the height win, whole turns = nearest fit, with a warning.",
        "The end point is what the next block relies on.",
        example="helix_disagrees",
    ),
    Decision(
        "How does the rotary axis C read G90 targets?",
        "As commanded (linear-like); the machine option module_rotary makes the sign the "
        "direction, by less than one turn.",
        "The axis type is a machine parameter.",
        example="rotary_as_commanded",
    ),
    Decision(
        "What is R in an arc block?",
        "With a coordinate of the plane the circle's radius, without one the polar radius.",
        "The forms of the manual differ in nothing else.",
        example="radius_of_arc_or_pole",
    ),
    Decision(
        "When does G30 in a motion block take effect?",
        "Before the motion.",
        "It says where the block's R and Q are measured from.",
        example="pole_in_a_motion_block",
    ),
    Decision(
        "Which sign has a helix's pitch?",
        "None: the height gives the direction.",
        "The manual's height -90 with K17 is legal.",
        example="pitch_without_sign",
    ),
    Decision(
        "What does G53 do?",
        "Coordinates count from machine zero until the next work offset.",
        "The quick reference calls it the cancelling of offsets.",
        example="offsets_cancelled",
    ),
    Decision(
        "How does G50 pass corners?",
        "On the exact path; G05 may round them by the machine's tolerance, G07 stops.",
        "G50 goes on when the theoretical move has ended, without waiting for the position.",
        example="corners",
    ),
    Decision(
        "How does compensation (G137) pass outside corners?",
        "Between lines that turn by 90 degrees or less the parallels are extended until they meet; "
        "other corners are rolled around, and with G136 all of them.",
        "A longer extension leaves the contour without need.",
        example="square_corners",
    ),
    Decision(
        "How do the leads of compensation go (G138, G139)?",
        "G138 straight to the point beside the contour's first; G139 the same, but around the "
        "contour's first and last point where the straight path would cut them off.",
        "The manual calls the one direct and the other indirect.",
        example="leads",
    ),
    Decision(
        "How does the tool change sides, G42 while G41 is in force?",
        "Where the compensated paths of the move before and behind cross; where they do not, straight from the end of "
        "the one, square to it, to the beginning of the other, square to that.",
        "The manual says so.",
        example="side_changes",
    ),
    Decision(
        "What do G36 and G39 do?",
        "In a block of their own between two moves with a feed: G36 rounds the corner by the radius "
        "I, G39 cuts both moves at the distance I; I stays for the next of them; compensation acts "
        "on the blended contour.",
        "The quick reference names the codes alone.",
        example="blends",
    ),
    Decision(
        "Where does an arc end with G264?",
        "Where the direction of the programmed end meets the circle through the start.",
        "The centre is not corrected, and the radius is the start's.",
        example="centre_not_corrected",
    ),
    Decision(
        "How do G82 and G83 drill?",
        "G83: J pecks of I each. G82: B is the first peck, R the factor of each next one, L the "
        "least; after each the tool lifts by H, after every J of them, or where H is missing, to the "
        "reference plane, and returns with rapid to C (1 mm) above where it was.",
        "The manuals at hand name the words; these meanings are those of the family.",
        example="pecks",
    ),
    Decision(
        "Which path mills a pocket (G87, G88)?",
        "Each depth plunges at the centre and clears outwards along parallels of the wall, C apart "
        "at most; the finishing pass runs once along the wall at the full depth; corners are M0 as "
        "round as the tool, M1 rounded by Q, M2 cut off at the distance Q.",
        "The manual gives the pocket and its words, not the path.",
        example="pockets",
    ),
    Decision(
        "How often does NR run a block?",
        "As often as it says, the block's own run included.",
        "A number of repetitions of 1 is a block that runs.",
        example="repeated_block",
    ),
    Decision(
        "What if a $CASE runs into the next?",
        "A program error that asks for $BREAK.",
        "The manual's examples all end with $BREAK.",
        example="case_without_break",
    ),
    Decision(
        "What if a rotation (G73) begins while another is in force?",
        "A program error.",
        "Adding and replacing are both known among controls.",
        example="rotation_in_rotation",
    ),
    Decision(
        "Which way do arcs turn in G20?",
        "G03 turns from the abscissa towards the ordinate.",
        "It is so in G17, G18 and G19.",
        example="arcs_in_g20",
    ),
    Decision(
        "What if the program ends without M30?",
        "Its last line ends it, with a warning.",
        "Nothing else can follow.",
        example="missing_end",
    ),
    Decision(
        "What does D name?",
        "D1 is the tool's own length and radius, D0 none; M06 brings D1.",
        "The job's tools have one offset each.",
        example="tool_offset",
    ),
    Decision(
        "What does #MCS count from?",
        "The axes' own zero: no offset, preset, tool length or transformation acts; polar coordinates "
        "(E1305) and changes of these are refused while it is in force.",
        "The quick reference calls it programming in machine coordinates.",
        example="machine_coordinates",
    ),
    Decision(
        "When does a value count that a program writes into the table of zero offsets?",
        "When that offset is selected the next time; V.A.ORGT[1] is G54, values count from machine "
        "zero.",
        "Published post-processors write the table and select the offset behind it.",
        example="offset_table_written",
    ),
    Decision(
        "Which subroutine is #CALL L100?",
        "L100; where there is none the one of %L 100.",
        "A published post-processor writes the pair so.",
        example="numbered_subroutine",
    ),
    Decision(
        "What does #ROUNDPAR set?",
        "Kinds 1 and 4 how far G05 may round corners; other kinds are refused.",
        "They shape the curve, which the twin chooses itself.",
        example="corner_of_roundpar",
    ),
    Decision(
        "Which modes of #CS and #ACS are followed?",
        "1 (turns about X, the new Y and the new Z), 2 (about Z, the new Y and the new Z) and 6 (perpendicular to the tool "
        "where it is, then about the new Z); 3 to 5 are refused.",
        "Those take angles between the plane and axes, whose sense a figure alone shows.",
        example="mode_by_figure",
    ),
    Decision(
        "How does #TOOL ORI turn the tool?",
        "During the next block, which goes straight: the tip goes to its end in the plane on a line, the rotary axes evenly "
        "to the nearest solution, or to the one that FIRST (main axis nearest to zero) or SECOND names.",
        "The manual turns it during the first block that moves, and shows no path.",
        example="tool_orientation",
    ),
    Decision(
        "What ends with #CS NEW, and what moves offsets under #CS?",
        "#CS NEW alone ends all systems of its kind; work offsets and presets are refused until #CS OFF ALL and "
        "#ACS OFF ALL.",
        "The manual advises it at the start against planes that were left; of offsets its public pages do not speak.",
        example="offset_in_a_plane",
    ),
    Decision(
        "How does G84 tap with B?",
        "In passes of B with the feed, back by H, or without it to the reference plane, with the "
        "spindle reversed.",
        "The tap stays in its thread; the family's rigid tapping with chip breaking does so.",
        example="tapping_in_passes",
    ),
)
