import subprocess
import sys
from pathlib import Path

from tests.check.test_check_runs import write_job

ROOT = Path(__file__).parents[2]


def pytest_in(folder: Path, *arguments: str) -> tuple[int, str]:
    done = subprocess.run(
        [
            sys.executable, "-m", "pytest", "-p", "twin.pytest_plugin", "-p", "no:cacheprovider",
            "-c", "/dev/null", "--rootdir", str(folder), str(folder), *arguments,
        ],
        capture_output=True, text=True, check=False, cwd=folder,
        # Named by -p, for an installed package's entry point would register the module again.
        env={"PYTHONPATH": str(ROOT), "PYTEST_DISABLE_PLUGIN_AUTOLOAD": "1"},
    )  # fmt: skip
    return done.returncode, done.stdout


def test_jobs_are_tests_with_their_diagnostics_as_failures(tmp_path: Path):
    write_job(tmp_path, "good")
    write_job(tmp_path, "tight", tolerance=0.001)
    write_job(tmp_path, "wrong", "N10 X1 QQ5")
    (tmp_path / "machine.toml").write_text('name = "no job"')
    (tmp_path / "broken.toml").write_text("program =")
    code, shown = pytest_in(tmp_path)
    assert code == 1
    assert "1 passed" in shown
    assert "2 failed" in shown
    assert "exceeds contour_um = 0.001" in shown
    assert "Traceback" not in shown
    code, shown = pytest_in(tmp_path, "-k", "good", "--twin-baseline", "none")
    assert code == 1
    assert "--update-baseline stores one" in shown
