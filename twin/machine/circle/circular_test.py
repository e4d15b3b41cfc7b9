"""The circular test of ISO 230-4 on the simulated machine: how round does it go?

A circle is run at a constant feed in both directions; the run-up and a quarter turn settle it, the
turn after that is measured. The machine is cold at first and warms by its drives; its spindle
stands. From the measured points, seen from the commanded centre, come

* radial deviation F: the largest and smallest distance outward from the commanded circle;
* circular deviation G(b): the smallest width of two circles about one centre that hold the paths of
  both directions, here about their common least-squares centre;
* circular hysteresis H: the largest radial difference between the directions at one angle;
* mean radius error: how much the least-squares circle of both differs from the commanded one;
* quadrant peaks: how far the path leaps out where an axis turns round, over both its sides.
"""

import dataclasses

import mujoco
import numpy as np

from twin.errors import UsageError
from twin.machine.circle.circle_path import PLANES, RUN_IN, CirclePath
from twin.machine.description.config import MachineConfig
from twin.machine.model.model import build_spec, physics_model
from twin.machine.simulation.growth import Growth
from twin.machine.simulation.simulate import simulate
from twin.nc.canonical import FloatArray
from twin.units import UM_PER_MM

ANGLES = 3600
"""Points of the evaluated circle."""
_PEAK = 8.0
"""Half the window that a quadrant peak lies in [deg]."""
_AROUND = 16.0
"""Half the window of the surroundings that it is measured against [deg]."""


@dataclasses.dataclass(frozen=True, slots=True)
class CircularTest:
    """Result of a circular test.

    Attributes:
        plane: As in ``PLANES``.
        feed: Commanded [mm/min].
        angle_deg: Shape (n,), from 0 in equal steps.
        counter_clockwise_um: Distance outward from the commanded circle, shape (n,) [µm].
        clockwise_um: That distance of the clockwise circle, shape (n,) [µm].
        circular_deviation_um: G(b).
        radial_deviation_um: F, largest and smallest.
        mean_radius_error_um: Of both directions together.
        quadrant_peaks_um: At 0°, 90°, 180° and 270°, outward positive: of the direction that leaps
            further.
        quadrant_names: Which axis turns round there.
    """

    machine: str
    plane: str
    radius_mm: float
    feed: float
    angle_deg: FloatArray
    counter_clockwise_um: FloatArray
    clockwise_um: FloatArray
    circular_deviation_um: float
    radial_deviation_um: tuple[float, float]
    hysteresis_um: float
    mean_radius_error_um: float
    quadrant_peaks_um: tuple[float, float, float, float]
    quadrant_names: tuple[str, str, str, str]

    def as_contract(self, plot: str | None = None) -> dict[str, object]:
        """The figures as ``twin machine circle --format json`` prints them."""
        largest, smallest = self.radial_deviation_um
        return {
            "machine": self.machine,
            "plane": self.plane,
            "radius_mm": self.radius_mm,
            "feed_mm_per_min": self.feed,
            "circular_deviation_um": self.circular_deviation_um,
            "radial_deviation_um": {"max": largest, "min": smallest},
            "hysteresis_um": self.hysteresis_um,
            "mean_radius_error_um": self.mean_radius_error_um,
            "quadrant_peaks_um": list(self.quadrant_peaks_um),
            "quadrants": list(self.quadrant_names),
            "plot": plot,
        }


