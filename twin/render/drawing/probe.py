"""Draw one test frame and say so: run as a process of its own, because a bad driver can end it.

``python -m twin.render.drawing.probe egl`` prints one JSON object, with ``renderer`` or ``error``; so do
``osmesa`` and ``filament``.
"""

import json
import sys

import mujoco
import numpy as np

from twin.render.drawing.canvas import DRAFT, Pixels
from twin.render.drawing.gl import BACKENDS, FILAMENT, open_context

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


def opengl_frame() -> dict[str, str]:
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
    return _judged(pixels, name.decode(errors="replace") if isinstance(name, bytes) else str(name))


def filament_frame() -> dict[str, str]:
    """Draw a red ball with Filament; its reports stay visible, they say why the process ends."""
    from twin.render.drawing.filament_canvas import FilamentCanvas, prepare

    spec = mujoco.MjSpec.from_string(_SCENE)
    prepare(spec, DRAFT, (_SIDE, _SIDE))
    model = spec.compile()
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    try:
        canvas = FilamentCanvas(model, (_SIDE, _SIDE), DRAFT, quiet=False)
    except ImportError as error:
        return {"error": str(error)}
    pixels = canvas.draw(data, 0)
    canvas.close()
    return _judged(pixels, "Vulkan")


def _judged(pixels: Pixels, renderer: str) -> dict[str, str]:
    red, green, blue = (int(value) for value in pixels[_SIDE // 2, _SIDE // 2])
    if red < 2 * max(green, blue, 50):
        return {"error": f"wrong colours are drawn: {red} {green} {blue} for a red ball"}
    return {"renderer": renderer}


def main() -> None:
    """Probe the backend named on the command line."""
    backend = sys.argv[1]
    assert backend in (*BACKENDS, FILAMENT)
    if backend == FILAMENT:
        sys.stdout.write(json.dumps(filament_frame()) + "\n")
        return
    context = open_context(backend, _SIDE, _SIDE)
    sys.stdout.write(json.dumps(opengl_frame()) + "\n")
    sys.stdout.flush()
    context.free()


if __name__ == "__main__":
    main()
