"""What is assumed for a raw program: its dialect, its stock and zero, its tools."""

import contextlib
import tomllib
from pathlib import Path

import pytest

from twin.errors import ConfigError, EmptyProgramError, TwinError, UsageError
from twin.files.shipped import machine_file
from twin.nc.canonical import concatenate
from twin.nc.text.diagnostics.diagnostics import ProgramError
from twin.run.preparing.assumed_job import AssumedJob, prepare_run, text_beside, with_assumptions
from twin.run.preparing.preparation import Preparation, prepare
from twin.run.progress import no_progress
from twin.run.reading.assumed_tools import SPEED_BY_HAND
from twin.run.reading.tool_comments import numbered_tool, tool_of_comment
from twin.run.run import Run

CONTOUR = """%
O01001 (PLATE)
(T1 D=10. CR=0. - ZMIN=-4. - flat end mill)
(T2 D=6.8 CR=0. TAPER=118deg - ZMIN=-12. - drill)
N10 G90 G94 G17
N15 G21
N20 G53 G0 Z0.
N25 T1 M6
N30 S5000 M3
N35 G54
N40 G0 X-12. Y0.
N45 G43 Z15. H1
N50 Z-4.
N55 G1 X80. F1000.
N60 Y60.
N65 G0 Z15.
N70 G53 G0 Z0.
N75 T2 M6
N80 S3000 M3
N85 G0 X20. Y20.
N90 G43 Z15. H2
N95 G98 G81 X20. Y20. Z-12. R5. F300.
N100 X60.
N105 G80
N110 G53 G0 Z0.
N115 M30
%
"""


def raw(tmp_path: Path, text: str) -> tuple[Preparation, AssumedJob]:
    path = tmp_path / "part.nc"
    path.write_text(text)
    return with_assumptions(prepare(path, assuming=True), machine=None, strict=False)


def test_dialects_that_make_the_same_are_told_and_one_is_taken(tmp_path: Path) -> None:
    made, _ = raw(tmp_path, CONTOUR)
    assert made.dialect.name == "fanuc"
    assert made.dialect_reason == "fanuc, haas and linuxcnc make the same moves of it"


def test_dialects_that_would_move_differently_ask(tmp_path: Path) -> None:
    path = tmp_path / "part.nc"
    path.write_text("O1\nG21 G90 G17 G80\nG0 X10. Y0. Z2.\nG1 Z0. F300.\nG3 Z-40. I-5.\nM30\n")
    with pytest.raises(UsageError) as raised:
        prepare(path)
    message = str(raised.value)
    assert (
        "in line 5 fanuc feeds 485" in message
    )  # 300 of the circle's 31.4 mm, 50.9 mm along the helix
    assert "type --dialect fanuc or --dialect haas" in message


HELIX = "G21 G90\nG0 X10 Y0 Z1\nG1 Z0 F300\nG2 X10 Y0 Z-8 I-1 J0 F400\nG0 Z5\nM30\n"


def test_feeds_alone_are_those_of_a_control_without_program_numbers(tmp_path: Path) -> None:
    """A helix of 2 mm that sinks by 8: F counts its arc or its path; posts for fanuc and haas write O."""
    preparation, _ = raw(tmp_path, HELIX)
    assert preparation.dialect.name == "linuxcnc"
    assert "programs of fanuc and haas begin with their number, O" in preparation.dialect_reason
    with pytest.raises(UsageError, match=r"could be fanuc or haas.*feeds"):
        raw(tmp_path, f"%\nO1\n{HELIX}%\n")


def test_offsets_that_are_no_tools_number_are_those_of_the_tool_in_the_spindle(
    tmp_path: Path,
) -> None:
    """Posts add 30 or 50 to the tool's number where lengths and radii share one memory."""
    text = (
        "%\nO5\nG21 G90\nN1 M6 T1\n(TOOL -1- MILL DIA 10.0)\nG43 H1 Z50.\nS900 M3\nG0 X-20.5 Y0.\nG1 Z-1. F90.\n"
        "G41 D31 X0.\nY30.\nG40 X-20.\nG0 Z50.\nM6 T2\n(TOOL -2- MILL DIA 6.0)\nG43 H32 Z50.\nM30\n%\n"
    )
    preparation, job = raw(tmp_path, text)
    assert preparation.settings.offset_rows == {31: 1, 32: 2}
    assert (
        "offsets H and D: 31 that of tool 1, 32 that of tool 2, which was in the spindle then"
        in job.assumptions
    )
    chunks = list(preparation.interpretation().chunks())
    moves = concatenate([chunk.moves for chunk in chunks], preparation.machine.axes)
    assert moves.end[moves.line == 10][-1, 0] == -5.0
    kept = tmp_path / "kept.toml"
    kept.write_text(text_beside(kept, job, tmp_path / "part.nc"))
    assert prepare(kept).settings.offset_rows == {31: 1, 32: 2}


