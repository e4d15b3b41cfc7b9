"""Rooms as a program opens them, without a browser."""

import gc
import threading

import pytest

from twin.training.scene.scene_file import read_scene, scene_path
from twin.training.server.launch import OpenRoom, open_room

PATIENCE_S = 30.0


# Studio leaves the sockets of its own server to the collector.
@pytest.mark.filterwarnings("ignore::pytest.PytestUnraisableExceptionWarning")
def test_a_room_can_be_opened_after_another():
    scene = read_scene(scene_path("fagor_first_steps"))
    before = set(threading.enumerate())
    rooms: list[OpenRoom] = []  # Kept: what is still known must not be in the next one's way.
    for _ in range(2):
        with open_room(scene, plain=True) as room:
            rooms.append(room)
            serving = threading.Thread(target=room.serve)
            serving.start()
            room.stop()
            serving.join(timeout=PATIENCE_S)
            assert not serving.is_alive()
    for left in set(threading.enumerate()) - before:
        left.join(timeout=PATIENCE_S)
        assert not left.is_alive(), left
    gc.collect()
