"""What a raw program's path and comments show of its stock's height, its machine, and the radii in the control's table."""

from pathlib import Path

import numpy as np
import pytest

from tests.run.preparing.test_assumed_job import raw
from twin.errors import UsageError
from twin.nc.canonical import concatenate
from twin.nc.dialects.recognition import raw_text
from twin.nc.text.diagnostics.diagnostics import ProgramError
from twin.nc.text.source import source_from_text
from twin.run.preparing.assumed_job import text_beside, with_assumptions
from twin.run.preparing.preparation import Preparation, prepare
from twin.run.reading.assumed_machine import assumed_machine, turned_axes
from twin.run.reading.tool_comments import tool_of_comment


def passes(*heights: float, clear: float = 15.0) -> str:
    """A square at each height, from a plunge beside it."""
    return f"G0 Z{clear}\nG0 X9. Y9.\nX0. Y0.\n" + "".join(
        f"G1 Z{height} F100.\nG1 X40. F300.\nY30.\nX0.\nY0.\n" for height in heights
    )


HEAD, END = "G21 G90 G17\nT1 M6\nS900 M3\n", "G0 Z15.\nM30\n"


@pytest.mark.parametrize(
    ("heights", "top", "size"),
    [
        ((8.0, 6.0, 4.0, 2.0, 0.0), 10.0, 10.0),  # zero on the bottom, steps of 2 mm
        ((8.0, 4.0, 0.0, -0.2), 12.0, 13.0),  # through to the table
        ((14.0, 4.0), 14.0, 14.0),  # rapids at 15 pass above it
        ((1.0, -2.0, -4.0, -6.0), 0.0, 16.0),  # a feed in the air before the cuts below zero
        ((-2.0, -4.0), 0.0, 14.0),
    ],
)
def test_the_path_shows_where_zero_lies(
    heights: tuple[float, ...], top: float, size: float, tmp_path: Path
) -> None:
    made, assumed = raw(tmp_path, f"{HEAD}{passes(*heights)}{END}")
    stock = made.job.file.stock
    assert stock is not None
    assert stock.size is not None
    assert stock.position[2] == pytest.approx(top)
    assert stock.size[2] == pytest.approx(size)
    assert any("zero is not on its top" in line for line in assumed.assumptions) == (top > 0.0)
    assert made.job.file.start.get("Z", 0.0) == (top + 10.0 if top else 0.0)


def test_a_path_that_slopes_down_has_no_steps(tmp_path: Path) -> None:
    ramp = "G0 Z60.\nG0 X9. Y9.\nX0. Y0.\nG1 Z40. F100.\nX2. F300.\n" + "".join(
        f"X{40 * (n % 2)}. Z{40 - 3 * n}.\n" for n in range(1, 9)
    )
    made, _ = raw(tmp_path, f"{HEAD}{ramp}Y30.\nX0.\n{END}")
    assert made.job.file.stock is not None
    assert made.job.file.stock.position[2] == 41.0


def helix(begin: float, end: float, x: float = 24.5) -> str:
    """A bore with zero on the part's bottom: down along a helix, and round once more."""
    middle = (begin + end) / 2.0
    return (
        f"G0 Z{begin + 5.0}\nX{x} Y0.\nG0 Z{begin}\nG1 Z{begin} F100.\nG2 X15.5 Z{middle} I-4.5 J0. F300.\n"
        f"X{x} Z{end} I4.5\nX15.5 I-4.5\nX{x} I4.5\nG0 Z{begin}\n"
    )


def ramp(begin: float, *heights: float) -> str:
    return f"G0 Z{begin + 2.0}\nG0 X9. Y9.\nX0. Y0.\nZ{begin}\n" + "".join(
        f"G1 X20. Z{height} F100.\nX40. F300.\nY30.\nX0.\nY0.\n" for height in heights
    )