WRAPPED = "G21 G17 G40 G49 G80\nG54\nT01 M06\nS1500 M03\nG00 G90 X0. Y0. A350.\nG43 Z82. H01\nG01 Z20. F1000.\nZ20.1 A355.\nZ20.2 A0.5\nZ20.3 A5.\nG00 Z82.\nM30\n"


def test_a_cut_from_one_end_of_a_turn_to_the_other_tells_that_axes_roll_over(
    tmp_path: Path,
) -> None:
    made, job = raw(tmp_path, WRAPPED)
    assert made.dialect.name == "fanuc"
    assert "roll over" in made.dialect_reason
    assert "rotary axes roll over: line 9 goes on cutting from A355 to A0.5" in job.assumptions
    chunks = list(made.interpretation().chunks())
    turned = concatenate([chunk.moves for chunk in chunks], made.machine.axes).end[:, 3]
    assert abs(turned[1:] - turned[:-1]).max() <= 10.0
    kept = tmp_path / "kept.toml"
    kept.write_text(text_beside(kept, job, tmp_path / "part.nc"))
    assert prepare(kept).settings.rollover == "shorter"
    _, job = raw(tmp_path, WRAPPED.replace("A0.5", "A358.").replace("A5.", "A359."))
    assert not any("roll over" in each for each in job.assumptions)


def test_one_feed_that_crawls_tells_which_control_was_not_meant(tmp_path: Path) -> None:
    text = "O7\nG21\nT1 M6\nG43 H1\nG0 X1.5 Z5.\nG1 Z-1. F25.\nX9. F250\nG0 Z9.\nM30\n"
    preparation, _ = raw(tmp_path, text)
    assert preparation.dialect.name == "fanuc"
    assert "haas would feed 0.25 mm/min" in preparation.dialect_reason


@pytest.mark.parametrize(
    ("comment", "far", "inches"),
    [
        ("(T1 = 1/2 END MILL)", "3.5", True),
        ("(TOOL 1 = 1IN FACE MILL)", "3.5", True),
        ("(END MILL 1/8)", "3.5", True),
        ("(T1 = 10MM END MILL)", "3.5", False),
        ("(T1 = 1/2 END MILL)", "350.5", False),
        ("(T1 = 1/2 END MILL)\nG21", "3.5", False),
        ("(PART 1/2)", "3.5", False),
    ],
)
def test_tools_in_inches_are_those_of_a_program_in_inches(
    tmp_path: Path, comment: str, far: str, inches: bool
) -> None:
    """Where it names no units and stays within a mill."""
    text = f"O7\n{comment}\nT1 M6\nS900 M3\nG0 X.5 Y.5 Z1.\nG1 Z-.1 F10.\nX{far}\nG0 Z1.\nM30\n"
    preparation, job = raw(tmp_path, text)
    assert (preparation.settings.units == "inch") == inches
    assert any("its tools are in inches" in each for each in job.assumptions) == inches
    assert ('units = "inch"' in job.text) == inches
    moves = concatenate(
        [c.moves for c in preparation.interpretation().chunks()], preparation.machine.axes
    )
    assert moves.end[-1, 0] == pytest.approx(float(far) * (25.4 if inches else 1.0))


def test_feeds_that_hardly_differ_are_told_and_ask_nobody(tmp_path: Path) -> None:
    path = tmp_path / "part.nc"
    path.write_text("O1\nG21 G90 G17 G80\nG0 X10. Y0. Z2.\nG1 Z0. F300.\nG3 Z-5. I-5.\nM30\n")
    made = prepare(path)
    assert made.dialect.name == "fanuc"
    assert "in line 5 fanuc feeds 303" in made.dialect_reason
    assert "--dialect haas or --dialect linuxcnc" in made.dialect_reason


def test_pecks_that_withdraw_differently_ask_nobody(tmp_path: Path) -> None:
    """A Fanuc withdraws by 0.5 mm, LinuxCNC by 0.254 mm: parameters; a hole that is deeper for one of them asks."""
    path = tmp_path / "part.nc"
    text = "O1\nG21 G90 G54\nG0 Z20.\nG98 G83 X1. Y1. Z-9. R2. Q3. F90.\nG80\nM30\n"
    path.write_text(text)
    made = prepare(path)
    assert made.dialect.name == "fanuc"
    assert (
        "in line 4 they withdraw pecks differently, fanuc to Z-0.5 and linuxcnc"
        in made.dialect_reason
    )


