import subprocess
import sys
from pathlib import Path
from xml.etree import ElementTree as ET

import pytest

from tests.check.test_check_runs import PROGRAM, write_job

ROOT = Path(__file__).parents[2]


def pytest_in(path: Path, *arguments: str) -> tuple[int, str]:
    root = path if path.is_dir() else path.parent
    done = subprocess.run(
        [
            sys.executable, "-m", "pytest", "-p", "mill_twin_pytest", "-p", "no:cacheprovider",
            "-c", "/dev/null", "--rootdir", str(root), str(path), *arguments,
        ],
        capture_output=True, text=True, check=False, cwd=root,
        # Named by -p, for an installed package's entry point would register the module again.
        env={"PYTHONPATH": str(ROOT), "PYTEST_DISABLE_PLUGIN_AUTOLOAD": "1"},
    )  # fmt: skip
    return done.returncode, done.stdout


@pytest.mark.seconds("a process of pytest runs jobs")
def test_jobs_are_tests_with_their_diagnostics_as_failures(tmp_path: Path):
    write_job(tmp_path, "good")
    write_job(tmp_path, "tight", tolerance=0.001)
    write_job(tmp_path, "wrong", "N10 X1 QQ5")
    write_job(tmp_path, "torn").write_text("program =", encoding="utf-8")
    (tmp_path / "machine.toml").write_text('name = "no job"', encoding="utf-8")
    (tmp_path / "broken.toml").write_text("program =", encoding="utf-8")
    code, shown = pytest_in(tmp_path, f"--junitxml={tmp_path / 'junit.xml'}")
    assert code == 1
    assert "1 passed" in shown
    assert "3 failed" in shown
    assert "exceeds contour_um = 0.001" in shown
    assert "torn.toml: is not TOML" in shown
    assert "^" in shown
    assert "Traceback" not in shown
    properties = {
        one.get("name"): one.get("value")
        for one in ET.parse(tmp_path / "junit.xml").iter("property")  # noqa: S314 (made here)
    }
    assert properties["worst_line"] in {"2", "3", "4"}
    assert float(properties["contour_um"] or 0) > 0.0


@pytest.mark.processes
def test_tests_are_chosen_spread_and_held_to_baselines(tmp_path: Path):
    write_job(tmp_path, "good")
    write_job(tmp_path, "wrong", "N10 X1 QQ5")
    arguments = ("-k", "good", "-m", "twin", "--twin-baseline", "stored")
    code, shown = pytest_in(tmp_path, *arguments)
    assert code == 1
    assert "--update-baseline stores one" in shown
    # Two processes, as a build server would.
    spread = ("-p", "xdist", "-n", "2")
    code, shown = pytest_in(tmp_path, *arguments, *spread, "--twin-update-baseline")
    assert code == 0, shown
    assert (tmp_path / "stored" / "good.baseline").is_file()
    write_job(tmp_path, "good", PROGRAM.replace("Y-4.25", "Y-4.27"))
    code, shown = pytest_in(tmp_path, *arguments)
    assert code == 1
    assert "good.nc:4:1: error baseline-path: ends at Y-4.27, baseline Y-4.25" in shown


@pytest.mark.processes
def test_an_nc_program_that_is_named_is_a_test_too(tmp_path: Path):
    write_job(tmp_path, "good")
    plain = tmp_path / "plain.nc"
    plain.write_text(PROGRAM.replace("F3000", ""), encoding="utf-8")
    mefi = ("--twin-dialect", "mefi")
    code, shown = pytest_in(plain, *mefi)
    assert (code, "1 passed" in shown) == (0, True)
    code, shown = pytest_in(plain, *mefi, "--twin-strict")
    assert code == 1
    assert "error no-feed" in shown
    code, shown = pytest_in(tmp_path / "good.nc")
    assert (code, "1 passed" in shown) == (0, True)


def test_storing_baselines_needs_a_folder(tmp_path: Path):
    code, _ = pytest_in(tmp_path, "--twin-update-baseline")
    assert code == 4


@pytest.mark.seconds("a process of pytest runs jobs")
def test_a_project_may_have_a_package_of_the_same_name(tmp_path: Path):
    (tmp_path / "twin").mkdir()
    (tmp_path / "twin" / "__init__.py").write_text("WHOSE = 'theirs'\n")
    (tmp_path / "test_theirs.py").write_text(
        "import twin\n\ndef test_theirs():\n    assert twin.WHOSE == 'theirs'\n"
    )
    (tmp_path / "conftest.py").touch()
    write_job(tmp_path, "good")
    write_job(tmp_path, "tight", tolerance=0.001)
    code, shown = pytest_in(tmp_path)
    assert code == 1
    assert "2 passed" in shown
    assert "exceeds contour_um = 0.001" in shown


def test_the_plugin_does_not_import_the_package():
    code = "import sys, mill_twin_pytest; sys.exit('twin' in sys.modules)"
    subprocess.run([sys.executable, "-c", code], check=True, cwd=ROOT)
    from mill_twin_pytest import NC_SUFFIXES
    from twin.check import discovery

    assert NC_SUFFIXES == discovery.NC_SUFFIXES