@pytest.mark.parametrize(
    ("text", "top"),
    [
        (helix(14.0, 8.0), 14.0),  # as FreeCAD begins them: from the top itself
        (helix(14.0, 8.0) + helix(14.0, 7.0), 14.0),  # a step of 1 mm is none, 6 mm below the begin
        (helix(14.0, 8.0) + helix(14.0, 0.0), 14.0),  # nor one of 8 mm, above it
        (ramp(18.0, 9.0, 3.0), 15.0),  # from a safe height, 3 mm above the step of 6 mm
        (ramp(16.5, 12.0, 10.0, 8.0), 14.0),  # and 2.5 mm above one of 2 mm
        (ramp(16.5, 12.0), 16.5),  # one level has no step
        (passes(14.0, clear=19.0) + "T2 M6\n" + passes(10.0, 6.0, clear=19.0), 15.0),
        (passes(14.0, 12.0, clear=19.0) + "T2 M6\n" + passes(6.0, clear=19.0), 16.0),
    ],
)
def test_feeds_that_begin_to_go_down_show_the_top(text: str, top: float, tmp_path: Path) -> None:
    made, assumed = raw(tmp_path, f"{HEAD}{text}G0 Z30.\nM30\n")
    assert made.job.file.stock is not None
    assert made.job.file.stock.position[2] == pytest.approx(top)
    assert any("zero is not on its top" in line for line in assumed.assumptions)


@pytest.mark.parametrize(
    ("cycle", "top"),
    [
        ("G99 G81 X10. Y10. Z0. R17. F80.", 16.0),  # to the bottom, where zero is
        ("G99 G83 X10. Y10. Z-1. R17. Q3. F80.", 16.0),  # and through it
        ("G99 G81 X10. Y10. Z-1. R5. F80.", 0.0),  # spotted from 5 mm above the top
        ("G99 G81 X10. Y10. Z-20. R2. F80.", 0.0),
    ],
)
def test_holes_alone_show_the_top_by_where_their_cycles_begin(
    cycle: str, top: float, tmp_path: Path
) -> None:
    made, assumed = raw(tmp_path, f"{HEAD}G0 Z30.\n{cycle}\nX40.\nG80\nG0 Z30.\nM30\n")
    assert made.job.file.stock is not None
    assert made.job.file.stock.position[2] == top
    assert any("1 mm lower" in line for line in assumed.assumptions) == (top > 0.0)


def test_rapids_far_below_zero_show_that_it_is_above_the_stock(tmp_path: Path) -> None:
    slope = "G1 X30. Z-12. F100.\nX0.\nX30. Z-13.\nX0.\n"
    made, assumed = raw(tmp_path, f"{HEAD}G0 Z10.\nX0. Y0.\nZ-9.75\n{slope}{END}")
    assert made.job.file.stock is not None
    assert made.job.file.stock.position[2] == -9.75
    assert any("the first feed goes down from Z-9.75" in line for line in assumed.assumptions)


@pytest.mark.parametrize(
    ("comment", "size", "across"),
    [
        ("STOCK 50 X 50 X 120 MM", (120.0, 50.0, 50.0), None),
        ("STOCK X100 Y40 Z30", (100.0, 40.0, 30.0), None),
        ("BAR DIA 60 X 120", None, 60.0),
        ("MATERIAL Ø60 L=120", None, 60.0),
    ],
)
def test_a_comment_gives_the_bar_that_axis_a_turns(
    comment: str, size: tuple[float, ...] | None, across: float | None, tmp_path: Path
) -> None:
    made, assumed = raw(tmp_path, ROTARY.replace("O1\n", f"O1 ({comment})\n"))
    stock = made.job.file.stock
    assert stock is not None
    assert (stock.size, stock.diameter) == (size, across)
    length = 120.0 if size is None else size[0]
    assert stock.position == (40.0 - length / 2.0, 0.0, 0.5 * (across or stock.extent[2]))
    chain = made.machine.part_frame.chain
    assert chain is not None
    begin = stock.position[0] - length / 2.0
    assert made.job.file.part_zero["X"] + begin == pytest.approx(chain.table[0])
    assert any("from a comment in the program's head" in line for line in assumed.assumptions)


