"""Decisions where the documents of this control are silent, or leave it to machine data."""

from twin.nc.control.dialect import Decision

DECISIONS = (
    Decision(
        "Where do coordinates count from before a work offset is programmed?",
        "From the job's part zero; G54 is part zero itself where the job gives it no values.",
        "The basic frame is the operator's, who has set the part zero.",
        example="no_offset_programmed",
    ),
    Decision(
        "Which edge of a tool is D2?",
        "That of the job, which gives every tool one: the edge is the one whose number the program calls with the "
        "tool, and a second number of the same tool is refused.",
        "The control has up to twelve edges a tool; posts that number offsets by tools write T2 D2.",
        example="edge_of_a_tool",
    ),
    Decision(
        "What does G500 do?",
        "Coordinates count from machine zero; a job that does not say where that lies is refused as "
        "soon as a block moves.",
        "The manual lets the settable frame G500 be empty; what the basic frame adds is not known.",
        example="no_work_offset",
    ),
    Decision(
        "Does the tool's length count with G53, G153 and SUPA?",
        "No: they move the axes. A D of the block counts from the next block on.",
        "Programs write D0 with them, and part zero was taken with the first tool.",
        example="machine_position",
    ),
    Decision(
        "How are corners passed?",
        "G60 and G9 stop exactly; G64 and G641 to G645 round as far as the machine file's tolerance or "
        "ADIS=; what G601 to G603 wait for makes no difference.",
        "The shape of a rounded corner is the machine's.",
        example="corners",
    ),
    Decision(
        "What happens where a compensated contour is narrower than the tool?",
        "A corner that leaves the tool no room is refused; paths that cross farther apart are driven, with a warning.",
        "CDOF is in force at the start: the control looks for the crossing of neighbours alone. What CDON leaves out is the control's.",
        example="narrow_contour",
    ),
    Decision(
        "Which path does F count under radius compensation?",
        "That of the tool's centre, whatever CFC, CFTCP or CFIN says.",
        "The simulated machine moves the centre.",
        example="feed_of_the_centre",
    ),
    Decision(
        "What do the compressor, CYCLE832 and the dynamic modes do?",
        "Nothing: the lines are driven as they are written, and a notice says so.",
        "How far they may leave the path is the machine's.",
        example="compressor",
    ),
    Decision(
        "What do G74 and G75 approach?",
        "Machine zero of the axes that are named, rapidly and straight.",
        "The machine data of both points are 0 in the state of delivery.",
        example="reference_points",
    ),
    Decision(
        'What is T="NAME" where the job names no tools?',
        "The job's tools in the order in which the program first calls names, with a warning.",
        "A name alone tells no diameter; the job's order is the only one there is.",
        example="tools_by_name",
    ),
    Decision(
        "When does a tool come into the spindle?",
        "T selects, M6 changes and puts D1 into force, or the D of its block; D0 takes length and radius away.",
        "Mills are set up so; the machine data can make T change.",
        example="tool_and_edge",
    ),
    Decision(
        "What does G91 do behind a change of a frame or a tool's length?",
        "The next incremental word of an axis makes up for the change.",
        "Setting data 42440 and 42442 in the state of delivery.",
        example="increment_behind_a_shift",
    ),
    Decision(
        "What are variables worth that nobody has set?",
        "Those of DEF are 0; an R parameter without a value is refused, or the job's [variables] give it.",
        "R parameters keep what programs before have left.",
        example="variable_without_value",
    ),
    Decision(
        "What does a rotary axis make of an absolute target?",
        "It goes there as commanded, any number of turns; DC, ACP and ACN find the direction within a turn.",
        "Whether the axis is a modulo axis is a machine datum.",
        example="rotary_axis",
    ),
)