def test_where_a_control_goes_by_itself_for_another_tool_asks_nobody(tmp_path: Path) -> None:
    path = tmp_path / "part.nc"
    path.write_text(CONTOUR.replace("N70 G53 G0 Z0.\n", "").replace("N65 G0 Z15.\n", ""))
    assert prepare(path).dialect_reason == "fanuc, haas and linuxcnc make the same moves of it"


def test_a_control_that_would_hardly_feed_was_not_meant(tmp_path: Path) -> None:
    """A Haas counts F300 without a point as 0.3 mm/min; a whole number with a point shows that none is spared."""
    path = tmp_path / "part.nc"
    path.write_text("O1\nG21 G90 G54\nG43 H1 Z20.\nG1 Z-5. F300\nG1 X20.5 F600\nM30\n")
    made = prepare(path, assuming=True)
    assert made.dialect.name == "fanuc"
    assert "haas would feed 0.3 mm/min" in made.dialect_reason
    assert made.reading.keys == {}
    path.write_text(path.read_text().replace("G43 H1", "M10\nG43 H1"))  # which a Haas alone knows
    made = prepare(path, assuming=True)
    assert made.dialect.name == "fanuc"
    assert made.reading.notes == ("M10 does nothing: fanuc has no such code",)


@pytest.mark.parametrize(
    ("numbers", "calculator"),
    [
        ("X20 Y-12.5", True),  # whole numbers without a point, fractions with one
        ("X20. Y-12.5", False),
        ("X20 Y-12.", False),  # a point was forgotten: that is for the control to say
        ("X20 Y30", True),  # else the whole part would be 0.03 mm large
        ("X20000 Y30000", False),
        ("X0 Y0", False),
    ],
)
def test_numbers_without_a_point_count_whole_units_where_the_program_shows_it(
    numbers: str, calculator: bool, tmp_path: Path
) -> None:
    path = tmp_path / "part.nc"
    path.write_text(f"O1\nG21 G90 G54\nG43 H1 Z0\nG1 {numbers} F100\nM30\n")
    made = prepare(path, assuming=True, dialect="fanuc")
    assert (made.settings.decimal_point == "calculator") == calculator
    assert bool(made.reading.notes) == calculator
    assert prepare(path, dialect="fanuc").settings.decimal_point is None


def test_a_control_that_alone_reads_a_program_and_crawls_was_not_meant(tmp_path: Path) -> None:
    path = tmp_path / "part.nc"
    path.write_text(
        "O1\nG21 G90 G54\nG0 Z20.\nG82 X5. Y5. Z-5. R2. P500. F20\nG80\nG0 G91 G28 Z0\nM30\n"
    )
    with pytest.raises(ProgramError) as raised:
        prepare(path, assuming=True)
    assert "read as linuxcnc, which reads it farthest" in str(raised.value)


def test_what_the_machine_acts_upon_is_not_said_to_do_nothing(tmp_path: Path) -> None:
    path = tmp_path / "part.nc"
    path.write_text("G21 G90 G54\nM6 T1\nG0 Z5\nM3 S5000\nG1 X10 Z-1 F100\nM88\nM30\n")
    notes = prepare(path, assuming=True, dialect="grbl").reading.notes
    assert "M6 is the sender's or the builder's tool change: grbl has no such code" in notes
    assert "M88 does nothing: grbl has no such code" in notes


def test_codes_of_the_builder_and_a_single_work_offset_are_assumed_and_kept(tmp_path: Path) -> None:
    text = CONTOUR.replace("N35 G54", "N35 G57 M155").replace("N110", "N108 M256\nN110")
    path = tmp_path / "part.nc"
    path.write_text(text)
    with pytest.raises(ProgramError):
        list(prepare(path, dialect="fanuc").interpretation().chunks())
    made, assumed = with_assumptions(prepare(path, assuming=True), machine=None, strict=False)
    assert made.job.file.offsets == {"G57": {}}
    assert list(made.job.file.m_functions) == ["M155", "M256"]
    assert "M155, M256 do nothing: fanuc has no such code" in assumed.assumptions
    assert any("G57 lies at program zero" in line for line in assumed.assumptions)
    kept = tmp_path / "kept.toml"
    kept.write_text(text_beside(kept, assumed, path))
    again = prepare(kept)
    assert again.settings.m_functions[155].meaning == "not known here: taken to do nothing"
    assert again.job.file.offsets == {"G57": {}}


def test_a_dialect_that_lacks_codes_gives_way_to_one_that_has_them(tmp_path: Path) -> None:
    path = tmp_path / "part.nc"
    path.write_text("O1\nG21 G90\nG43 H1 Z20.\nM88\nG1 X20. F300.\nM89\nM30\n")
    made = prepare(path)
    assert made.dialect.name == "haas"
    assert "fanuc lacks some of its M codes" in made.dialect_reason