@pytest.mark.parametrize(
    ("comment", "size", "diameter"),
    [
        ("Part size X:100 Y:100 Z:50", (100.0, 100.0, 50.0), None),
        ("Quader: QX90 QY80 QZ100", (90.0, 80.0, 100.0), None),
        ("BLANK D=80 H=30", None, 80.0),
        ("BAR STOCK SUPPORT, 3 X 4 PIECES", (60.0, 50.0, 11.0), None),  # none: around the path
    ],
)
def test_comments_give_the_blank(
    comment: str, size: tuple[float, ...] | None, diameter: float | None, tmp_path: Path
) -> None:
    made, _ = raw(tmp_path, f"O1\n({comment})\n{HEAD}{passes(-1.0)}{END}")
    stock = made.job.file.stock
    assert stock is not None
    assert (stock.size, stock.diameter) == (size, diameter)
    assert stock.position[2] == 0.0


def test_rapids_into_the_part_are_judged_where_a_program_feeds_nowhere(tmp_path: Path) -> None:
    drilling = "G0 X20. Y10. Z10.\nZ0.1\nZ-3.5 F2.\nZ10. F600.\n"
    made, assumed = raw(tmp_path, f"{HEAD}{drilling}M5\nM30\n")  # G0 is still in force
    assert made.job.file.stock is not None
    assert made.job.file.stock.position == (20.0, 10.0, 0.0)
    assert any("which feeds nowhere, goes below Z0" in line for line in assumed.assumptions)
    for harmless in (drilling.replace("Z-3.5", "Z0."), f"M5\n{drilling}"):
        made, _ = raw(tmp_path, f"{HEAD.replace('S900 M3', '')}{harmless}M30\n")
        assert made.job.file.stock is None


def test_a_tool_that_rises_in_its_hole_takes_nothing_from_the_stock(tmp_path: Path) -> None:
    cycle = "G0 Z20.\nX0. Y0.\nG73 G99 X10. Z-30. R5. Q10. F200.\nX70.\nG80\n"
    made, assumed = raw(tmp_path, f"O1\n{HEAD}{cycle}{END}")
    assert made.job.file.stock is not None
    assert made.job.file.stock.extent[0] == 80.0
    assert not any("go below its top" in line for line in assumed.assumptions)


KLARTEXT = """0 BEGIN PGM NAMED MM
1 ; T915 | FRA-P8221-S5.7R0_H63W6L65 / DM=5.7 CR=0 TL=101
2 BLK FORM 0.1 Z X-50 Y-50 Z-20
3 BLK FORM 0.2 X+50 Y+50 Z+0
4 * - TOOL: T915 | FRA-P8221-S5.7R0_H63W6L65 / DM=5.7 CR=0 TL=101
5 TOOL CALL "SN0570" Z S6700
6 L X+0 Y+0 R0 FMAX M3
7 L Z+20 R0 FMAX
8 CYCL DEF 208 BORE MILLING ~
   Q200=+2 ~
   Q201=-10 ~
   Q206=+300 ~
   Q334=+1 ~
   Q203=+0 ~
   Q204=+20 ~
   Q335=+9 ~
   Q342=+0 ~
   Q351=+1
9 CYCL CALL
10 TOOL CALL "FRAESER_D8" Z S5000
11 L X+30 Y+0 R0 FMAX M3
12 L Z+2 R0 FMAX
13 L Z-2 R0 F200
14 L Z+20 R0 FMAX
15 M30
16 END PGM NAMED MM
"""


def test_tools_that_are_called_by_names_have_the_radius_of_their_comment(tmp_path: Path) -> None:
    """Cycle 208 asks for it: a hole of 9 mm takes no tool of 10."""
    (tmp_path / "part.h").write_text(KLARTEXT)
    preparation = prepare(tmp_path / "part.h", assuming=True)
    made, _ = with_assumptions(preparation, machine=None, strict=False)
    tools = [(each.name, each.diameter, each.length) for each in made.job.file.tools]
    assert tools == [("SN0570", 5.7, 101.0), ("FRAESER_D8", 8.0, 60.0)]
    assert list(made.interpretation().chunks())


def test_open_brackets_of_a_set_up_sheet_tell_the_radius() -> None:
    source = source_from_text("G90\n(     T01 TC1: KL+087.000 KR020.000 NZ06")
    assert raw_text(source).comments == ((2, "T01 TC1: KL+087.000 KR020.000 NZ06"),)
    assert tool_of_comment("TC1: KL+087.000 KR020.000 NZ06", inches=False).diameter == 40.0


