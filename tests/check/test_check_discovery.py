import re
from pathlib import Path

import pytest

from twin.check.dependents import dependents
from twin.check.discovery import baselines_without_programs, file_of, find_programs, without_jobs
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


@pytest.mark.parametrize("empty", ["nope*.toml", "void", "void*"])
def test_each_path_holds_something_to_run(empty: str, shop: Path) -> None:
    (shop / "void").mkdir()
    with pytest.raises(UsageError, match=f"no programs in {re.escape(str(shop / empty))}:"):
        find_programs([shop / "ring.toml", str(shop / empty)])


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


def test_foreign_folders_are_left_alone_and_programs_without_jobs_are_known(tmp_path: Path):
    for folder in ("node_modules", ".hidden", "environment", "own"):
        (tmp_path / folder).mkdir()
        (tmp_path / folder / "part.nc").write_text("N1 G0 X1\n")
    (tmp_path / "environment" / "pyvenv.cfg").touch()
    (tmp_path / "own" / "job.toml").write_text('program = "other.nc"\n')
    (tmp_path / "own" / "other.nc").touch()
    found = find_programs([tmp_path])
    assert found == [tmp_path / "own" / "job.toml", tmp_path / "own" / "part.nc"]
    assert without_jobs(found) == [tmp_path / "own" / "part.nc"]


def test_baselines_whose_programs_are_gone_are_known(tmp_path: Path):
    for name in ("with_job.baseline", "alone.nc.baseline", "gone.baseline"):
        (tmp_path / "baselines").mkdir(exist_ok=True)
        (tmp_path / "baselines" / name).touch()
    (tmp_path / "with_job.toml").touch()
    (tmp_path / "alone.nc").touch()
    left = baselines_without_programs(tmp_path / "baselines")
    assert left == [tmp_path / "baselines" / "gone.baseline"]


