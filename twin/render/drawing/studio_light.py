"""Light for physically based pictures: a photographer's studio instead of the open sky.

Metal shows what is around it. So a white room with three soft boxes surrounds the machine; without
it, steel reflects the renderer's own landscape and looks blue and brown.
"""

import mujoco
import numpy as np
import numpy.typing as npt

from twin.nc.canonical import FloatArray

ENVIRONMENT = "studio"
SIDE = 128
"""Texels along a side of the environment's cube."""

ENVIRONMENT_INTENSITY = 18_000.0
"""Of white in the room [cd/m²]: its walls fill the shadows to a third of the lit side."""
LAMP_LUX = 70_000.0
"""What a white lamp brings where the machine is [lx]; a model's ``diffuse`` dims it."""

CEILING, HORIZON, FLOOR = 0.6, 0.45, 0.42
"""Brightness of the room overhead, at eye level and below, as shares of white."""
SOFT_BOXES = (
    ((-0.4, -0.78, 0.62), 34.0, 0.6),
    ((0.9, -0.3, 0.5), 24.0, 0.35),
    ((-0.2, 0.9, 0.5), 26.0, 0.3),
)
"""Direction in the world, half its angle [deg], brightness over the room's: key, side and back."""
_BOX_EDGE = (0.6, 1.3)
"""Where a soft box begins and ends to fade, as shares of its angle."""
_GAMMA = 2.2
"""Of the texture's stored colours."""


def light_studio(spec: mujoco.MjSpec) -> None:
    """Give lamps without a photometric intensity one, and put the room around them.

    A model that has an intensity anywhere was lit for such pictures by its maker; it stays as it
    is.
    """
    if any(light.intensity > 0 for light in spec.lights):
        return
    center = np.array(spec.stat.center)
    center = np.where(np.isfinite(center), center, 0.0)
    for light in spec.lights:
        light.intensity = LAMP_LUX
        if light.type != mujoco.mjtLightType.mjLIGHT_DIRECTIONAL:
            # A lamp of so many candelas brings this to where the machine stands.
            light.intensity *= float(np.sum((np.array(light.pos) - center) ** 2))
    cube = spec.add_texture(
        name=ENVIRONMENT,
        type=mujoco.mjtTexture.mjTEXTURE_CUBE,
        width=SIDE,
        height=6 * SIDE,
        nchannel=3,
    )
    cube.data = environment(SIDE).tobytes()
    spec.worldbody.add_light(
        name=ENVIRONMENT,
        type=mujoco.mjtLightType.mjLIGHT_IMAGE,
        texture=ENVIRONMENT,
        intensity=ENVIRONMENT_INTENSITY,
        castshadow=False,
    )


def environment(side: int) -> npt.NDArray[np.uint8]:
    """The room as a cube of six faces below each other, shape (6 side, side, 3)."""
    light = np.clip(brightness(cube_directions(side)), 0.0, 1.0)
    stored = np.round(255 * light ** (1 / _GAMMA)).astype(np.uint8)
    return np.repeat(stored[..., None], 3, axis=-1).reshape(6 * side, side, 3)


def cube_directions(side: int) -> FloatArray:
    """Where the texels of a cube's faces lie in the world, unit vectors, shape (6, side, side, 3).

    The faces +X, -X, +Y, -Y, +Z, -Z are those of an OpenGL cube map, whose Y points up: the
    world's Z, and whose Z points to the viewer: away from the world's Y.
    """
    step = (np.arange(side) + 0.5) / side * 2 - 1
    down, right = np.meshgrid(step, step, indexing="ij")
    one = np.ones_like(down)
    faces = np.array(
        [
            (one, -down, -right),
            (-one, -down, right),
            (right, one, down),
            (right, -one, -down),
            (right, -down, one),
            (-right, -down, -one),
        ]
    )
    world = np.stack([faces[:, 0], -faces[:, 2], faces[:, 1]], -1)
    return world / np.linalg.norm(world, axis=-1, keepdims=True)


def brightness(direction: FloatArray) -> FloatArray:
    """How bright the room is in directions, unit vectors of shape (..., 3); 1 is white."""
    height = direction[..., 2]
    over = HORIZON + (CEILING - HORIZON) * _fade(0.0, 1.0, height)
    under = HORIZON + (FLOOR - HORIZON) * _fade(0.0, 0.6, -height)
    light = np.where(height > 0, over, under)
    for towards, angle, strength in SOFT_BOXES:
        cosine = direction @ (np.array(towards) / np.linalg.norm(towards))
        aside = np.rad2deg(np.arccos(np.clip(cosine, -1.0, 1.0)))
        light = light + strength * (1 - _fade(_BOX_EDGE[0] * angle, _BOX_EDGE[1] * angle, aside))
    return light


def _fade(start: float, end: float, value: FloatArray) -> FloatArray:
    """From 0 at ``start`` to 1 at ``end``, level at both."""
    share = np.clip((value - start) / (end - start), 0.0, 1.0)
    return share * share * (3 - 2 * share)
