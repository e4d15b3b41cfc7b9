"""Decisions where HEIDENHAIN's manuals are silent, or not available."""

from twin.nc.control.dialect import Decision

DECISIONS = (
    Decision(
        "What is the other coordinate of CC X+20?",
        "That of the last pole; without one the block is refused where the pole is used.",
        "The manuals show CC with two coordinates or with none.",
        example="pole_of_one_coordinate",
    ),
    Decision(
        "What happens where start and end of C are not equally far from the pole?",
        "Up to 0.016 mm the centre is moved to fit, by 0.1 mm or 1 % of the radius at most.",
        "The manual gives the tolerance and not what the control does within it.",
        example="centre_moved_to_fit",
    ),
    Decision(
        "And beyond that?",
        "The block is refused.",
        "The arc would not be the one that was drawn.",
        example="centre_too_far_off",
    ),
    Decision(
        "Where does M140 MB MAX go?",
        "To machine zero of the tool axis; where the tool is above it, nowhere.",
        "Nobody tells the control where the travel ends; mills have zero at its upper end.",
        example="retract_to_machine_zero",
    ),
    Decision(
        "Where are the presets of cycle 247?",
        "The job gives them, as [offsets.PRESET2]; 0 and 1 are part zero where it does not.",
        "The preset table belongs to the control; posts write Q339=1 for the first setting.",
        example="first_presets",
    ),
    Decision(
        "Where are the rows of the datum table (CYCL DEF 7.1 #2)?",
        "The job gives them, as [offsets.DATUM2]; 0 and 1 shift nothing where it does not.",
        "The table belongs to the machine; posts for older controls write #1 for the first setting.",
        example="first_datum_rows",
    ),
    Decision(
        "In which order do shift, mirror, rotation and scale act?",
        "In the order in which the program has put them into force; one that is changed keeps its place.",
        "The manual says that the result depends on the order of programming, and not what a change does.",
        example="order_of_transformations",
    ),
    Decision(
        "Which radius compensates, that of the job or of TOOL DEF?",
        "That of the job; of TOOL DEF where the job lists no tools. Lengths are the job's.",
        "The job says what is in the spindle; controls with a tool table take no values from TOOL DEF.",
        example="job_lists_tools",
    ),
    Decision(
        "How are corners passed without cycle 32?",
        "The path is kept.",
        "The tolerance without cycle 32 is set by the machine's builder.",
        example="path_is_kept",
    ),
    Decision(
        "How far does a drill go back into its hole rapidly?",
        "To 0.2 mm above where it was; with cycle 205 to Q258 above.",
        "The distance is set by the machine's builder.",
        example="return_into_hole",
    ),
    Decision(
        "When does cycle 203 come out of the hole?",
        "After Q213 breaks of the chip, at the next stop.",
        "The manual gives the number of breaks before the tool retracts.",
        example="chip_breaks",
    ),
    Decision(
        "On which path are pockets and slots cleared?",
        "In rings from the middle outwards, at most Q370 radii apart, and finished once around at full depth; Q366=1 and 2 go down on a helix of half the tool's radius, a tenth of it a turn.",
        "The manuals give the result and leave the path to the control.",
        example="pocket_in_rings",
    ),
    Decision(
        "On which path are studs milled?",
        "In rings from the blank inwards, entered 2 mm beside it on the side of positive X.",
        "The path differs between the controls' versions.",
        example="stud_from_positive_x",
    ),
    Decision(
        "How does a thread mill come to its helix?",
        "On half a turn from the axis of the hole, or from beside an outside thread, and back so.",
        "The manual says tangentially and in a helix.",
        example="thread_on_half_turns",
    ),
    Decision(
        "What is between the places of cycle 220 with Q365=1?",
        "A straight line, which is reported.",
        "With the tool above the part only the time differs.",
        example="straight_between_places",
    ),
    Decision(
        "What is a tool that is called by a name which the job does not give?",
        "The job's tools in the order in which the program first calls names, with a warning.",
        "A name alone tells no diameter; the job's order is the only one there is.",
        example="name_of_a_tool",
    ),
    Decision(
        "What is C with FMAX?",
        "It is refused.",
        "A rapid arc of the twin's machines would be a guess.",
        example="rapid_arc",
    ),
    Decision(
        "What is a block of axes without a keyword?",
        "A straight line, as L.",
        "Controls write paraxial blocks so.",
        example="without_a_keyword",
    ),
    Decision(
        "How does radius compensation pass corners?",
        "Outside corners are rolled around, inside corners end where the parallel paths meet; what does not fit is refused.",
        "As in the base: the tool's edge stays on the contour and leaves it nowhere.",
        example="corners_of_a_contour",
    ),
    Decision(
        "What happens where a compensated contour is narrower than the tool?",
        "A corner that leaves the tool no room is refused; paths that cross farther apart are driven, with a warning.",
        "Without M120 the control looks at neighbours alone.",
        example="narrow_contour",
    ),
    Decision(
        "What does FN 18 read?",
        "The number, length and radius of tools, and where the axes stand; all else is refused.",
        "The twin keeps no other data of the control.",
        example="system_data",
    ),
    Decision(
        "Where is the datum of M92?",
        "The job gives it, as [offsets.M92].",
        "The machine's builder sets it.",
        example="other_datum",
    ),
    Decision(
        "What does F count in a program in inches?",
        "Tenths of an inch per minute.",
        "The manual of the iTNC says so, and posts write it; later ones show both units.",
        example="feed_in_inches",
    ),
    Decision(
        "What is a parameter of a cycle that the program changes behind its definition?",
        "It counts with its new value where the cycle is called.",
        "Cycles read the Q parameters of their numbers; programs for the iTNC 530 are written so.",
        example="parameter_changed_behind_definition",
    ),
    Decision(
        "Where does the tool stand while TOOL CALL changes it?",
        "It rises to machine zero of its axis, where the job says where the part lies; the height of the job or the "
        "machine (tool_change) counts before. A tool that is in the spindle already stays where it is.",
        "What happens is a macro of the machine's builder; programs call tools from within the part.",
        example="rises_for_the_tool_change",
    ),
)
