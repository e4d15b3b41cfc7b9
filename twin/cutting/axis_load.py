"""The cutting force as a load on the axes, computed ahead of the motion along the setpoints."""

import numpy as np

from twin.cutting.cut import Cutter
from twin.cutting.forces.materials import kienzle
from twin.cutting.program_summary import ProgramSummary
from twin.errors import ConfigError
from twin.job.job_file import StockTable
from twin.kinematics import Kinematics
from twin.motion.setpoints.setpoints import Setpoints
from twin.nc.canonical import FloatArray
from twin.recording.reader import Samples
from twin.toolpath.part_frame import PartFrame
from twin.units import DEGREE, MM

_STEP = 1e-3
"""By which an axis is moved to find the direction in which the tip moves [mm or deg]."""


class AxisLoad:
    """Loads of a run, chunk by chunk; call it with the setpoints in order.

    The material is cut along the commanded path: what the axes are off it, micrometres, changes
    the chip by far less than Kienzle's constants are known to.
    """

    def __init__(
        self,
        stock: StockTable,
        summary: ProgramSummary,
        part_frame: PartFrame,
        part_zero: FloatArray,
    ) -> None:
        """Lay another blank on the table, to be cut ahead.

        Args:
            stock: The blank; its material must be named.
            summary: What is in the spindle when, at which speed, and which moves are rapids.
            part_zero: Machine coordinates of program zero, shape (k,) [mm or deg].

        Raises:
            ConfigError: The stock's material or any spindle speed is missing, so that no force can
                be computed.
        """
        if kienzle(stock) is None:
            raise ConfigError(
                "cutting_load needs stock.material, or specific_force and exponent, for the cutting force"
            )
        if all(tool.speed is None for tool in summary.tools.tools):
            raise ConfigError(
                "cutting_load needs a spindle speed: S in the program, or speed of a [[tools]] table"
            )
        self._cutter = Cutter(
            stock,
            summary.tools,
            part_frame,
            part_zero,
            along="setpoints",
            tilts=summary.tilts,
        )
        self._summary = summary
        self._part_frame = part_frame

    def __call__(self, setpoint: Setpoints) -> FloatArray:
        """Load on every axis during the period that ends with each setpoint.

        Args:
            setpoint: n setpoints that follow the last ones.

        Returns:
            Shape (n, k) [N or N m], positive where it pushes an axis towards greater values.
        """
        still = np.zeros_like(setpoint.position)
        samples = Samples(setpoint, setpoint.position, setpoint.velocity, still)
        self._cutter.add(samples, self._summary.is_rapid(setpoint.move))
        force = self._cutter.force
        frame, load = self._part_frame, still
        if frame.chain is not None:
            return self._along_chain(frame.chain, setpoint, force)
        load[:, :3] = force
        if frame.rotary is not None:
            place = frame.position(setpoint.position)
            turned = np.deg2rad(setpoint.position[:, frame.rotary] - frame.turn_zero)
            cosine, sine = np.cos(turned), np.sin(turned)
            load[:, 0] = cosine * force[:, 0] + sine * force[:, 1]
            load[:, 1] = cosine * force[:, 1] - sine * force[:, 0]
            load[:, frame.rotary] = MM * (place[:, 0] * force[:, 1] - place[:, 1] * force[:, 0])
        return load

    def _along_chain(self, chain: Kinematics, setpoint: Setpoints, force: FloatArray) -> FloatArray:
        """Loads on the joints of any machine: virtual work, the force times the path of the tip by each axis, shape (n, k)."""
        frame, place = self._part_frame, setpoint.position
        lower = self._summary.tools.lower(setpoint.move)
        load = np.zeros_like(place)
        for column, rotary in zip(chain.column, chain.rotary, strict=True):
            step = np.zeros(place.shape[1])
            step[column] = _STEP
            displacement = frame.position(place + step, lower) - frame.position(place - step, lower)
            per_unit = MM / DEGREE if rotary else 1.0
            load[:, column] = per_unit * (displacement * force).sum(axis=1) / (2.0 * _STEP)
        return load
