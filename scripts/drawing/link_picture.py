"""What LinuxCNC asked of the twin and what it got: the picture of ``twin/link/README.md``."""

import sys
from pathlib import Path

import matplotlib as mpl
import numpy as np

from twin.columns import join
from twin.recording.reader import open_recording
from twin.units import UM_PER_MM

mpl.use("Agg")
from matplotlib import pyplot as plt

AXES = ("X", "Y", "Z")
INK, QUIET = "#1d2733", "#8a96a3"
COLOURS = ("#0b6bcb", "#c4501b", "#2e8b57")


def main() -> int:
    """Draw a recording of ``twin link``."""
    out, path = Path(sys.argv[1]), Path(sys.argv[2])
    with open_recording(path) as recording:
        samples = join(list(recording.chunks()))
    setpoint, time = samples.setpoint, samples.setpoint.time
    lag = UM_PER_MM * (setpoint.position - samples.joint_position)
    plt.rcParams.update({"font.size": 9, "axes.edgecolor": QUIET, "text.color": INK})
    figure, (upper, lower, line) = plt.subplots(
        3, 1, figsize=(9.0, 5.6), sharex=True, height_ratios=(3, 3, 1), layout="constrained"
    )
    for column, (name, colour) in enumerate(zip(AXES, COLOURS, strict=True)):
        start = setpoint.position[0, column]
        upper.plot(time, setpoint.position[:, column] - start, colour, lw=1.2, label=name)
        lower.plot(time, lag[:, column], colour, lw=1.0, label=name)
    upper.set_title("Commanded by LinuxCNC's planner", loc="left")
    upper.set_ylabel("mm from the start")
    upper.legend(ncols=3, frameon=False, loc="upper right")
    lower.set_title("Following error: what LinuxCNC reads as f-error", loc="left")
    lower.set_ylabel("µm")
    line.step(time, setpoint.line, color=INK, lw=1.0, where="post")
    line.set_ylabel("line")
    line.set_ylim(0, np.max(setpoint.line) + 1)
    line.set_xlabel("time of the program [s]")
    for axes in (upper, lower, line):
        axes.grid(color="#e3e8ed", lw=0.6)
        axes.spines[["top", "right"]].set_visible(False)
    figure.savefig(out, dpi=110)
    return 0


if __name__ == "__main__":
    sys.exit(main())
