"""Pictures of a plan: speeds over time and over the path."""

from collections.abc import Iterable
from pathlib import Path

import numpy as np

from twin.motion.setpoints.setpoints import Setpoints
from twin.nc.canonical import Axes, FloatArray
from twin.units import SECONDS_PER_MINUTE

MAX_RUNS = 3000
"""More than a picture has columns. Of a long program, the extremes of so many runs are drawn."""


class SpeedCurves:
    """Path speed and axis speeds, gathered chunk by chunk in bounded memory.

    Args:
        axes: Names and kinds of k axes.
        samples: How many setpoints there will be, at least.
    """

    def __init__(self, axes: Axes, samples: int) -> None:
        self.axes = axes
        self._run = max(1, -(-samples // MAX_RUNS))
        self._time: list[FloatArray] = []
        self._distance: list[FloatArray] = []
        self._values: list[FloatArray] = []
        self._gone = 0.0
        self._last: FloatArray | None = None

    def add(self, setpoints: Setpoints) -> None:
        """Take in consecutive setpoints."""
        position = setpoints.position[:, :3]
        before = position[:1] if self._last is None else self._last
        steps = np.linalg.norm(np.diff(position, axis=0, prepend=before), axis=1)
        distance = self._gone + np.cumsum(steps)
        self._gone, self._last = float(distance[-1]), position[-1:].copy()
        speed = np.linalg.norm(setpoints.velocity[:, :3], axis=1)
        values = np.column_stack([speed, setpoints.velocity]) * SECONDS_PER_MINUTE
        first = np.arange(0, len(setpoints), self._run)
        if self._run == 1:
            self._time.append(setpoints.time)
            self._distance.append(distance)
            self._values.append(values)
            return
        lowest, highest = np.minimum.reduceat(values, first), np.maximum.reduceat(values, first)
        self._time.append(np.repeat(setpoints.time[first], 2))
        self._distance.append(np.repeat(distance[first], 2))
        self._values.append(np.stack([lowest, highest], axis=1).reshape(-1, values.shape[1]))

    def draw(self, path: Path) -> None:
        """Draw path speed and axis speeds over time, and path speed over the path.

        Args:
            path: Picture to write; its suffix says which form (.svg, .png).
        """
        import matplotlib as mpl
        from matplotlib.figure import Figure

        time, distance = np.concatenate(self._time), np.concatenate(self._distance)
        values = np.concatenate(self._values)
        rotary = self.axes.rotary()
        turning = rotary & np.any(values[:, 1:] != 0.0, axis=0)
        groups = [(~rotary, "mm/min")] + ([(turning, "deg/min")] if np.any(turning) else [])
        with mpl.rc_context({"font.size": 9, "svg.hashsalt": "twin"}):
            figure = Figure(figsize=(11.0, 2.4 * (2 + len(groups))), layout="constrained")
            panels = figure.subplots(2 + len(groups), 1)
            panels[0].plot(time, values[:, 0], color="black", linewidth=1.0)
            panels[0].set(xlabel="time [s]", ylabel="path speed [mm/min]", ylim=(0.0, None))
            for panel, (chosen, unit) in zip(panels[1:-1], groups, strict=True):
                for axis in np.flatnonzero(chosen):
                    name = self.axes.names[axis]
                    panel.plot(time, values[:, axis + 1], label=name, linewidth=1.0)
                panel.set(xlabel="time [s]", ylabel=f"axis speed [{unit}]")
                panel.legend(loc="center left", bbox_to_anchor=(1.0, 0.5), frameon=False)
            panels[-1].plot(distance, values[:, 0], color="black", linewidth=1.0)
            panels[-1].set(
                xlabel="path of X Y Z [mm]", ylabel="path speed [mm/min]", ylim=(0.0, None)
            )
            for panel in panels:
                panel.margins(x=0.0)
                panel.grid(alpha=0.3)
            figure.savefig(path, dpi=110)


def draw_plan(chunks: Iterable[Setpoints], axes: Axes, samples: int, path: Path) -> None:
    """Draw the speeds of a plan.

    Args:
        samples: How many setpoints there will be, about.
        path: Picture to write; its suffix says which form (.svg, .png).
    """
    curves = SpeedCurves(axes, samples)
    for chunk in chunks:
        curves.add(chunk)
    curves.draw(path)
