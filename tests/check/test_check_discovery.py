from pathlib import Path

import pytest

from twin.check.discovery import find_programs
from twin.errors import UsageError


@pytest.fixture
def shop(tmp_path: Path) -> Path:
    (tmp_path / "deep" / ".hidden").mkdir(parents=True)
    (tmp_path / "ring.nc").touch()
    (tmp_path / "ring.toml").write_text('program = "ring.nc"')
    (tmp_path / "other.toml").write_text('program = "ring.nc"\nmachine = "big"')
    (tmp_path / "deep" / "plain.NC").touch()
    (tmp_path / "deep" / ".hidden" / "secret.nc").touch()
    (tmp_path / "machine.toml").write_text('name = "no job"')
    (tmp_path / "readme.md").touch()
    (tmp_path / "broken.toml").write_text("program =")
    return tmp_path


def names(folder: Path, paths: list[Path]) -> list[str]:
    return [str(path.relative_to(folder)) for path in paths]


def test_a_folder_gives_its_jobs_and_the_programs_without_one(shop: Path):
    assert names(shop, find_programs([shop])) == ["deep/plain.NC", "other.toml", "ring.toml"]


def test_a_broken_job_beside_its_program_is_left_to_the_run(shop: Path):
    (shop / "broken.nc").touch()
    assert "broken.toml" in names(shop, find_programs([shop]))
    assert "broken.nc" not in names(shop, find_programs([shop]))


def test_files_and_globs_are_taken_once_in_the_order_given(shop: Path):
    found = find_programs([str(shop / "ring.nc"), str(shop / "r*.toml"), str(shop / "**" / "*.NC")])
    assert names(shop, found) == ["ring.nc", "ring.toml", "deep/plain.NC"]
    assert len(find_programs([shop / "ring.nc", shop / "ring.nc"])) == 1


def test_nothing_is_an_error_that_says_what_was_looked_for(shop: Path, tmp_path: Path):
    with pytest.raises(UsageError, match="no such file or folder"):
        find_programs([shop / "none.nc"])
    with pytest.raises(UsageError, match=r"looked for job files .*\.nc"):
        find_programs([str(shop / "*.xyz")])
    (tmp_path / "empty").mkdir()
    with pytest.raises(UsageError, match="no programs in"):
        find_programs([tmp_path / "empty"])
