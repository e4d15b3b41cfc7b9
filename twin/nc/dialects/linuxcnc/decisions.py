"""Decisions for LinuxCNC: where the twin knows less than the control, or says more than ``rs274``."""

from twin.nc.control.dialect import Decision

DECISIONS = (
    Decision(
        "Which codes are in force when a program starts?",
        "G17 G21 G40 G49 G54 G64 G80 G90 G91.1 G94 G97 G99, as rs274 begins; a G20 of the machine's "
        "own start is not known.",
        "They are those of the interpreter; a machine can change them in its file.",
        example="start_state",
    ),
    Decision(
        "What does tool length count from?",
        "The job's first tool, whose tip the part zero was taken with: G43 moves Z by how much longer "
        "a tool is, and without G43 the first tool's length counts.",
        "The job says where part zero lies, and nothing of the spindle's nose.",
        example="lengths_against_the_first_tool",
    ),
    Decision(
        "Where do coordinate systems lie?",
        "Those of the job count from its part zero; G54 is part zero itself where the job gives it no "
        "values, and others are refused until the job or G10 L2 gives them. Machine coordinates "
        "(G53, G28, G30, G10 L2, #5221) need the job's part_zero; written_zero of the job says instead what "
        "G10 L2 and #5221 write for part zero.",
        "The control keeps them in a file of the machine that no program brings along.",
        example="systems_of_the_job",
    ),
    Decision(
        "What does a probe meet (G38.3, G38.5)?",
        "Nothing: the tool goes to the end, #5061 to #5069 are that place and #5070 is 0; G38.2 and "
        "G38.4 are refused.",
        "Nothing touches the twin's probe; the control would stop there with an alarm.",
        example="probing_meets_nothing",
    ),
    Decision(
        "What do inputs give (M66)?",
        "Inputs are 0: read at once 0, waiting for one to rise runs out after Q seconds with -1.",
        "The twin has no inputs.",
        example="inputs_are_zero",
    ),
    Decision(
        "How far may start and end of an arc differ in their distance from the centre?",
        "By 0.0254 mm or 0.1 % of the radius, as the control allows; the centre is then moved to fit. Where both lie so near each other that it would "
        "have to move further than that, the arc is refused.",
        "The control draws a spiral between both; the difference is below 0.0254 mm for most arcs.",
        example="arc_centre_moved_to_fit",
    ),
    Decision(
        "Where does the rapid return of a short peck end (G73, G83)?",
        "0.254 mm above the peck, and never above R.",
        "The control overshoots R with pecks shorter than that.",
        example="short_pecks",
    ),
    Decision(
        "Which peck is the last (G73, G83)?",
        "The one that ends less than a millionth of a millimetre above Z.",
        "Rounding alone must not add one that drills nothing; the control counts in the program's unit and "
        "adds one now and then.",
        example="last_peck",
    ),
    Decision(
        "May the plane change while a canned cycle is in force?",
        "No: end it by G80 first.",
        "The control takes Z words for those of another axis.",
        example="plane_within_a_cycle",
    ),
    Decision(
        "What do G95, G33 and G33.1 do while the spindle stands, or turns by S0?",
        "They are refused.",
        "The control would wait without end.",
        example="feed_of_a_standing_spindle",
    ),
    Decision(
        "What does F of G95 count in inches (G20), where only rotary axes move?",
        "Degrees per revolution, as in millimetres.",
        "LinuxCNC 2.9 converts these degrees as inches and turns 25.4 times as fast, which no program can mean.",
        example="degrees_per_revolution_in_inches",
    ),
    Decision(
        "How are splines drawn (G5 to G5.3)?",
        "As chords that leave G5 and G5.1 by 0.5 um at most; a NURBS by 60 chords for each control "
        "point.",
        "The control draws arcs between points of its own: LinuxCNC 2.9 was seen up to 17 um beside the curve, at "
        "a sharp bend.",
        example="splines_as_chords",
    ),
    Decision(
        "What do output and override functions do (M48 to M53, M62 to M68)?",
        "They change no path, and are passed over.",
        "The twin has neither outputs nor an operator who turns overrides.",
        example="functions_without_a_path",
    ),
    Decision(
        "In which unit are the parameters of the machine (#5161, #5211, #5221, #5401, #5410)?",
        "Millimetres and degrees.",
        "The control keeps them in the machine's unit, which the twin's machines have metric.",
        example="parameters_in_millimetres",
    ),
    Decision(
        "What does the twin refuse that rs274 passes over?",
        "Words behind the condition of an elseif that is false, a structure without its end, a NURBS that "
        "another motion ends, Z in G5.2, its first point without P or with a P that is not above 0, G5 without I and J that follows no G5, M6 before the first T, a "
        "motion code with G43.1 or G43.2, X and Y of a tool in G10 L1, L10 and L11, Q in G10 L2 and L20, names of parameters with "
        "brackets in them, codes of lathes, axis words with M72, a radius compensation that M72 or the end "
        "of a subroutine would switch, words with M98 and M99 but for P and L, two of G92 to "
        "G92.3 in a block, probing with G93, lines that begin with O and are no O-words.",
        "The manual calls each an error or says nothing of it; what was meant is not done.",
        example="refused_for_clarity",
    ),
    Decision(
        "What does break leave within a do loop?",
        "The loop of its label alone.",
        "rs274 of 2.9 remembers the break of a while loop, even of one that is passed over, until the next do "
        "loop, and ends that one after its first round, against the manual.",
        example="break_within_do",
    ),
    Decision(
        "Are values computed that a definition or a break passes over?",
        "No: return and endsub of a subroutine that is being defined, and the end of a do loop that is left, are "
        "read, and wrong brackets refused.",
        "The control computes them too, with what the parameters hold then, and refuses a division by zero there; "
        "write such a value in a line of its own.",
        example="values_passed_over",
    ),
    Decision(
        "Where does the tool stand after M6?",
        "Where it stood before, with the length that is in force.",
        "The control reads it from the machine. The machine that rs274 itself brings along forgets a length "
        "that came into force after the last move, and stands elsewhere along Z.",
        example="position_after_a_tool_change",
    ),
    Decision(
        "May the unit change while a tool length is in force?",
        "Yes, but G43 to G49, G53, G28 and G30 are refused from then on.",
        "The control takes the length's number for one of the new unit, and the axes jump with the next move.",
        example="unit_under_a_tool_length",
    ),
    Decision(
        "May a coordinate system be turned by G10 L2 R while G92 or G52 is in force?",
        "Not the one in force while X or Y are shifted.",
        "The control leaves the shift out when it turns the place where it stands, and the axes jump with the "
        "next move.",
        example="turned_under_a_preset",
    ),
    Decision(
        "Which tool does M61 bring?",
        "That of its number, whose length G43 takes.",
        "The machine that rs274 itself brings along leaves the tool table as it was.",
        example="tool_of_m61",
    ),
    Decision(
        "How long may a line be?",
        "252 characters, comments counted.",
        "rs274 of 2.9 refuses a longer one as a command too long; the manual says 256. Of lines that end with "
        "CR LF the control takes one character less.",
        example="longest_line",
    ),
    Decision(
        "Does G43.2 take words of axes?",
        "Yes, as the manual says: they are added to the offset in force.",
        "rs274 of 2.9 looks for a tool -1 then, and ends.",
        example="further_offset_by_axes",
    ),
    Decision(
        "What does M99 in the main program do?",
        "The program starts again, until the job's step_limit ends it as endless.",
        "The control repeats it until somebody stops it.",
        example="main_program_repeats",
    ),
    Decision(
        "What do M428 and M429 mean?",
        "M428 leads the tip: X, Y and Z are its own in the part while rotary axes turn; M429 ends it. On a machine whose axes "
        "do not turn M428 is refused.",
        "LinuxCNC's configurations of five-axis machines remap them so, to switch kinematics, and their programs begin with it; a "
        "machine can give them another meaning.",
        example="tip_led_by_kinematics",
    ),
)
