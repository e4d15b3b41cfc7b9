"""LinuxCNC's planner on the twin beside the twin's own: cycle time and contour error of programs.

``scripts/link --table [JOB...]`` prints one table; by default of the shipped programs that move little
enough to be run in real time.
"""

import json
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import Any

PROGRAMS = (
    "codesys/arc_in_xz_then_xy",
    "codesys/semicircle_by_radius",
    "codesys/two_turns",
    "fagor8070/bolt_hole_ring",
    "fagor8070/full_circles",
    "fagor8070/omitted_words",
    "fagor8070/rounded_polygon",
    "fagor8070/scroll",
    "fagor8070/three_planes",
)
ROOT = Path(__file__).resolve().parents[2]
COMMANDS = {"own": ("run",), "linuxcnc": ("link", "linuxcnc", "--headless")}
VERDICTS = (0, 1)


def result_of(command: tuple[str, ...], job: Path, out: Path) -> dict[str, Any] | None:
    """The result of a run; None where it did not come to an end, whose reason is printed."""
    ran = subprocess.run(  # noqa: S603 - a command of this project
        [sys.executable, "-m", "twin", *command, str(job), "--out", str(out)],
        capture_output=True, text=True, check=False,
    )  # fmt: skip
    if ran.returncode not in VERDICTS:
        print(f"{job.stem}: {ran.stderr.strip().splitlines()[-1:]}", file=sys.stderr)
        return None
    return json.loads((out / "result.json").read_text(encoding="utf-8"))


def main() -> int:
    """Print the table; 1 where a run did not come to its end."""
    jobs = [Path(name) for name in sys.argv[1:]] or [
        ROOT / "programs" / f"{name}.toml" for name in PROGRAMS
    ]
    print("| program | cycle time [s] | LinuxCNC | contour error [µm] | LinuxCNC |")
    print("|---|---|---|---|---|")
    failed = False
    for job in jobs:
        with tempfile.TemporaryDirectory() as name:
            folder = Path(name)
            folder.chmod(0o755)
            found = {
                who: result_of(command, job, folder / who) for who, command in COMMANDS.items()
            }
        own, other = found["own"], found["linuxcnc"]
        failed = failed or own is None or other is None
        if own is not None and other is not None:
            print(
                f"| `{job.parent.name}/{job.stem}` | {own['duration_s']:.3f} | "
                f"{other['duration_s']:.3f} | {own['contour_um']['max']:.1f} | "
                f"{other['contour_um']['max']:.1f} |",
                flush=True,
            )
    return int(failed)


if __name__ == "__main__":
    sys.exit(main())