def test_a_rare_control_is_not_taken_because_the_common_ones_refuse(tmp_path: Path) -> None:
    path = tmp_path / "part.nc"
    path.write_text("N1 G1 X20. F300\nN2 M3 S500 Q5\nN3 M2\n")
    with pytest.raises(ProgramError) as raised:
        prepare(path)
    assert "read as" in str(raised.value)


def test_the_radius_of_a_listed_tool_is_that_of_the_compensation(tmp_path: Path) -> None:
    text = (
        "O1\n(T1 D=6. CR=0. - ZMIN=-4. - flat end mill)\nG21 G90 G17\nT1 M6\nG43 H1 Z5.\nG0 X-20. Y0.\n"
        "G41 D1 G1 X-10. Y-10. F300.\nG3 X0. Y0. J10. I0.\nG1 Y40.\nG40 X20.\nM30\n"
    )
    made, _ = raw(tmp_path, text)
    assert made.job.file.tools[0].diameter == 6.0


@pytest.mark.parametrize(
    ("head", "dialect"),
    [
        ("(Post Processor: linuxcnc_post)", "linuxcnc"),
        ("(POST - GENERIC HAAS 4X MILL)", "haas"),
        ("(Post Processor: fanuc_post)", "fanuc"),
    ],
)
def test_a_head_names_the_control(tmp_path: Path, head: str, dialect: str) -> None:
    path = tmp_path / "part.nc"
    path.write_text(f"{head}\nG21 G90\nG0 X1. Y1. Z1.\nG1 Z-1. F100.\nM30\n")
    assert prepare(path).dialect.name == dialect


def test_every_dialect_refuses_and_the_one_that_reads_farthest_says_why(tmp_path: Path) -> None:
    path = tmp_path / "part.nc"
    path.write_text("O1\nG21 G90 G17 G94\nG43 H1 Z5.\nG1 X1. F100. Q5.\nM30\n")
    with pytest.raises(ProgramError) as raised:
        prepare(path)
    assert "read as fanuc" in str(raised.value)
    assert "--dialect" in str(raised.value)


@pytest.mark.parametrize("data", [b"(nothing)\n%\n", b"\0" * 300, b"\0\0\r\n\0"])
def test_comments_or_blank_tape_alone_are_an_empty_program(data: bytes, tmp_path: Path) -> None:
    path = tmp_path / "part.nc"
    path.write_bytes(data)
    with pytest.raises(EmptyProgramError):
        prepare(path)


def test_stock_keeps_clear_of_plunging_rapids_and_lies_on_the_table(tmp_path: Path) -> None:
    made, assumed = raw(tmp_path, CONTOUR)
    file = made.job.file
    assert file.stock is not None
    assert file.stock.size is not None
    left = file.stock.position[0] - file.stock.size[0] / 2.0
    assert -12.0 + 5.0 < left < -5.0  # beside the tool that plunges at X-12
    assert file.stock.position[2] == 0.0
    assert file.stock.size[2] == 22.0
    center = made.machine.part_frame.center
    assert file.part_zero["X"] == pytest.approx(center[0] - file.stock.position[0], abs=1e-3)
    assert "Z" in file.part_zero
    assert any("top at Z0" in line for line in assumed.assumptions)


def test_tools_come_from_the_list_of_the_post(tmp_path: Path) -> None:
    made, assumed = raw(tmp_path, CONTOUR)
    tools = [(tool.number, tool.kind, tool.diameter) for tool in made.job.file.tools]
    assert tools == [(1, "flat", 10.0), (2, "drill", 6.8)]
    assert "T2 drill of 6.8 mm: from its comment" in assumed.assumptions[2]


def test_a_tool_that_only_drills_is_a_drill(tmp_path: Path) -> None:
    text = CONTOUR.replace("(T2 D=6.8 CR=0. TAPER=118deg - ZMIN=-12. - drill)\n", "")
    made, assumed = raw(tmp_path, text)
    assert made.job.file.tools[1].kind == "drill"
    assert "diameter is a guess" in assumed.assumptions[2]


@pytest.mark.parametrize(
    ("old", "new", "by_hand"),
    [
        (" S5000", "", True),
        (" S5000", " S0", False),
        (" S5000 M3", "", False),
        ("S5000 M3", "S5000", False),
    ],
)
def test_a_spindle_that_is_started_without_any_speed_has_one_by_hand(
    tmp_path: Path, old: str, new: str, by_hand: bool
) -> None:
    text = CONTOUR.split("N75", maxsplit=1)[0].replace(
        "N30 S5000 M3", "N30" + " S5000 M3".replace(old, new)
    )
    preparation, assumed = raw(tmp_path, text + "M30\n")
    speeds = [tool.speed for tool in preparation.job.file.tools]
    assert speeds == [SPEED_BY_HAND if by_hand else None]
    assert any("set by hand" in line for line in assumed.assumptions) == by_hand


