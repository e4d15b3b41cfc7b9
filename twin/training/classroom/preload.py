"""Loads and warms up what every room needs, once.

Rooms that are forked from a process which has imported this begin at once, and share its memory.
"""

import gc

from twin.training.classroom import room_process as _room_process
from twin.training.scene.scene_file import read_scene, scene_names, scene_path
from twin.training.server.attempts import Attempts
from twin.training.server.launch import warm_up

assert _room_process.run_room
warm_up(Attempts.prepared(read_scene(scene_path(scene_names()[0]))))
gc.collect()
gc.freeze()
