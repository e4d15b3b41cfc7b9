from pathlib import Path

import mujoco
import numpy as np
import pytest
from PIL import Image

from tests.render.conftest import RAPID_MOVES, STOCK, TOOL
from twin.errors import RenderError
from twin.machine.config import Machine
from twin.recording import Recording
from twin.render.inspection_still import inspection_still


def test_a_slot_left_standing_is_red(
    recording: Recording, spec: mujoco.MjSpec, machine: Machine, tmp_path: Path
) -> None:
    # The joints of the recording stand 4 µm below the setpoints: the slot is too deep.
    pictures = []
    for tolerance in (4.0, 400.0):
        found = inspection_still(
            recording,
            spec=spec,
            machine=machine,
            stock=STOCK,
            tool=TOOL,
            tolerance_um=tolerance,
            out=tmp_path / "part.png",
            camera="top",
            size=(480, 360),
            quality="draft",
            rapid_moves=RAPID_MOVES,
        )
        assert found.as_json()["min_um"] == pytest.approx(-4.0)
        picture = np.asarray(Image.open(tmp_path / "part.png")).astype(int)[120:]
        pictures.append(((picture[..., 2] - picture[..., 0]) > 60).sum())
    assert pictures[0] > pictures[1] + 200, "blue is too deep, and a wide scale hides it"


def test_unknown_camera_is_refused(
    recording: Recording, spec: mujoco.MjSpec, machine: Machine, tmp_path: Path
) -> None:
    with pytest.raises(RenderError, match="has overview, top, part, riding"):
        inspection_still(
            recording,
            spec=spec,
            machine=machine,
            stock=STOCK,
            tool=TOOL,
            tolerance_um=1.0,
            out=tmp_path / "part.png",
            camera="side",
        )
