"""The first press of any key finds its kernels loaded."""

import subprocess
import sys

import pytest

from tests.loaded_kernels import loaded
from twin.training.scene.scene_file import read_scene, scene_path
from twin.training.server.attempts import Attempts
from twin.training.server.launch import warm_up
from twin.training.session.session import SceneSession

PRESSED = (
    ({"do": "cycle_start"}, 400), ({"do": "feed_hold"}, 50), ({"do": "cycle_start"}, 30), ({"do": "emergency_stop"}, 50),
    ({"do": "emergency_stop", "pressed": False}, 1), ({"do": "reset"}, 50), ({"do": "mode", "mode": "jog"}, 1),
    ({"do": "jog", "axis": "Z", "direction": 1, "step": 10.0}, 200), ({"do": "jog", "axis": "X", "direction": 1}, 30),
    ({"do": "jog_stop"}, 100), ({"do": "mode", "mode": "auto"}, 1), ({"do": "search", "line": 5}, 1),
    ({"do": "cycle_start"}, 400), ({"do": "cycle_start"}, 200), ({"do": "rewind", "seconds": 3.0}, 1), ({"do": "go_on"}, 100),
)  # fmt: skip
"""Commands, and slices of time behind each."""


def main() -> int:
    """Press the keys; how many of them were refused or loaded a kernel."""
    scene = Attempts.prepared(read_scene(scene_path("fagor_first_steps")))
    warm_up(scene)
    session, late = SceneSession(scene), 0
    for command, slices in PRESSED:
        before = loaded()
        who = "trainer" if command["do"] in ("rewind", "go_on") else "operator"
        done = session.submit(command, who)
        session.advance(slices)
        new = loaded() - before
        late += bool(new) or not done
        if new or not done:
            print(command, session.refusal, sorted(new))
    return late


@pytest.mark.thorough
def test_no_key_waits_for_a_kernel_behind_the_warming_up():
    done = subprocess.run([sys.executable, __file__], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout + done.stderr[-2000:]


if __name__ == "__main__":
    sys.exit(main())
