"""Decisions about Grbl where its documentation is silent, or a simulated machine needs an answer."""

from twin.nc.control.dialect import Decision

DECISIONS = (
    Decision(
        "How does a path pass its corners?",
        "Rounded, by 0.010 mm at most.",
        "Grbl passes corners at the speed that a circle of its junction deviation ($11, 0.010 mm) allows, "
        "and jumps in velocity there; no axis can, and what it drives is near that circle.",
        example="corners_within_junction_deviation",
    ),
    Decision(
        "Which codes are in force when a program starts?",
        "G0 G17 G21 G40 G49 G54 G61 G80 G90 G91.1 G94, as behind a reset; no feed: a move with one is refused "
        "until F is written.",
        "A file is streamed to a control that was reset.",
        example="start_state",
    ),
    Decision(
        "How far may start and end of an arc differ in their distance from the centre?",
        "By 0.005 mm or 0.1 % of the radius, as in Grbl; the centre is then moved to fit.",
        "Grbl lets the radius change on the arc's last chord; the twin draws one circle.",
        example="arc_centre_moved_to_fit",
    ),
    Decision(
        "Where do coordinate systems count from?",
        "G54 is the job's part zero; G55 to G59 are the job's, or what G10 writes: L2 in machine coordinates, or "
        "so that the job's written_zero is part zero.",
        "The job says where part zero lies on the machine; a zero that nobody gave would be a guess.",
        example="systems_of_the_job",
    ),
    Decision(
        "What does G43.1 count from?",
        "From the tool that the job's part zero was taken with.",
        "Grbl has no tool table, and M6 is refused.",
        example="tool_length_by_z",
    ),
    Decision(
        "What ends a program?",
        "M2, M30 or its last line; what follows M2 or M30 is not run, and lines of % alone are left out.",
        "Grbl knows no programs and would run on; senders stop there, and strip %.",
        example="end_of_program",
    ),
    Decision(
        "Which lines with $ may stand in a program?",
        "$H, which drives Z and then X and Y to machine zero, and $X, which does nothing.",
        "Files that are streamed begin with them; the other commands are for the console (twin serve --grbl).",
        example="home_in_a_program",
    ),
)