def test_a_full_circle_is_no_drilling(tmp_path: Path) -> None:
    down = "G0 Z1.\nX4. Y0.\nG2 I-4. Z-1. F100.\nI-4. Z-2.\nI-4.\n"
    made, _ = raw(tmp_path, f"{HEAD}{down}{END}")
    assert made.job.file.tools[0].kind == "flat"


@pytest.mark.parametrize(
    ("comment", "diameter"),
    [
        ('"tool_diameter": 6,', 6.0),
        ("TOOL DIAMETER: 3.0", 3.0),
        ("20mm_Face001", 20.0),
        ("FACE 2 MM OFF THE TOP", 10.0),
    ],
)
def test_comments_before_the_only_tool_are_of_it(
    comment: str, diameter: float, tmp_path: Path
) -> None:
    made, _ = raw(tmp_path, f"({comment})\n{HEAD}{passes(-1.0)}{END}")
    assert made.job.file.tools[0].diameter == diameter


def test_a_router_that_calls_t0_has_a_tool_0(tmp_path: Path) -> None:
    """MakerCam writes T0 M6 before everything: an empty spindle would cut nothing, and pass."""
    first = f"{HEAD.replace('T1', 'T0')}{passes(-1.0)}"
    for text, numbers in (
        (END, [0]),
        (f"T1 M6\n{passes(-2.0)}{END}", [0, 1]),
    ):
        made, _ = raw(tmp_path, first + text)
        assert [tool.number for tool in made.job.file.tools] == numbers
    made, _ = raw(tmp_path, f"{HEAD}{passes(-1.0)}T0 M6\n{END}")  # the spindle is emptied
    assert [tool.number for tool in made.job.file.tools] == [1]


def test_flutes_are_as_long_as_the_deepest_cut_below_the_top(tmp_path: Path) -> None:
    deep = passes(50.0, 40.0, 30.0, 20.0, 10.0, 0.0, clear=70.0)
    made, assumed = raw(tmp_path, f"{HEAD}{deep}{END}")
    assert made.job.file.tools[0].flute == 65.0
    assert made.job.file.tools[0].length == 124.0
    assert any("124 mm long, a guess: so far it must reach" in line for line in assumed.assumptions)
    _, shallow = raw(tmp_path, f"{HEAD}{passes(-1.0)}{END}")
    assert not any("mm long" in line for line in shallow.assumptions)


def test_rapids_into_a_pocket_that_was_fed_take_nothing_from_the_stock(tmp_path: Path) -> None:
    pocket = "G0 Z5.\nG0 X0. Y0.\nG1 Z-4. F100.\nX40. F300.\nG0 Z5.\nX20. Y1.\nZ-3.5\nG1 X30.\n"
    made, assumed = raw(tmp_path, HEAD + pocket + END)
    assert not any("go below its top" in line for line in assumed.assumptions)
    beside = pocket.replace("X20. Y1.", "X20. Y18.")
    _, assumed = raw(tmp_path, HEAD + beside + END)
    assert any("rapids of line 10 go below its top" in line for line in assumed.assumptions)
    assert made.job.file.stock is not None


ROTARY = f"O1\n{HEAD}G54\nG0 A0.\nG0 X10. Y0. Z60.\nG1 Z18. F300.\nX30.\nG0 Z60.\nA90.\nG0 X10.\nG1 Z18.\nX30.\nG0 Z60.\nM30\n"


def test_a_program_that_turns_a_runs_on_the_machine_with_a(tmp_path: Path) -> None:
    made, assumed = raw(tmp_path, ROTARY)
    file = made.job.file
    assert file.machine == "mill4a"
    assert "machine mill4a: the program turns A, and mill4 has no A" in assumed.assumptions
    assert file.stock is not None
    assert (file.stock.shape, file.stock.axis) == ("cylinder", "X")
    assert file.stock.diameter == 38.0  # the only cut, at Z18, is taken to be 1 mm deep
    assert file.tools[0].length > 60.0  # or it would not reach the axis within the travel of Z
    chain = made.machine.part_frame.chain
    assert chain is not None
    begin = file.stock.position[0] - (file.stock.height or 0.0) / 2.0
    assert file.part_zero["X"] + begin == pytest.approx(chain.table[0])
    kept = tmp_path / "kept.toml"
    kept.write_text(text_beside(kept, assumed, tmp_path / "part.nc"))
    assert prepare(kept).machine.axes.names == ("X", "Y", "Z", "A")
    assert (
        prepare(tmp_path / "part.nc", machine="mill5", assuming=True).machine.file.name == "mill5"
    )