def test_a_tool_that_is_called_ahead_does_not_cut_yet(tmp_path: Path) -> None:
    text = CONTOUR.replace("N30 S5000", "N28 T2\nN30 S5000").replace(
        "(T2 D=6.8 CR=0. TAPER=118deg - ZMIN=-12. - drill)\n", ""
    )
    made, _ = raw(tmp_path, text)
    assert [(tool.number, tool.kind) for tool in made.job.file.tools] == [(1, "flat"), (2, "drill")]


def test_stock_of_the_head_comes_before_the_path(tmp_path: Path) -> None:
    head = "( Material Size)\n( X= 90.0, Y= 70.0, Z= 18.0)\n"
    made, _ = raw(tmp_path, CONTOUR.replace("(T1", f"{head}(T1"))
    assert made.job.file.stock is not None
    assert made.job.file.stock.size == (90.0, 70.0, 18.0)


def test_what_a_shared_file_says_holds(tmp_path: Path) -> None:
    (tmp_path / "twin.toml").write_text(
        '[stock]\nshape = "cylinder"\ndiameter = 200.0\nheight = 30.0\n'
    )
    made, _ = raw(tmp_path, CONTOUR)
    assert made.job.file.stock is not None
    assert made.job.file.stock.shape == "cylinder"


def test_the_job_can_be_kept_in_another_folder(tmp_path: Path) -> None:
    made, assumed = raw(tmp_path, CONTOUR)
    folder = tmp_path / "jobs"
    folder.mkdir()
    path = folder / "kept.toml"
    path.write_text(text_beside(path, assumed, made.job.program))
    again = prepare(path)
    assert again.dialect.name == "fanuc"
    assert again.job.file.stock == made.job.file.stock
    assert again.job.file.tools == made.job.file.tools


@pytest.mark.parametrize("name", ["mill5", "mill4/uncompensated"])
def test_the_job_that_is_kept_names_the_machine_that_was_asked_for(
    tmp_path: Path, name: str
) -> None:
    program = tmp_path / "part.nc"
    program.write_text(CONTOUR)
    _, assumed = with_assumptions(prepare(program, machine=name), machine=name, strict=False)
    assert f'machine = "{name}"' in assumed.text
    own = tmp_path / "own"
    own.symlink_to(machine_file("mill4").parent)
    _, assumed = with_assumptions(
        prepare(program, machine=str(own)), machine=str(own), strict=False
    )
    assert tomllib.loads(assumed.text)["machine"] == machine_file("mill4").resolve().as_posix()


@pytest.mark.parametrize(
    ("comment", "tool"),
    [
        ("T1 D=10. CR=0. - ZMIN=-5. - flat end mill", (1, "flat", 10.0, None)),
        ("T3  D=6. CR=3. - ZMIN=-3. - ball end mill", (3, "ball", 6.0, None)),
        ("T5 D=10. CR=1. - ZMIN=-3. - bullnose end mill", (5, "bull", 10.0, 1.0)),
        (" T1 | 10. FLAT ENDMILL | H1 | D1 | XY STOCK TO LEAVE - 0.", (1, "flat", 10.0, None)),
        ("TOOL - 1 DIA. OFF. - 1 LEN. - 1 DIA. - 12.", (1, "", 12.0, None)),
        ("T239|1/2 FLAT ENDMILL|H239", (239, "flat", 12.7, None)),
        ("T1 = End Mill (6 mm)", (1, "flat", 6.0, None)),
        ("T1 : 3.0", (1, "", 3.0, None)),
        ("TOOL -1- MILL DIA 10.0 R0. MM ", (1, "flat", 10.0, None)),
        ("1 = Ball Nose Bit {6.0 mm}", (1, "ball", 6.0, None)),
        ("T4 M8 TAP", (4, "drill", 8.0, None)),
        ("T2 90 DEG CHAMFER MILL 12 mm", (2, "chamfer", 12.0, None)),
        ("6.8 DRILL", (None, "drill", 6.8, None)),
        ("TC: 5mm Endmill", (None, "flat", 5.0, None)),
        ("FREZA D5", (None, "", 5.0, None)),
        ("T02 ID=002  DIA-0.5000  TOOL END MILL", (2, "flat", 0.5, None)),
        ("FACE MILL H1 D2", (None, "flat", None, None)),
        ("#2 D=10 - ZMIN=-20.5 - ZMAX=+15 - flat end mill", (2, "flat", 10.0, None)),
        ("T1 : 16MM SLOT DRILL", (1, "flat", 16.0, None)),
        ("T5 | #7 DRILL | H5", (5, "drill", 5.1054, None)),
    ],
)
def test_comments_tell_tools(comment: str, tool: tuple[object, ...]) -> None:
    listed = numbered_tool(comment)
    number, text = (None, comment) if listed is None else listed
    found = tool_of_comment(text, inches=False)
    assert (number, found.kind, found.diameter, found.corner) == tool


