"""Reads off a recording what the display shows."""

from collections.abc import Callable
from pathlib import Path

import numpy as np

from twin.cutting.forces.tool_strength import tool_strength
from twin.job.job_file import ToolTable
from twin.recording.form import ToolLoad
from twin.recording.reader import Samples
from twin.render.hud import Display, HudValues, LoadBar
from twin.render.scene.scene import RenderScene
from twin.units import SECONDS_PER_MINUTE, UM_PER_MM

_INSTANT_S = 1e-6
"""Time for which axes are taken to keep their speed [s]."""


class Gauge:
    """Follows a scene's recording, sample by sample."""

    def __init__(self, scene: RenderScene) -> None:
        self._scene = scene
        self._alarms = sorted(scene.recording.alarms)
        self._last: Samples | None = None
        self._count = 0

    def display(self, size: tuple[int, int], speed: float | None) -> Display:
        """A display for this run; a film has a speed, a still has none."""
        header = self._scene.recording.header
        compared = self._scene.recording.contour_um(0, 0) is not None
        return Display(
            title=f"{Path(header.program).name} · {header.machine}",
            source=self._scene.source,
            axes=header.axes,
            size=size,
            speed=speed,
            error_name="contour" if compared else "lag",
            error_scale_um=self._scene.error_scale if compared else None,
        )

    def add(self, samples: Samples) -> None:
        """Go on by samples that follow the last ones."""
        if len(samples):
            self._last = samples[-1:]
            self._count += len(samples)

    def reading(self, warning: Callable[[int], str]) -> HudValues:
        """What there is to read after the last sample.

        Args:
            warning: What to warn of while a program line runs, where there is no alarm.
        """
        assert self._last is not None
        header, last = self._scene.recording.header, self._last
        setpoint = last.setpoint
        line, move, time = int(setpoint.line[0]), int(setpoint.move[0]), float(setpoint.time[0])
        summary = self._scene.summary
        tool = summary.tools.at(move)
        velocity = SECONDS_PER_MINUTE * last.joint_velocity[0]
        turning = float(np.linalg.norm(velocity[header.axes.rotary()]))
        only_turns = float(np.linalg.norm(velocity[:3])) < 1.0 < turning
        feed = SECONDS_PER_MINUTE * self._tip_speed(summary.tools.length_difference(tool))
        raised = [text for since, text in self._alarms if since <= time]
        return HudValues(
            line=line,
            position=summary.shown(move, last.joint_position[0] - header.part_zero),
            feed=turning if only_turns else feed,
            feed_unit="°/min" if only_turns else "mm/min",
            spindle=summary.spindle.at(move),
            tool=tool.number,
            error_um=self._error(),
            time_s=time,
            loads=() if last.tool is None else load_bars(last.tool, tool),
            alarm=raised[-1] if raised else warning(line),
        )

    def _tip_speed(self, length_difference: float) -> float:
        """How fast the tip of a tool, so much longer than the first [mm], goes over the part [mm/s].

        It is the feed that the part feels, whatever a control's F counts where rotary axes turn together with X, Y and Z; where
        they turn alone every control counts degrees.
        """
        assert self._last is not None
        here, displacement = self._last.joint_position, _INSTANT_S * self._last.joint_velocity
        tips = self._scene.recording.header.part_frame.position(
            np.concatenate([here - displacement, here + displacement]), length_difference
        )
        return float(np.linalg.norm(tips[1] - tips[0])) / (2.0 * _INSTANT_S)

    def _error(self) -> float:
        """Contour error now, or the lag where nobody compared [µm]."""
        assert self._last is not None
        contour = self._scene.recording.contour_um(self._count - 1, self._count)
        if contour is not None:
            return float(contour[0])
        position = self._scene.recording.header.part_frame.position
        away = position(self._last.joint_position)[0] - position(self._last.setpoint.position)[0]
        return UM_PER_MM * float(np.linalg.norm(away))


def load_bars(load: ToolLoad, tool: ToolTable) -> tuple[LoadBar, ...]:
    """What the cut asks for at a sample, as shares of what breaks the tool or overloads the spindle."""
    bears = tool_strength(tool)
    force, chip = float(load.peak_force[0]), float(load.chip[0])
    torque, bend = float(load.spindle_load[0]), float(np.linalg.norm(load.deflection[0]))
    return (
        LoadBar("force", f"{force:.0f} N", force / bears.force),
        LoadBar("spindle", f"{100.0 * torque:.0f} %", torque),
        LoadBar("bending", f"{UM_PER_MM * bend:.0f} µm", bend / (bears.compliance * bears.force)),
        LoadBar("chip", f"{chip:.3f} mm", chip / bears.chip),
    )
