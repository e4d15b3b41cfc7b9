from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from tests.render.conftest import STOCK, SUMMARY
from twin.cutting.recut import COMMANDED, inspect_recorded
from twin.errors import RenderError
from twin.recording.form import STEPS
from twin.render.inspection_still import inspection_still
from twin.render.scene.scene import RenderScene


def test_a_slot_cut_too_deep_is_blue(scene: RenderScene, tmp_path: Path) -> None:
    # The joints of the recording stand 4 µm below the setpoints.
    pictures = []
    for tolerance in (4.0, 400.0):
        part = inspect_recorded(scene.recording, SUMMARY, STOCK, COMMANDED, tolerance)
        inspection_still(
            scene,
            part,
            out=tmp_path / "part.png",
            camera="top",
            size=(480, 360),
            quality="draft",
        )
        step_um = 1e3 * STEPS["joint/position"]
        assert part.found.as_json()["min_um"] == pytest.approx(-4.0, abs=step_um)
        picture = np.asarray(Image.open(tmp_path / "part.png")).astype(int)[120:]
        pictures.append(((picture[..., 2] - picture[..., 0]) > 60).sum())
    assert pictures[0] > pictures[1] + 200, "blue is too deep, and a wide scale hides it"


def test_unknown_camera_is_refused(scene: RenderScene, tmp_path: Path) -> None:
    part = inspect_recorded(scene.recording, SUMMARY, STOCK, COMMANDED, 1.0)
    with pytest.raises(RenderError, match="has overview, top, part, riding"):
        inspection_still(scene, part, out=tmp_path / "part.png", camera="side")
