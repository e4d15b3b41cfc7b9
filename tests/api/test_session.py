"""A session moves as a run does, takes commands, and can be copied."""

import numpy as np
import pytest

import twin
from twin.api.session import Session

JOB = twin.Job(program="G90 G1 X10. Y4. F1200.\nG2 X20. I5. J0.\nG1 X0. Y0.\nM30", dialect="haas")


def samples_of(session: Session, periods: int) -> list[np.ndarray]:
    parts = []
    while not session.done:
        parts.append(session.step(periods).samples.joint_position)
    return parts


def test_untouched_it_is_the_run():
    result, session = twin.run(JOB), Session(JOB, largest_override=1.0)
    joints = np.concatenate(samples_of(session, 37))
    recorded = result["joint/position"]
    # A run settles behind its end; a recording is kept to some nanometres.
    assert len(joints) <= len(recorded)
    assert np.abs(joints - recorded[: len(joints)]).max() < 1e-6
    assert session.figures.contour.max == pytest.approx(result.outcome.figures.contour.max)
    assert session.time_s == pytest.approx(result.outcome.duration_s, abs=2e-3)
    assert len(session.step(5).samples) == 0


def test_half_the_feed_takes_longer_and_a_hold_stands():
    session, free = Session(JOB), Session(JOB)
    session.feed_override = 0.5
    session.step(600)
    session.hold()
    session.step(400)
    held = session.step(100).samples.setpoint
    assert not held.velocity.any()
    session.start()
    assert sum(map(len, samples_of(session, 50))) + 1100 > sum(map(len, samples_of(free, 50))) + 500
    assert [command.name for command in session.commands] == ["feed_override", "hold", "start"]


def test_a_copy_goes_on_by_itself_to_the_bit():
    session = Session(JOB)
    session.step(100)
    session.feed_override = 0.7
    session.step(150)
    copy = session.copy()
    copied = copy.step(200).samples.joint_position
    copy.hold()
    copy.step(100)
    assert np.array_equal(copied, session.step(200).samples.joint_position)
    assert session.ticks == 450
    assert not session.done


def test_what_would_leave_the_travel_is_an_alarm_before_it_moves():
    session = Session("G90 G1 X9000. F600.\nM30", dialect="haas")
    assert session.done
    assert session.alarm is not None
    assert session.alarm.code == "soft-limit"
    assert len(session.step(10).samples) == 0


@pytest.mark.parametrize(("name", "value"), [("feed_override", 1.6), ("rapid_override", -0.1)])
def test_overrides_beyond_their_ends_are_refused(name: str, value: float):
    session = Session(JOB)
    with pytest.raises(ValueError, match="override"):
        setattr(session, name, value)
    assert session.commands == []
    with pytest.raises(ValueError, match="at least 1"):
        session.step(0)