def test_a_folder_of_baselines_may_lie_anywhere(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    for name in ("part.toml", "alone.nc"):
        Path(name).touch()
        baseline = file_of(Path("far/baselines"), Path(name), ".baseline")
        baseline.parent.mkdir(parents=True, exist_ok=True)
        baseline.touch()
    assert baselines_without_programs(Path("far/baselines")) == []


def test_of_files_of_any_kind_programs_and_jobs_are_checked_each_once(tmp_path: Path) -> None:
    (tmp_path / "pyproject.toml").write_text("[project]\n")
    (tmp_path / "job.toml").write_text('program = "run.nc"\n')
    for name in ("run.nc", "alone.nc", "readme.md"):
        (tmp_path / name).write_text("M30\n")
    files = [*sorted(tmp_path.iterdir()), tmp_path / "gone.nc"]
    assert [path.name for path in dependents(files, tmp_path)] == ["job.toml", "alone.nc"]
    assert dependents([tmp_path / "pyproject.toml"], tmp_path) == []


def test_of_files_that_end_in_h_those_in_klartext_are_programs(tmp_path: Path) -> None:
    (tmp_path / "part.h").write_text("; roughing\n0 BEGIN PGM PART MM\n1 END PGM PART MM\n")
    (tmp_path / "board.h").write_text("#ifndef BOARD_H\n#define BOARD_H\n#endif\n")
    assert names(tmp_path, find_programs([tmp_path])) == ["part.h"]
    assert names(tmp_path, dependents(sorted(tmp_path.iterdir()), tmp_path)) == ["part.h"]


def test_a_job_is_checked_where_what_it_uses_has_changed(tmp_path: Path) -> None:
    folder = tmp_path / "parts"
    folder.mkdir()
    (folder / "one.nc").write_text("G0 X1\n")
    (folder / "one.toml").write_text('program = "one.nc"\nextends = "base.toml"\n')
    (folder / "two.nc").write_text("G0 X1\n")
    (folder / "two.toml").write_text('program = "two.nc"\n')
    (folder / "base.toml").write_text("default_feed = 500.0\n")
    (tmp_path / "other.toml").write_text("")
    for changed, jobs in (
        (folder / "base.toml", ["one.toml"]),
        (tmp_path / "twin.toml", ["one.toml", "two.toml"]),  # it is gone
        (tmp_path / "other.toml", []),
    ):
        assert [path.name for path in dependents([changed], tmp_path)] == jobs


def test_a_program_is_checked_where_a_file_that_it_calls_has_changed_or_is_gone(
    tmp_path: Path,
) -> None:
    for name, text in {
        "siemens.mpf": "G0 X1\nL10\nM30\n",
        "L10.spf": "DEEP\nM17\n",
        "deep.spf": "G1 X2 F100\nM17\n",
        "fanuc.nc": "O1\nM98 P0031001\nM30\n",
        "O1001.nc": "O1001\nG0 X1\nM99\n",
        "linux.ngc": "o<in side> call\nM2\n",
        "inside.ngc": "o<inside> sub\no<inside> endsub\n",
        "klartext.h": "0 BEGIN PGM K MM\n1 CALL PGM sub\\hole.h\n2 END PGM K MM\n",
        "alone.nc": "G0 X7\nM30\n",
        "job.toml": 'program = "fanuc.nc"\n',
        "second.toml": 'program = "alone.nc"\n',
    }.items():
        (tmp_path / name).write_text(text)
    for changed, callers in (
        ("deep.spf", {"siemens.mpf", "L10.spf"}),
        ("L10.spf", {"siemens.mpf"}),
        ("O1001.nc", {"job.toml"}),
        ("inside.ngc", {"linux.ngc"}),
        ("hole.h", {"klartext.h"}),
        ("alone.nc", {"second.toml"}),
        ("job.baseline", {"job.toml"}),
        ("alone.stl", set()),
    ):
        (tmp_path / changed).unlink(missing_ok=True)
        found = dependents([tmp_path / changed], tmp_path)
        assert {path.name for path in found} >= callers, changed
        assert len(found) == len(callers) or changed == "alone.nc", changed
        if changed == "O1001.nc":
            (tmp_path / changed).write_text("O1001\nM99\n")


def test_a_job_is_checked_where_its_machine_or_a_solid_has_changed_or_is_gone(
    tmp_path: Path,
) -> None:
    (tmp_path / "shop").mkdir()
    (tmp_path / "shop" / "own.toml").write_text('base = "below.toml"\n')
    (tmp_path / "shop" / "below.toml").write_text('base = "mill4"\n')
    (tmp_path / "one.nc").write_text("G0 X1\n")
    (tmp_path / "one.toml").write_text(
        'program = "one.nc"\nmachine = "shop/own.toml"\n[nominal]\nfile = "part.stl"\n'
        '[stock]\nshape = "box"\nsize = [9.0, 9.0, 9.0]\n'
        '[[fixtures]]\nname = "jaw"\nfile = "jaw.stl"\n'
    )
    (tmp_path / "two.nc").write_text("G0 X1\n")
    for changed in ("shop/below.toml", "shop/own.toml", "part.stl", "jaw.stl", "one.nc"):
        (tmp_path / changed).unlink(missing_ok=True)
        assert names(tmp_path, dependents([tmp_path / changed], tmp_path)) == ["one.toml"]
    assert dependents([tmp_path / "README.md"], tmp_path / "shop") == []


def test_a_job_that_cannot_be_loaded_is_checked_where_what_loading_looks_at_has_changed(
    tmp_path: Path,
) -> None:
    (tmp_path / "one.nc").write_text("G0 X1\n")
    (tmp_path / "one.toml").write_text('program = "one.nc"\nextends = "base.toml"\n')
    (tmp_path / "base.toml").write_text("wrong = true\n")
    for changed in ("base.toml", "twin.toml"):
        assert names(tmp_path, dependents([tmp_path / changed], tmp_path)) == ["one.toml"]
    (tmp_path / "base.toml").write_text('machine = "none.toml"\n')
    assert names(tmp_path, dependents([tmp_path / "none.toml"], tmp_path)) == ["one.toml"]
    (tmp_path / "base.toml").write_text("wrong =\n")
    assert names(tmp_path, dependents([tmp_path / "base.toml"], tmp_path)) == ["one.toml"]
    assert dependents([tmp_path / "none.toml"], tmp_path) == []
