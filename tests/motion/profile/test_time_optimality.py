"""The planner against TOPP-RA's bound, with the jerk limit out of the way."""

import pytest
from motion_programs import Program, duration
from toppra_bound import bound, fast_machine, slot, wave

pytestmark = pytest.mark.oracle

SLACK = 1.05


@pytest.mark.parametrize(
    "name", ["slot of 20 mm", "slot of 2 mm", "long slot", "wave", "circle", "straight chain"]
)
def test_chain_comes_near_the_bound(name: str) -> None:
    feed = 1e7
    program = {
        "slot of 20 mm": lambda: slot(feed, 10.0, 50.0),
        "slot of 2 mm": lambda: slot(feed, 1.0, 5.0),
        "long slot": lambda: slot(feed, 40.0, 200.0),
        "wave": lambda: wave(feed),
        "circle": lambda: Program().arc((10.0, 0.0, 0.0), (0.0, 0.0, 1.0), 720.0, feed=feed),
        "straight chain": lambda: Program().line(5.0, 1.0, 0.0, 0.0, feed=feed),
    }[name]()
    machine = fast_machine(1e10)
    fastest = bound(program, machine, feed / 60.0)
    taken = duration(program, machine)
    assert fastest * 0.99 <= taken <= fastest * SLACK
