"""Draw one test frame and say so: run as a process of its own, because a bad driver can crash it.

``python -m twin.render.probe egl`` prints one JSON object, with ``renderer`` or ``error``.
"""

import json
import sys

import mujoco
import numpy as np

from twin.render.gl import BACKENDS, open_context

_SCENE = """
<mujoco>
  <visual><headlight ambient="1 1 1" diffuse="0 0 0" specular="0 0 0"/></visual>
  <worldbody>
    <camera name="front" pos="0 -3 0" xyaxes="1 0 0 0 0 1"/>
    <geom type="sphere" size="1" rgba="1 0 0 1"/>
  </worldbody>
</mujoco>
"""
_SIDE = 64


def test_frame(backend: str) -> dict[str, str]:
    """Draw a red ball and look at its middle.

    Returns:
        ``renderer``: what OpenGL calls itself; or ``error``: why there is no picture.
    """
    from OpenGL import GL

    model = mujoco.MjModel.from_xml_string(_SCENE)
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    scene = mujoco.MjvScene(model, 10)
    camera = mujoco.MjvCamera()
    camera.type = mujoco.mjtCamera.mjCAMERA_FIXED
    camera.fixedcamid = 0
    mujoco.mjv_updateScene(
        model, data, mujoco.MjvOption(), None, camera, mujoco.mjtCatBit.mjCAT_ALL, scene
    )
    context = mujoco.MjrContext(model, mujoco.mjtFontScale.mjFONTSCALE_100)
    mujoco.mjr_setBuffer(mujoco.mjtFramebuffer.mjFB_OFFSCREEN, context)
    view = mujoco.MjrRect(0, 0, _SIDE, _SIDE)
    mujoco.mjr_render(view, scene, context)
    pixels = np.zeros((_SIDE, _SIDE, 3), np.uint8)
    mujoco.mjr_readPixels(pixels, None, view, context)
    name = GL.glGetString(GL.GL_RENDERER)
    context.free()
    red, green, blue = (int(value) for value in pixels[_SIDE // 2, _SIDE // 2])
    if red < 100 or max(green, blue) > 50:
        return {"error": f"{backend} draws wrong colours: {red} {green} {blue} for a red ball"}
    return {"renderer": name.decode(errors="replace") if isinstance(name, bytes) else str(name)}


def main() -> None:
    """Probe the backend named on the command line."""
    backend = sys.argv[1]
    assert backend in BACKENDS
    context = open_context(backend, _SIDE, _SIDE)
    sys.stdout.write(json.dumps(test_frame(backend)) + "\n")
    sys.stdout.flush()
    context.free()


if __name__ == "__main__":
    main()
