from pathlib import Path

import pytest

from twin.errors import ConfigError, ExitCode
from twin.files.toml import read_toml
from twin.job.job_file import JobFile
from twin.job.load import load_job


def job_text(tmp_path: Path, text: str) -> Path:
    path = tmp_path / "job.toml"
    path.write_text(text, encoding="utf-8")
    return path


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ('program = "a.nc"\nmaschine = "mill4"', "did you mean 'machine'?"),
        ('program = "a.nc"\n[tolerance]\ncontur_um = 3', "did you mean 'contour_um'?"),
        ('program = "a.nc"\n[[tools]]\nnumber = 1\nlenght = 3.0', "did you mean 'length'?"),
        ('machine = "mill4"', "'program' is missing"),
        ('program = "a.nc"\n[tolerance]\ncontour_um = -1', "tolerance.contour_um"),
        ('program = "a.nc"\n[tolerance]\ncontour_um = nan', "tolerance.contour_um"),
        ('program = "a.nc"\n[stock]\nshape = "box"', "needs size"),
        (
            'program = "a.nc"\n[stock]\nshape = "cylinder"\ndiameter = 3.0',
            "needs diameter and height",
        ),
        (
            'program = "a.nc"\n[tools.2]\ndiameter = 6.0',
            "'tools' is a list of tables: write [[tools]] and number = 2 in place of [tools.2]",
        ),
        ('program = "a.nc"\n[tools]\nnumber = 2', "write [[tools]] in place of [tools]"),
        ("program = [", "is not TOML"),
        ("program = " + "9" * 5000, "is not TOML"),
        ('program = "a\\u0000.nc"', "NUL"),
        ('program = ["a", {b = "a\\u0000.nc"}]', "NUL"),
        ("program = " + "[" * 5000 + "]" * 5000, "deep"),
        (".".join(["program"] * 5000) + " = 1", "deep"),
    ],
)
def test_wrong_files_say_which_key_and_what_would_fit(tmp_path: Path, text: str, said: str):
    with pytest.raises(ConfigError) as caught:
        read_toml(job_text(tmp_path, text), JobFile)
    assert said in str(caught.value)
    assert "job.toml" in str(caught.value)
    assert caught.value.exit_code is ExitCode.USAGE


def test_missing_and_binary_files_are_refused(tmp_path: Path):
    with pytest.raises(ConfigError, match="cannot be read"):
        read_toml(tmp_path / "absent.toml", JobFile)
    (tmp_path / "binary.toml").write_bytes(b"\xff\xfe\x00")
    with pytest.raises(ConfigError, match="not UTF-8"):
        read_toml(tmp_path / "binary.toml", JobFile)


def test_a_program_is_run_by_the_job_beside_it(tmp_path: Path):
    program = tmp_path / "part.nc"
    program.write_text("G0 X0", encoding="utf-8")
    assert load_job(program).file == JobFile(program="part.nc")
    (tmp_path / "part.toml").write_text(
        'program = "part.nc"\ndefault_feed = 77.0', encoding="utf-8"
    )
    assert load_job(program).file.default_feed == 77.0
    assert load_job(tmp_path / "part.toml").program == program


def test_a_job_without_its_program_is_refused(tmp_path: Path):
    path = job_text(tmp_path, 'program = "absent.nc"')
    with pytest.raises(ConfigError, match=r"absent\.nc: no such NC program"):
        load_job(path)


def test_true_is_no_number_in_any_table(tmp_path: Path) -> None:
    (tmp_path / "a.nc").write_text("G0 X1\n")
    job = tmp_path / "a.toml"
    job.write_text('program = "a.nc"\n[offsets.G54]\nX = false\n[tolerance]\ncontour_um = true\n')
    with pytest.raises(
        ConfigError, match=r"'tolerance.contour_um': a number is wanted.*true"
    ) as told:
        load_job(job)
    assert "'offsets.G54.X'" in str(told.value)
    job.write_text('program = "a.nc"\nblock_skip = true\ncutting_load = false\n')
    assert load_job(job).file.block_skip is True


def test_a_number_in_quotes_is_refused_with_what_to_write(tmp_path: Path) -> None:
    (tmp_path / "a.nc").write_text("G0 X1\n")
    job = tmp_path / "a.toml"
    job.write_text(
        'program = "a.nc"\nstep_limit = "7"\nblock_skip = "yes"\n[offset_rows]\n1 = "1"\n'
        '[tolerance]\ncontour_um = " 5.5"\n[[tools]]\nnumber = 1\ncenter_cutting = 1\n'
    )
    with pytest.raises(ConfigError) as raised:
        load_job(job)
    message = str(raised.value)
    assert "'step_limit': a number is written without quotes: 7 (got '7')" in message
    assert "'block_skip': true or false, without quotes, is wanted here (got 'yes')" in message
    assert "'offset_rows.1': a number is written without quotes: 1 (got '1')" in message
    assert "'tolerance.contour_um': a number is written without quotes: 5.5" in message
    assert "'tools.0.center_cutting': true or false, without quotes" in message


@pytest.mark.parametrize(
    "written",
    [
        "start.C = 1e12",
        "part_zero.X = -1e12",
        "offsets.G54.Z = 1e8",
        "tool_change.height = 1e9",
        'stock = { shape = "box", size = [1, 1, 1], position = [0, 1e9, 0] }',
        'fixtures = [{ name = "vise", size = [1, 1, 1], position = [0, 1e9, 0] }]',
    ],
)
def test_a_place_that_no_machine_reaches_is_refused(tmp_path: Path, written: str) -> None:
    (tmp_path / "a.nc").write_text("G0 X1\n")
    job = tmp_path / "a.toml"
    job.write_text(f'program = "a.nc"\n{written}\n')
    with pytest.raises(ConfigError, match=r"should be (less|greater) than or equal to -?10000000"):
        load_job(job)
