"""Settings that jobs share: nearest first, tables key by key, errors at the file that is wrong."""

from pathlib import Path

import pytest

from twin.errors import ConfigError
from twin.files.shipped import resource_root
from twin.job.load import Job, load_job

SHARED = """
machine = "mill4_light"
[stock]
shape = "box"
size = [60.0, 60.0, 20.0]
[tolerance]
contour_um = 30.0
cycle_time_s = 100.0
"""


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    (tmp_path / "inner").mkdir()
    (tmp_path / "inner" / "part.nc").write_text("N1 G0 X1\n")
    (tmp_path / "twin.toml").write_text(SHARED)
    return tmp_path / "inner"


def job(folder: Path, text: str = "") -> Job:
    (folder / "part.toml").write_text(f'program = "part.nc"\n{text}')
    return load_job(folder / "part.toml")


def test_a_job_says_only_what_differs(folder: Path):
    file = job(folder, "[tolerance]\ncontour_um = 5.0\n").file
    assert file.machine == "mill4_light"
    assert (file.tolerance.contour_um, file.tolerance.cycle_time_s) == (5.0, 100.0)
    assert file.stock is not None
    assert file.stock.size == (60.0, 60.0, 20.0)


def test_a_program_without_a_job_shares_them_too(folder: Path):
    assert load_job(folder / "part.nc").file.machine == "mill4_light"


def test_the_nearest_folder_and_what_a_job_extends_come_first(folder: Path):
    (folder / "twin.toml").write_text("[tolerance]\ncontour_um = 10.0\n")
    (folder / "fine.toml").write_text('extends = "finer.toml"\nmachine = "mill4"\n')
    (folder / "finer.toml").write_text("[tolerance]\ncontour_um = 1.0\nfollowing_um = 7.0\n")
    assert job(folder).file.tolerance.contour_um == 10.0
    file = job(folder, 'extends = "fine.toml"\n').file
    assert (file.machine, file.tolerance.contour_um) == ("mill4", 1.0)
    assert (file.tolerance.following_um, file.tolerance.cycle_time_s) == (7.0, 100.0)


def test_a_stock_of_another_shape_is_taken_whole(folder: Path):
    stock = job(folder, '[stock]\nshape = "cylinder"\ndiameter = 40.0\nheight = 9.0\n').file.stock
    assert stock is not None
    assert (stock.size, stock.diameter) == (None, 40.0)


def test_paths_are_relative_to_the_file_that_says_them(folder: Path):
    machine = resource_root("models") / "mill4" / "machine.toml"
    (folder.parent / "mine.toml").write_text(machine.read_text(encoding="utf-8"))
    (folder.parent / "twin.toml").write_text('machine = "mine.toml"\n')
    assert job(folder).file.machine == str(folder.parent / "mine.toml")


def test_an_error_names_the_file_that_it_stands_in(folder: Path):
    (folder.parent / "twin.toml").write_text("[tolerance]\ncontour = 3.0\n")
    with pytest.raises(ConfigError, match=r"/twin\.toml: unknown key 'tolerance\.contour'"):
        job(folder)
    (folder.parent / "twin.toml").write_text('program = "part.nc"\n')
    with pytest.raises(ConfigError, match="name no 'program'"):
        job(folder)


def test_files_that_extend_each_other_in_a_circle_are_refused(folder: Path):
    (folder / "a.toml").write_text('extends = "b.toml"\n')
    (folder / "b.toml").write_text('extends = "a.toml"\n')
    with pytest.raises(ConfigError, match="extend each other"):
        job(folder, 'extends = "a.toml"\n')
    with pytest.raises(ConfigError, match="cannot be read"):
        job(folder, 'extends = "none.toml"\n')
    with pytest.raises(ConfigError, match="must be the name"):
        job(folder, "extends = 3\n")
