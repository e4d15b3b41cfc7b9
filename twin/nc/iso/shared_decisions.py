"""Decisions about the base of ISO 6983-1 that ``gost`` and ``mefi`` share."""

from twin.nc.control.dialect import Decision

DECISIONS = (
    Decision(
        "Which codes are in force when a program starts?",
        "G17 G40 G49 G71 G80 G90 G94; none moves until G0, G1, G2 or G3 is programmed.",
        "The pages do not say; a program that moves without a code would be a guess.",
        example="start_state",
    ),
    Decision(
        "How far may start and end of an arc differ in their distance from the centre?",
        "By 0.01 mm or 0.1 % of the radius; the centre is then moved to fit, by 0.1 mm or 1 % of "
        "the radius at most.",
        "Programs rounded to 0.001 mm stay far below it; nearly full circles magnify it.",
        example="arc_centre_moved_to_fit",
    ),
    Decision(
        "Where do work offsets count from?",
        "G54 to G59 count from the job's part zero, G54 is part zero itself where the job gives it "
        "no values; a work offset ends a preset (G92); G53 puts coordinates back to machine zero.",
        "The job says where part zero lies on the machine.",
        example="work_offset_ends_preset",
    ),
    Decision(
        "What do D and H name?",
        "The tool of the job whose radius or length compensates; without them the tool in the "
        "spindle. Lengths count against the job's first tool.",
        "The job's tools have one offset each.",
        example="tools_by_d_and_h",
    ),
    Decision(
        "How does radius compensation pass corners?",
        "Outside corners are rolled around, inside corners end where the parallel paths meet; the "
        "straight lead-in ends square to the contour, the straight lead-out starts square to it; "
        "what does not fit is refused, and so is a neck of the contour that is narrower than the "
        "tool, as far as 50 elements lie between its sides; a lead that cuts into the contour is "
        "driven with a warning.",
        "It keeps the tool's edge on the contour and leaves it nowhere; leads are the programmer's.",
        example="compensation_corners",
    ),
    Decision(
        "What do drilling cycles do?",
        "Z R P Q stay in force until G80 or a motion code; R counts from the tool and Z from R with "
        "G91; a cycle block without a hole drills where the tool stands.",
        "ISO 6983-1 names the cycles and leaves their words to the control.",
        example="drilling_words_stay",
    ),
    Decision(
        "How long is G4?",
        "The seconds of P, X or F.",
        "All three are in use; seconds are their common unit.",
        example="dwell_in_seconds",
    ),
)