def test_a_comment_beside_its_call_tells_the_diameter_alone(tmp_path: Path) -> None:
    made, _ = raw(tmp_path, CONTOUR.replace("(T1 D=10.", "(").replace("T1 M6", "T1 M6 (D26)"))
    assert made.job.file.tools[0].diameter == 26.0


def test_numbers_without_a_unit_are_inches_where_the_program_is() -> None:
    assert tool_of_comment("0.5 FLAT ENDMILL", inches=True).diameter == 12.7
    assert tool_of_comment("10 mm FLAT ENDMILL", inches=True).diameter == 10.0


def test_words_of_an_axis_that_stays_at_zero_are_passed_over(tmp_path: Path) -> None:
    made, assumed = raw(tmp_path, CONTOUR.replace("X-12. Y0.", "X-12. Y0. A0."))
    assert made.job.file.axes == {"A": "ignored at 0"}
    assert assumed.assumptions[-1] == "A stays at 0: the machine has no such axis"
    path = tmp_path / "part.nc"
    path.write_text(CONTOUR.replace("X-12. Y0.", "X-12. Y0. A90."))
    with pytest.raises(ProgramError, match="no axis A") as raised:
        prepare(path)
    assert '[axes] A = "ignored at 0"' in str(raised.value)
    assert 'A = "C" where it means C' in str(raised.value)


def test_a_word_stands_for_an_axis_of_the_machine(tmp_path: Path) -> None:
    (tmp_path / "part.nc").write_text("O1\nG1 X10. A90. F100.\nM30\n")
    job = tmp_path / "part.toml"
    job.write_text('program = "part.nc"\ndialect = "fanuc"\n[axes]\nA = "C"\n')
    moves = next(prepare(job).interpretation().chunks()).moves
    assert moves.end[0].tolist() == [10.0, 0.0, 0.0, 90.0]
    for wrong in ('A = "B"', 'X = "C"'):
        job.write_text(f'program = "part.nc"\ndialect = "fanuc"\n[axes]\n{wrong}\n')
        with pytest.raises(ConfigError, match="job key 'axes"):
            prepare(job)


def test_stock_that_is_cut_back_from_rapids_says_so_with_their_lines(tmp_path: Path) -> None:
    """A rapid below the stock's top may be beside it, or a crash: nobody can tell, and it is not kept quiet."""
    _, assumed = raw(tmp_path, CONTOUR)
    assert any("of line 13 go below its top" in line for line in assumed.assumptions)
    _, assumed = raw(tmp_path, CONTOUR.replace("N50 Z-4.", "N50 G1 Z-4. F300."))
    assert not any("not judged" in line for line in assumed.assumptions)


KLARTEXT = """BEGIN PGM PLATE MM
BLK FORM 0.1 Z X-5 Y+0 Z-20
BLK FORM 0.2 X+95 Y+60 Z+1
TOOL DEF 4 L+0 R+3
TOOL CALL 4 Z S3000 F500
L X-20 Y+10 Z+5 R0 FMAX M3
L Z-2 F200
L X+40
L Z+50 FMAX
END PGM PLATE MM
"""


def test_klartext_declares_its_stock_and_its_tools(tmp_path: Path) -> None:
    _, made = raw(tmp_path, KLARTEXT)
    assert made.tables["stock"] == {
        "shape": "box",
        "size": [100, 60, 21],
        "position": [45.0, 30.0, 1.0],
    }
    (tool,) = made.tables["tools"]  # pyright: ignore[reportGeneralTypeIssues]
    assert (tool["number"], tool["diameter"]) == (4, 6.0)


def test_klartext_declares_a_cylinder(tmp_path: Path) -> None:
    blank = "BLK FORM CYLINDER Z R40 L25 DIST+2\n"
    _, made = raw(
        tmp_path, KLARTEXT.split("BLK", maxsplit=1)[0] + blank + KLARTEXT.split("Z+1\n")[1]
    )
    stock = made.tables["stock"]
    assert stock == {
        "shape": "cylinder",
        "diameter": 80,
        "height": 25,
        "position": [0.0, 0.0, 2.0],
    }