@pytest.mark.parametrize(
    ("text", "turned", "machine"),
    [
        ("G0 X1 A0.\nA0", set(), None),
        ("G1 X1. A#101 F5", {"A"}, "mill4a"),
        ("G0 C90.", {"C"}, None),
        ("G0 A30. C90.", {"A", "C"}, "mill5"),
        ("G0 B90.", {"B"}, None),  # of a table or of a head: nobody knows
        ("G65 P9001 A1. B2.\n(A90.)\nG1 X5. ,C2.", set(), None),
        ("N5 L A+30 C-45 FMAX", {"A", "C"}, "mill5"),
        ("X=AC(5) A=DC(90)", {"A"}, "mill4a"),
        ("CC X+5 Y+5\nC X+1 DR+\nCYCL DEF 19.1 A+30", set(), None),
        ("CR=5 AR=90 RP=3", set(), None),
    ],
)
def test_rotary_words_choose_the_machine(text: str, turned: set[str], machine: str | None) -> None:
    source = source_from_text(text)
    assert turned_axes(source) == turned
    found = assumed_machine(source)
    assert (None if found is None else found[0]) == machine


def contour_with(comment: str, lead: str = "G41 D1 X0. F300.", rest: str = "Y30.\n") -> str:
    return (
        f"%\nO7\n({comment})\nG21 G90 G17\nT1 M6\nG43 H1 Z50.\nS900 M3\nG0 X-20. Y0.\nG1 Z-1. F90.\n"
        f"{lead}\n{rest}G40 X-20.\nG0 Z50.\nM30\n%\n"
    )


def reached(made: Preparation, line: int) -> float:
    chunks = list(made.interpretation().chunks())
    moves = concatenate([chunk.moves for chunk in chunks], made.machine.axes)
    return float(moves.end[moves.line == line][-1, 0])


@pytest.mark.parametrize(
    ("comment", "x"),
    [
        ("T1 | 10 FLAT ENDMILL | H1 | D1 | WEAR COMP | TOOL DIA. - 10.", 0.0),
        ("T1 | 10 FLAT ENDMILL | H1 | D1 | CONTROL COMP | TOOL DIA. - 10.", -5.0),
        ("T1 D=10. CR=0. - ZMIN=-1. - flat end mill", -5.0),
    ],
)
def test_a_post_says_whether_d_holds_the_radius_or_its_wear(
    comment: str, x: float, tmp_path: Path
) -> None:
    made, assumed = raw(tmp_path, contour_with(comment))
    assert reached(made, 10) == x
    assert made.job.file.tools[0].radius_offset == (0.0 if x == 0.0 else None)
    assert made.job.file.tools[0].diameter == 10.0
    told = any("counts the whole radius" in line for line in assumed.assumptions)
    assert told == (x != 0.0)
    kept = tmp_path / "kept.toml"
    kept.write_text(text_beside(kept, assumed, tmp_path / "part.nc"))
    assert reached(prepare(kept), 10) == x


def test_contours_that_leave_the_tool_no_room_are_the_path_of_its_centre(tmp_path: Path) -> None:
    small = "Y10.\nG3 X-4. Y14. I-4.\nG1 X-15.\n"  # an inside arc of 4 mm, the tool has 5
    made, assumed = raw(tmp_path, contour_with("T1 D=10. CR=0. - flat end mill", rest=small))
    assert reached(made, 10) == 0.0
    assert any(
        "contours are the path of the tool's centre: in line 12" in a for a in assumed.assumptions
    )
    with pytest.raises(ProgramError, match=r"twin init.*radius_offset"):
        raw(tmp_path, contour_with("NOTHING OF TOOLS", rest=small))