def circular_test(
    machine: MachineConfig, radius: float, feed: float, plane: str = "XY"
) -> CircularTest:
    """Run the circular test.

    Args:
        radius: [mm].
        feed: Along the circle [mm/min].
        plane: ``XY``, ``ZX`` or ``YZ``; ``XYC``, ``ZXB``, ``YZA`` follow a point of the turning table.

    Raises:
        UsageError: The machine cannot run that circle, or raised an alarm on it.
        ConfigError: The model is wrong.
    """
    paths = [CirclePath(machine, plane, radius, feed, direction) for direction in (1, -1)]
    model = physics_model(machine, build_spec(machine))
    angle = np.arange(ANGLES, dtype=np.float64) * (360.0 / ANGLES)
    growth = Growth(machine)
    forth, back = (_deviation_um(path, model, growth, angle) for path in paths)
    x, y, mean = _least_squares_circle(angle, (forth + back) / 2)
    turned = np.deg2rad(angle)
    centred = np.stack([forth, back]) - x * np.cos(turned) - y * np.sin(turned)
    both = np.stack([forth, back])
    return CircularTest(
        machine=machine.file.name,
        plane=plane,
        radius_mm=radius,
        feed=feed,
        angle_deg=angle,
        counter_clockwise_um=forth,
        clockwise_um=back,
        circular_deviation_um=float(np.ptp(centred)),
        radial_deviation_um=(float(both.max()), float(both.min())),
        hysteresis_um=float(np.abs(forth - back).max()),
        mean_radius_error_um=float(mean),
        quadrant_peaks_um=_quadrant_peaks(angle, both),
        quadrant_names=_quadrant_names(plane),
    )


def _deviation_um(
    path: CirclePath, model: mujoco.MjModel, growth: Growth, angle: FloatArray
) -> FloatArray:
    """Measured turn of one direction at even angles, shape (n,) [µm]."""
    run = simulate(path.machine, model, path.setpoints())
    # Only the plane's two coordinates are kept: a slow, large circle has millions of samples.
    points = np.concatenate([path.measured(growth.warm(samples)) for samples in run])
    if run.alarm is not None:
        raise UsageError(f"the circle stopped with an alarm: {run.alarm.message}")
    along = path.direction * np.unwrap(np.arctan2(points[:, 1], points[:, 0]))
    begin = along[-1] - 2.0 * np.pi
    if begin < RUN_IN / 2:
        raise UsageError(
            f"the axes followed {np.rad2deg(along[-1] - along[0]):.0f} degrees of the circle and no "
            "more: see kv, dry_friction and force_limit"
        )
    kept = along >= begin - 0.1
    radius = np.hypot(points[kept, 0], points[kept, 1])
    wanted = begin + np.mod(path.direction * np.deg2rad(angle) - begin, 2.0 * np.pi)
    return (np.interp(wanted, along[kept], radius) - path.radius) * UM_PER_MM


def _least_squares_circle(angle: FloatArray, deviation: FloatArray) -> tuple[float, float, float]:
    """Centre and mean radius of deviations from a circle, for deviations far below its radius."""
    turned = np.deg2rad(angle)
    x, y = 2.0 * np.mean(deviation * np.cos(turned)), 2.0 * np.mean(deviation * np.sin(turned))
    return float(x), float(y), float(np.mean(deviation))


def _quadrant_peaks(angle: FloatArray, both: FloatArray) -> tuple[float, float, float, float]:
    """How far each direction leaps out of what lies on either side of a quadrant's border.

    A step across the border, as backlash leaves it, is no peak: outward counts from the higher
    side, inward from the lower.
    """
    peaks = []
    for quadrant in (0.0, 90.0, 180.0, 270.0):
        off = (angle - quadrant + 180.0) % 360.0 - 180.0
        inside = both[:, np.abs(off) <= _PEAK]
        sides = np.stack(
            [
                both[:, (side * off > _PEAK) & (side * off < _AROUND)].mean(axis=1)
                for side in (-1, 1)
            ]
        )
        out = np.maximum(0.0, inside.max(axis=1) - sides.max(axis=0))
        into = np.minimum(0.0, inside.min(axis=1) - sides.min(axis=0))
        leaps = np.concatenate([out, into])
        peaks.append(float(leaps[np.argmax(np.abs(leaps))]))
    return (peaks[0], peaks[1], peaks[2], peaks[3])


def _quadrant_names(plane: str) -> tuple[str, str, str, str]:
    first, second = PLANES[plane]
    return (f"+{first}", f"+{second}", f"-{first}", f"-{second}")