@pytest.mark.parametrize(
    "damage",
    ["X" + "9" * 6000, "(T" + "9" * 6000 + " DRILL)", "(T1 D=1e999 - DRILL)", "(1/0 DRILL)", "(STOCK X0 Y0 Z0)", "M9999 T99999999", "\0G57"],
)  # fmt: skip
def test_damaged_text_is_refused_or_read_and_never_ends_in_a_traceback(
    damage: str, tmp_path: Path
) -> None:
    path = tmp_path / "part.nc"
    path.write_text(CONTOUR.replace("N30", f"{damage}\nN30"))
    with contextlib.suppress(TwinError):
        with_assumptions(prepare(path, assuming=True), machine=None, strict=False)


def test_nothing_is_assumed_of_points_where_they_never_count(tmp_path: Path) -> None:
    path = tmp_path / "part.h"
    path.write_text(
        "BEGIN PGM KEY_M10 MM\nL X+10 Y+5.5 F100\nEND PGM KEY_M10 MM\n", encoding="utf-8"
    )
    reading = prepare(path, assuming=True).reading
    assert reading is not None
    assert reading.notes == ()
    assert reading.keys == {}


def test_tolerances_are_assumed_for_moves_that_there_are(tmp_path: Path) -> None:
    _, alone = raw(tmp_path, "%\nO1\nG21 G90 G17 G54\nG0 X10. Y0. Z2.\nX20.\nM30\n%\n")
    assert "\ncontour_um" not in alone.text
    assert "rapid_contour_um" in alone.text
    _, fed = raw(tmp_path, "%\nO1\nG21 G90 G17 G54\nG1 X10. F300.\nX20.\nM30\n%\n")
    assert "\ncontour_um" in fed.text
    assert "rapid_contour_um" not in fed.text


def test_the_names_of_tools_tell_what_they_are(tmp_path: Path) -> None:
    text = 'G17 G71 G90\nT="MILL_D16"\nM6\nT="MILL_12"\nM6\nT="BORE 1"\nM6 ; BOHRER D8.5\nG0 X0 Y0 Z5\nG1 Z-3 F200\nM30\n'
    (tmp_path / "part.mpf").write_text(text)
    preparation = prepare(tmp_path / "part.mpf")
    made, _ = with_assumptions(preparation, machine=None, strict=False)
    tools = [(each.name, each.kind, each.diameter) for each in made.job.file.tools]
    assert tools == [
        ("MILL_D16", "flat", 16.0),
        ("MILL_12", "flat", 12.0),
        ("BORE 1", "drill", 8.5),
    ]
    assert list(made.interpretation().chunks())
    assert not made.interpretation().diagnostics


def test_stock_keeps_clear_of_rapids_in_the_plane_beside_the_part(tmp_path: Path) -> None:
    """A lead from outside goes back with rapid at depth; one across the part is no reason to take it away."""
    beside = "G21 G90 G17\nT1 M6\nS2000 M3\nG0 X-20. Y-20. Z5.\nG1 Z-3. F300.\nX-6.\nY70.\nX100.\nY-6.\nX-20.\n{}\nG0 Z50.\nM30\n"
    made, job = raw(tmp_path, "%\nO1\n" + beside.format("G0 Y-20."))
    assert "less where the rapids of line 13 go below its top" in " ".join(job.assumptions)
    stock = made.job.file.stock
    assert stock is not None
    assert stock.size is not None
    assert stock.position[0] - stock.size[0] / 2.0 > -15.0
    made, job = raw(tmp_path, "%\nO1\n" + beside.format("G0 X90. Y60."))
    assert "less where" not in " ".join(job.assumptions)


def test_tools_that_a_program_writes_into_the_table_are_its_own(tmp_path: Path) -> None:
    """HeeksCNC and Fabex write G10 L1 for each; where lengths are called, heights count from those that it writes."""
    text = "G21 G90\nG10 L1 P1 R4.000 Z20.000\nN30G10L1P2 R1.5Z20\nT1 M6\nS900 M3\n{}G0 X1 Z5\nG1 Z-1 F90\nX9\nG0 Z5\nT2 M6\nG1 Z-2 F90\nG0 Z5\nM2\n"
    made, _ = raw(tmp_path, text.format(""))
    assert made.dialect.name == "linuxcnc"
    tools = [(each.number, each.kind, each.diameter) for each in made.job.file.tools]
    assert tools == [(1, "flat", 8.0), (2, "drill", 3.0)]
    assert list(made.interpretation().chunks())
    longer, _ = raw(tmp_path, text.format("").replace("R1.5Z20", "R1.5Z50"))
    assert longer.job.file.stock == made.job.file.stock  # no length is called
    assert [each.length for each in longer.job.file.tools] == [60.0, 60.0]
    called, _ = raw(tmp_path, text.format("G43 H1\n"))
    assert [each.length for each in called.job.file.tools] == [20.0, 20.0]
    with pytest.raises(UsageError, match="length of tool 1 and calls it, and not that of tool 2"):
        raw(tmp_path, text.format("G43 H1\n").replace("R1.5Z20", "R1.5"))
    with pytest.raises(UsageError, match="writes 0 mm as the length of tool 2 and calls it"):
        raw(tmp_path, text.format("G43 H1\n").replace("R1.5Z20", "R1.5Z0"))