def test_text_before_the_first_percent_is_passed_over(tmp_path: Path) -> None:
    made, _ = raw(tmp_path, f"PUMP HOUSING, second side\n\n%\nO7\n{HEAD}{passes(-1.0)}{END}%\n")
    interpretation = made.interpretation()
    assert sum(len(chunk.moves) for chunk in interpretation.chunks()) > 0
    assert next(each.code for each in interpretation.diagnostics) == "before-tape-start"


def test_a_set_up_sheet_before_a_klartext_program_is_passed_over(tmp_path: Path) -> None:
    path = tmp_path / "part.h"
    begin = "( Set-up sheet\n(   Tool: L X+10\n(\n"
    path.write_text(f"{begin}BEGIN PGM A MM\nTOOL CALL 1 Z S2000\nL X+10 F100\nEND PGM A MM\n")
    interpretation = prepare(path, assuming=True).interpretation()
    assert sum(len(chunk.moves) for chunk in interpretation.chunks()) == 1
    assert [each.code for each in interpretation.diagnostics] == ["before-program"]
    path.write_text("L X+5 F100\n" + path.read_text().removeprefix(begin))
    assert sum(len(chunk.moves) for chunk in prepare(path).interpretation().chunks()) == 2


def test_no_dialect_is_offered_that_refuses_the_same_line(tmp_path: Path) -> None:
    path = tmp_path / "part.nc"
    path.write_text("G21 G90\n(PART (REV A).MCX)\nG0 X1.\nM30\n")
    with pytest.raises(ProgramError) as raised:
        prepare(path, assuming=True)
    assert raised.value.diagnostic.hint == (
        "close the first comment first, or leave out the inner ( )"
    )


def test_a_program_that_a_router_alone_reads_is_its(tmp_path: Path) -> None:
    """K of an arc in X Y, as an old post writes it: LinuxCNC refuses it, Grbl passes over it."""
    arc = "G17 G90\nG21\nG0 X0. Y0. Z1.\nG1 Z-1. F90.\nG2 X4. Y0. I2. J0. K0.0 F200.\nM30\n"
    made, _ = raw(tmp_path, arc)
    assert made.dialect.name == "grbl"
    assert (
        "no other control reads it; fanuc, which reads it farthest of others, refuses line 5"
        in made.dialect_reason
    )
    with pytest.raises(ProgramError, match="read as fanuc"):
        raw(tmp_path, f"O1\n{arc}")


def test_words_in_comments_and_messages_name_no_control(tmp_path: Path) -> None:
    text = f"; 2D POCKET2 RAW\n{HEAD}{passes(-1.0)}{END}"
    made, _ = raw(tmp_path, text)
    assert made.dialect.name in ("fanuc", "linuxcnc")
    with pytest.raises(UsageError, match="EdingCNC"):
        raw(tmp_path, f'G90\nMSG "Tool: 1 End mill"\n{HEAD}{passes(-1.0)}{END}')


def test_a_post_of_one_language_decides_between_controls(tmp_path: Path) -> None:
    """G98 is in force at the start of a Fanuc, G99 of LinuxCNC."""
    drill = "G21\nG90\nG0 Z50.0\nM3 S900\nG81 R3.0 Z-5.0 F100.0 X1.0 Y1.0\nX9.0\nG80\nM30\n"
    made, _ = raw(tmp_path, f"( pcb2gcode 1.1.4 )\n{drill}")
    assert made.dialect.name == "linuxcnc"
    assert made.dialect_reason == "its head names pcb2gcode, which writes linuxcnc's language"


@pytest.mark.parametrize(
    ("comment", "inches", "diameter"),
    [
        ("Compensated Tool Path. Diameter: 6.35", True, 6.35),  # FreeCAD counts mm in any program
        ("TOOL DIAMETER: 3.1 mm", False, 3.1),
        ("MSG, Change to Tool Dia = 3.1000", False, 3.1),
        ("384 MM BORING HEAD NO. 12", False, None),
        ("T1 15 END MILL", True, None),  # 381 mm
    ],
)
def test_diameters_are_those_of_tools(comment: str, inches: bool, diameter: float | None) -> None:
    found = tool_of_comment(comment, inches=inches).diameter
    assert found == (None if diameter is None else pytest.approx(diameter))


