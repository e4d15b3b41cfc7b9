"""What the project decided where parameters or the machine's builder decide, or manuals are silent."""

from twin.nc.control.dialect import Decision

DECISIONS: tuple[Decision, ...] = (
    Decision(
        "What does a number without a decimal point count?",
        "Least increments: 0.001 mm, 0.0001 inch, 0.001 degree or second, 0.001 of a scale, 0.01 mm "
        'per revolution; F in G94 counts mm/min or 0.01 inch/min. decimal_point = "calculator" of '
        "the job or the machine file lets it count whole millimetres. The first one is warned of.",
        "Parameter 3401 #0 is 0 when a control comes from its maker.",
        example="decimal_point",
    ),
    Decision(
        "What does P of a dwell count?",
        "Milliseconds, also with calculator input; a decimal point in it is refused.",
        "The manual gives P no point.",
        example="dwell",
    ),
    Decision(
        "Which codes are in force when a program starts?",
        "G0 G15 G17 G21 G40 G49 G50 G50.1 G54 G64 G67 G69 G80 G90 G94 G97 G98.",
        "Parameters 3402 and their neighbours are 0 when a control comes from its maker.",
        example="start_state",
    ),
    Decision(
        "What do two G codes of one group mean in a block, as in G90 G28 G91 Z0?",
        "The last one counts, as the manual says.",
        "Posts write such blocks.",
        example="last_of_group",
    ),
    Decision(
        "What do the code of a cycle and G0 or G1 mean in one block?",
        "The last one counts: behind the cycle's code the motion moves, and R P Q K L are left out, with "
        "a warning. An arc behind it is refused.",
        "The manual says so of straight motions; an arc has words of its own by these letters.",
        example="motion_behind_a_cycle",
    ),
    Decision(
        "Which way does a rotary axis turn to an absolute angle?",
        'As the angle is written, over any number of turns. rollover = "shorter" or "sign" of the job or the machine file '
        "brings it there within a turn, the shorter way or in the direction of its sign; half a turn goes forwards.",
        "Parameter 1008 (ROA, RAB) is the builder's; 0 is how it comes from its maker.",
        example="rotary_targets",
    ),
    Decision(
        "Does F hold when G93, G94 or G95 changes?",
        "No: the first cutting move behind it is refused until F is written again.",
        "F200 in mm/min would become 200 mm with each turn.",
        example="feed_of_another_mode",
    ),
    Decision(
        "How does rapid positioning go?",
        "Straight to its end.",
        "Parameter 1401 #1 chooses; a straight path is the one that can be checked for collisions.",
        example="rapids_go_straight",
    ),
    Decision(
        "How does a path pass its corners?",
        "Exactly; G9 and G61 stop. G62, G63, G5 P10000, G5.1 and G8 change nothing of the path.",
        "What look-ahead rounds is a parameter of the machine.",
        example="exact_path",
    ),
    Decision(
        "How far may start and end of an arc differ in their distance from the centre?",
        "By 0.01 mm or 0.1 % of the radius; the centre is then moved to fit, by 0.1 mm or 1 % of "
        "the radius at most.",
        "Parameter 3410 decides; programs rounded to 0.001 mm stay far below it.",
        example="arc_centre_moved_to_fit",
    ),
    Decision(
        "How does compensation begin and end?",
        "By type A: the lead-in ends square to the contour's first element, the lead-out starts "
        "square to its last one.",
        "Parameter 5003 #0 is 0 when a control comes from its maker.",
        example="compensation_start",
    ),
    Decision(
        "How does compensation pass outside corners?",
        "Lines are extended to where their parallels meet, up to a turn of 90 degrees; sharper "
        "corners, and those of arcs, are rolled around.",
        "Parameter 19607 #2 is 0, which extends; how far beyond 90 degrees the documents at hand "
        "leave open, and the edge stays on the contour either way.",
        example="compensation_corners",
    ),
    Decision(
        "What happens where a compensated contour is narrower than the tool?",
        "Paths that cross among three elements are refused, as the control's interference check does; a crossing that lies farther apart is driven, with a warning.",
        "Parameter 19625 is how many blocks the control reads ahead, three when it comes from its maker; it gouges beyond them. "
        "A Haas is taken to look as far: its manual names no number, and G103 limits it.",
        example="narrow_contour",
    ),
    Decision(
        "What do H and D name?",
        "Rows of the offset memory, geometry and wear (memory C); the job's tools are the geometry "
        "of the rows of their numbers. Lengths count against the job's first tool, H0 is none. D "
        "holds radii. A new length moves nothing by itself.",
        "Parameter 5004 #2 is 0; the job says what its tools measure.",
        example="tools_by_h_and_d",
    ),
    Decision(
        "Where do work offsets count from?",
        "Those of the job from its part zero, and G54 is part zero itself where the job gives it no "
        "values; those that the program writes or reads (G10 L2, #5221) from machine zero, "
        "or so that the job's written_zero is part zero. G52 and G92 shift all of them.",
        "The job says where part zero lies on the machine.",
        example="work_offsets",
    ),
    Decision(
        "Where are the reference points?",
        "The first at machine zero, the second to fourth (G30) there as well.",
        "Parameters 1240 to 1243 are 0 when a control comes from its maker.",
        example="reference_points",
    ),
    Decision(
        "When does a tool length count again that G28, G30 or G53 in Z has cancelled?",
        "From the next G43, G44 or H; an absolute Z before it is warned of. length_returns = "
        '"next block" of the machine file gives it back at once.',
        "Parameter 5001 #6 (EVO) is 0 when a control comes from its maker.",
        example="length_behind_g28",
    ),
    Decision(
        "What does another D do while compensation is in force?",
        "The next move begins beside the contour by the old radius and ends beside it by the new one, an arc along a "
        "spiral; D0 ends compensation as G40 does, and another D behind it starts it again.",
        "The manual draws the vector at a block's end with the value of that block; between start and end of an arc "
        "of different radii it lets the radius grow evenly with the angle.",
        example="radius_changes",
    ),
    Decision(
        "How does the tool change sides, G42 while G41 is in force?",
        "Where the path on the old side of the one move and that on the new side of the next cross, both extended; "
        "where they do not, the one move ends square to the beginning of the next, an arc along a spiral. In the "
        "first move behind the lead-in the side cannot change.",
        "The manual says all three; what it does not say: a crossing counts that lies ahead on both.",
        example="side_changes",
    ),
    Decision(
        "What do timers, date and probe show?",
        "#3001 and #3002 hold what the program writes and go on by a millisecond each time that they are read; #3011 "
        "and #3012 are always 1 January 2000, noon; #5061 is where the last block ended.",
        "A program is read before any time passes, must come to the same every day, and has nothing to touch.",
        example="timers",
    ),
    Decision(
        "What is ; ?",
        "The end of a block; what follows it is a remark, and so is a line that begins with it. A further block behind "
        "it is refused.",
        "; ends a block on the screen, and many files hold it before prose.",
        example="lines_of_screens",
    ),
    Decision(
        "How far do G73 and G83 withdraw?",
        "G73 by 0.5 mm; G83 to R, and back with rapid to 0.5 mm above where it was.",
        "Parameters 5114 and 5115 decide.",
        example="chip_clearance",
    ),
    Decision(
        "Which way does the tool shift in G76 and G87?",
        "Towards + of the plane's first axis, by Q, with M19 before it and M3 behind.",
        "Parameters 5148 and 5101 #4 and #5 decide; 0 is +.",
        example="boring_shift",
    ),
    Decision(
        "How does tapping follow the spindle?",
        "By its feed: G74 and G84 reverse the spindle at the bottom and feed back, with M29 or without; behind M29 "
        "they start a spindle that stands, and stop it behind the hole; with Q they tap in passes, and come back by 0.5 mm behind each.",
        "The twin's spindle has no angle; with a feed of pitch times speed the path is the same. Parameters 5200 #5 "
        "and 5213 decide how far a tap comes back.",
        example="tapping",
    ),
    Decision(
        "What does R of G68 count from?",
        "From the plane's first axis, also with G91; a rotation replaces the one before.",
        "Parameter 5400 #0 is 0 when a control comes from its maker.",
        example="rotation_is_absolute",
    ),
    Decision(
        "What does P of M98 say with more than four digits?",
        "The last four are the program, those before them how often it runs, unless the file holds a "
        "program of the whole number or L is written.",
        "It is the older form of the call.",
        example="repeats_in_p",
    ),
    Decision(
        "Which program has a name?",
        "Upper and lower case are the same in M98 <NAME>, G65 <NAME>, G66 <NAME> and O<NAME>; <O2000> and <2000> "
        "are program O2000.",
        "Names are files of the control's memory; those next to a program are on disks that differ in this.",
        example="called_by_name",
    ),
    Decision(
        "What does M99 do in the main program?",
        "It ends the run with a warning; with P it jumps.",
        "A control would start the program again, for ever.",
        example="main_ends_by_m99",
    ),
    Decision(
        "How does G107 wrap a contour?",
        "The rotary axis stands in the place of the plane's axis that an arc does not name; F counts "
        "along the surface, and an arc is driven in chords that leave it by 0.001 mm at most.",
        "Parameter 1022 says which axis it stands for.",
        example="contour_on_a_cylinder",
    ),
    Decision(
        "What do #500 to #999 hold before the program has set them?",
        "Nothing: they are vacant, with a warning, unless the job gives them a value.",
        "A control keeps them from run to run.",
        example="kept_variables",
    ),
    Decision(
        "What do #3000 and #3006 do?",
        "#3000 refuses the program with its message; #3006 is a program stop as M0. #3003 to #3005 "
        "change nothing of the path.",
        "An alarm ends a run, and there is no operator to answer a message.",
        example="stops_by_variable",
    ),
    Decision(
        "Between which angles do ASIN and ATAN lie?",
        "ATAN[]/[] from 0 to 360 degrees, ASIN from 270 over 0 to 90, ATAN[] from -90 to 90.",
        "Parameter 6004 #0 is 0 when a control comes from its maker.",
        example="angles",
    ),
)