FANUC_TABLE = """O31
G21 G90 G17 G40 G49 G80
G10 L10 P1 R152.4
G10 L12 P1 R4.
G10 L10 P2 R101.
G10 L12 P2 R2.5
T1 M6
G54 G0 X0. Y0. S3000 M3
G43 H1 Z20.
Z2.
G1 Z-3. F200.
G41 D1 X10. F400.
Y30.
G40 X40.
G0 Z20.
G49
T2 M6
S3000 M3
G43 H2 Z60.
G0 X20. Y10.
G99 G81 Z-9. R2. F100.
G80
G0 Z20.
M30
"""


def test_lengths_and_radii_that_a_fanuc_program_writes_are_its_tools(tmp_path: Path) -> None:
    """Heights count from those lengths: with others they lay 90 mm too high."""
    made, assumed = raw(tmp_path, FANUC_TABLE)
    tools = [(each.number, each.diameter, each.length) for each in made.job.file.tools]
    assert tools == [(1, 8.0, 152.4), (2, 5.0, 101.0)]
    stock = made.job.file.stock
    assert stock is not None
    assert stock.size is not None
    assert (stock.position[2], stock.size[2]) == (0.0, 19.0)
    assert any("from what the program writes" in line for line in assumed.assumptions)
    moves = concatenate([each.moves for each in made.interpretation().chunks()], made.machine.axes)
    assert moves.end[moves.line == 11][-1, 2] == -3.0
    with pytest.raises(UsageError, match=r"-250\.5 mm as the length of tool 1"):
        raw(tmp_path, FANUC_TABLE.replace("R152.4", "R-250.5"))


def test_rounding_that_a_program_allows_is_no_error_of_its_contour(tmp_path: Path) -> None:
    """Raw files of pcb2gcode say G64 P in inches: up to that the control may leave the path."""
    text = "G20 G90\n{}\nT1 M6\nS900 M3\nG0 X1 Z.5\nG1 Z-.1 F9\nX2\nG0 Z.5\nM2\n"
    allowed, job = raw(tmp_path, text.format("G64 P0.005"))
    assert allowed.job.file.tolerance.contour_um == pytest.approx(147.0)
    assert any("by 127 µm more" in each for each in job.assumptions)
    silent, _ = raw(tmp_path, text.format("G64"))
    assert silent.job.file.tolerance.contour_um == pytest.approx(20.0)


@pytest.mark.seconds("a program is run")
def test_what_goes_through_a_stock_of_the_program_meets_no_parallels(tmp_path: Path) -> None:
    """Nobody says where they are; a job that does not give them room has its alarm."""
    text = "BEGIN PGM A MM\nBLK FORM 0.1 Z X-45 Y-45 Z-10\nBLK FORM 0.2 X+45 Y+45 Z+0\nTOOL CALL 1 Z S3000 ; DRILL D5\nM3\nL X+30 Y+30 Z+5 R0 FMAX\nL Z-11.5 F900\nL Z+5 FMAX\nM30\nEND PGM A MM\n"
    (tmp_path / "part.h").write_text(text)
    made, job = with_assumptions(prepare(tmp_path / "part.h"), machine=None, strict=False)
    assert made.job.file.stock is not None
    assert made.job.file.stock.relief == 3.0
    assert "3 mm below it are free, since the path goes through" in " ".join(job.assumptions)
    assert not alarms_of(made)
    kept = tmp_path / "kept.toml"
    kept.write_text("".join(line for line in job.text.splitlines(True) if "relief" not in line))
    assert alarms_of(prepare(kept)) == ["collision"]


def alarms_of(preparation: Preparation) -> list[str]:
    outcome = Run(preparation).execute(None, no_progress)
    return [alarm.code for alarm in outcome.alarms]


def test_a_guessed_diameter_is_said_and_strict_runs_none(tmp_path: Path) -> None:
    path = tmp_path / "part.nc"
    path.write_text(CONTOUR.replace("(T1 D=10. CR=0. - ZMIN=-4. - flat end mill)\n", ""))
    made, assumed = prepare_run(path)
    assert assumed is not None
    assert assumed.guessed_tools == (1,)
    assert "T1 flat of 10 mm: diameter is a guess" in made.assumptions
    with pytest.raises(UsageError, match=r"diameter of T1, and --strict .*\(T1 D=10"):
        prepare_run(path, strict=True)
    path.write_text(CONTOUR)
    prepare_run(path, strict=True)