def test_the_diameter_of_a_path_is_that_of_the_tool_in_the_spindle(tmp_path: Path) -> None:
    path = passes(-1.0)
    text = (
        f"{HEAD}(Compensated Tool Path. Diameter: 6.0)\n{path}T2 M6\n"
        f"(Compensated Tool Path. Diameter: 3.0)\n{path}{END}"
    )
    made, _ = raw(tmp_path, text)
    assert [tool.diameter for tool in made.job.file.tools] == [6.0, 3.0]
    made, _ = raw(tmp_path, f"G21 G90\nS900 M3\n(TOOL DIAMETER: 3.1 mm)\n{path}{END}")
    assert made.job.file.tools[0].diameter == 3.1
    assert np.isclose(made.settings.tools[1].radius, 1.55)


def test_what_is_written_for_cutviewer_tells_stock_zero_and_tools(tmp_path: Path) -> None:
    text = (
        "%\n(TOOL/MILL,6.35,0.00,0.00,0.00)\n(FILENAME: tray.c2d)\n(STOCK/BLOCK, 120.00, 80.00, 18.00, 60.00, 40.00, 18.00)\n"
        "G90\nG21\n(TOOL/MILL,6.35, 0.00, 0.00, 0.00)\n()\nM05\n(TOOL CHANGE)\nM6T201\nM03S10000\n(PREPOSITION)\n"
        "G0X-40.000Y-20.000\nZ2.000\nG1Z-2.000F300.0\nX40.000F1200.0\nG0Z10.000\n(TOOL/MILL,3.0,1.50,0.00,0.00)\n()\nM05\n"
        "(TOOL CHANGE)\nM6T202\nM03S10000\nG0X0Y0\nZ2.000\nG1Z-1.000F300.0\nX10.0\nG0Z10.000\nM05\nM02\n%\n"
    )
    made, _ = raw(tmp_path, text)
    tools = [(tool.number, tool.kind, tool.diameter) for tool in made.job.file.tools]
    assert tools == [(201, "flat", 6.35), (202, "ball", 3.0)]
    stock = made.job.file.stock
    assert stock is not None
    assert stock.size == (120.0, 80.0, 18.0)
    assert stock.position == (0.0, 0.0, 0.0)


def test_a_short_bar_of_a_comment_keeps_holder_and_table_apart(tmp_path: Path) -> None:
    drill = "G98 G81 X10. Y0. Z8. R22. F150.\nX30.\nG80\n"
    text = (
        "%\nO27\n(T1 D=6. - DRILL)\n(STOCK DIA 40. L 60.)\nG90 G94 G17 G21\nG53 G0 Z0.\nT1 M6\nS2500 M3\nG54\n"
        f"G0 X10. Y0. A0.\nG43 Z40. H1\n{drill}G0 A90.\n{drill}G53 G0 Z0.\nM30\n%\n"
    )
    made, assumed = raw(tmp_path, text)
    assert "held 20 mm before the table" in "; ".join(assumed.assumptions)
    chain = made.machine.part_frame.chain
    assert chain is not None
    assert made.job.file.part_zero["X"] == pytest.approx(float(chain.table[0]) + 40.0)


def test_rows_of_a_list_in_columns_are_of_their_own_tools(tmp_path: Path) -> None:
    text = (
        "%\nO0056\n(TOOL NO.   DESCRIPTION      DIA.     H    D)\n(   3       FLAT ENDMILL     12.00    3    3)\n"
        "(   8       CENTER DRILL      3.00    8    8)\nG90 G94 G17 G21\nT3 M6\nS3000 M3\nG54 G0 X-15. Y0.\nG43 Z15. H3\n"
        "G1 Z-2. F200.\nX40. F600.\nG0 Z15.\nT8 M6\nS3000 M3\nG0 X10. Y10.\nG43 Z15. H8\nG81 Z-1. R2. F100.\nG80\nM30\n%\n"
    )
    made, _ = raw(tmp_path, text)
    tools = [(tool.number, tool.kind, tool.diameter) for tool in made.job.file.tools]
    assert tools == [(3, "flat", 12.0), (8, "chamfer", 3.0)]
