"""A Gymnasium environment: choose the feed override along a program, against error, load and time.

    import gymnasium
    import twin.gym

    env = gymnasium.make("twin/Feed-v0", program="mefi/helix")

Needs the extra ``gym``.
"""

import math
from typing import Any

import numpy as np
import numpy.typing as npt

from twin.api.program import Program
from twin.api.session import Session, Step
from twin.extras import require_extra
from twin.units import SECONDS_PER_MINUTE, UM_PER_MM

require_extra("gym", "twin.gym")
import gymnasium  # noqa: E402 - said by its name where it is missing

LOWEST, HIGHEST = 0.1, 1.5
"""Lowest feed override: at 0 an episode would never end."""
SEEN = ("progress", "override", "speed", "contour", "following", "load")
"""What is seen after each step, each 0 where nothing is to be seen and 1 at its limit, cut off at 10: share of
the program that is done; the override; speed of the tool by the fastest feed of the program; greatest contour
error by the tolerance; greatest following error by that tolerance; greatest force of a drive by its limit."""
MOST_SEEN = 10.0
ERROR_WEIGHT = 1.0
"""Cost of a second at twice the tolerance, in seconds."""
ALARM_COST = 100.0
"""Cost of an alarm of the machine, in seconds."""

Observation = npt.NDArray[np.float32]
Action = npt.NDArray[np.float32]


class FeedEnv(gymnasium.Env[Observation, Action]):
    """Drive a program from its begin to its end by its feed override.

    An action is the override of the next ``period_s``, 0.1 to 1.5, shape (1,). The reward is minus the time
    that has passed [s], and minus ``ERROR_WEIGHT`` times what the contour error exceeds its tolerance by, in
    tolerances, integrated over time. It terminates at the program's end and at an alarm, which costs
    ``ALARM_COST``.
    """

    metadata: dict[str, Any] = {"render_modes": []}  # noqa: RUF012 - as its base declares it

    def __init__(
        self,
        program: Program = "mefi/helix",
        *,
        dialect: str | None = None,
        machine: str | None = None,
        period_s: float = 0.05,
        warm_up_s: float = 0.0,
    ) -> None:
        """Read a program.

        Args:
            program: As ``twin.run`` takes it.
            dialect: One of ``twin dialects``; recognised from the program by default.
            machine: A shipped machine's name, or a machine file; the job's by default.
            period_s: Time between two choices [s].
            warm_up_s: An episode begins up to so much later in the program, drawn by its seed [s].

        Raises:
            TwinError: The program or its job is wrong, or nothing moves.
        """
        self._session = Session(program, dialect=dialect, machine=machine)
        run, dry_run = self._session.run, self._session.run.dry_run
        servo = run.machine.file.servo_period_s
        self._periods = max(1, round(period_s / servo))
        self._warm_up = int(warm_up_s / servo)
        self._servo_s = servo
        self._tolerance_um = run.preparation.job.file.tolerance.contour_um
        axes = [run.machine.axis(name) for name in run.machine.axes.names]
        self._forces = np.array([axis.force_limit or math.inf for axis in axes])
        self._linear = np.array([axis.kind == "linear" for axis in axes])
        feeds = [chunk.moves.feed for chunk in dry_run.program.chunks() if len(chunk.moves)]
        self._fastest = float(np.nanmax(np.concatenate(feeds), initial=1.0)) / SECONDS_PER_MINUTE
        self._moves = max(1, dry_run.moves)
        self.action_space = gymnasium.spaces.Box(LOWEST, HIGHEST, (1,), np.float32)
        self.observation_space = gymnasium.spaces.Box(0.0, MOST_SEEN, (len(SEEN),), np.float32)

    @property
    def session(self) -> Session:
        """The machine at work."""
        return self._session

    def reset(
        self, *, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[Observation, dict[str, Any]]:
        """Begin the program again."""
        super().reset(seed=seed, options=options)
        self._session = Session(self._session.run)
        later = int(self.np_random.integers(0, self._warm_up + 1))
        step = self._session.step(max(1, later))
        return self._seen(step), self._info(step)

    def step(self, action: Action) -> tuple[Observation, float, bool, bool, dict[str, Any]]:
        """Advance by a period at an override."""
        session = self._session
        session.feed_override = float(np.clip(action[0], LOWEST, HIGHEST))
        step = session.step(self._periods)
        beyond = np.maximum(step.contour_um / self._tolerance_um - 1.0, 0.0)
        reward = -self._servo_s * (len(beyond) + ERROR_WEIGHT * float(beyond.sum()))
        if session.alarm is not None:
            reward -= ALARM_COST
        return self._seen(step), reward, session.done, False, self._info(step)

    def _seen(self, step: Step) -> Observation:
        samples = step.samples
        if not len(samples):
            return np.zeros(len(SEEN), np.float32)
        setpoint = samples.setpoint
        done = (max(int(setpoint.move[-1]), 0) + float(setpoint.fraction[-1])) / self._moves
        speed = np.linalg.norm(samples.joint_velocity[:, self._linear], axis=1).max()
        lag = np.abs(setpoint.position - samples.joint_position)[:, self._linear].max() * UM_PER_MM
        load = (np.abs(samples.drive_force) / self._forces).max()
        seen = [
            min(done, 1.0),
            self._session.feed_override,
            speed / self._fastest,
            step.contour_um.max() / self._tolerance_um,
            lag / self._tolerance_um,
            load,
        ]
        return np.clip(np.array(seen), 0.0, MOST_SEEN).astype(np.float32)

    def _info(self, step: Step) -> dict[str, Any]:
        alarm = self._session.alarm
        return {
            "time_s": self._session.time_s,
            "contour_um": float(step.contour_um.max(initial=0.0)),
            "alarm": "" if alarm is None else alarm.code,
        }


gymnasium.register("twin/Feed-v0", entry_point="twin.gym:FeedEnv")
