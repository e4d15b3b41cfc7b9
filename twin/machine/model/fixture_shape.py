"""Fixtures as geoms: what is held against all that moves, and what is seen."""

from pathlib import Path

import mujoco
import numpy as np

from twin.files.stl import read_stl
from twin.job.fixture import FixtureTable
from twin.machine.model.convex_parts import convex_parts
from twin.machine.model.tool_shape import (
    CLAMPED_SIDE,
    COLLISION_GROUP,
    FRAME_SIDE,
    PART_SIDE,
    TOOL_SIDE,
    VISUAL_GROUP,
)
from twin.nc.canonical import FloatArray
from twin.units import MM

_FURTHER = " #"
"""Between the name of a fixture and the number of a further part of it."""


def fixture_of(geom: str) -> str:
    """The fixture that a geom is a part of, by the geom's name; any other geom's own name."""
    return geom.partition(_FURTHER)[0]


def add_fixture(spec: mujoco.MjSpec, top: mujoco.MjsSite, fixture: FixtureTable) -> None:
    """Clamp a fixture to the work-holding surface.

    Args:
        fixture: It; an STL's convex parts are geoms of their own.

    Raises:
        ConfigError: The STL file cannot be read, or its solid is too hollow.
    """
    place = top.pos + np.array(fixture.position) * MM
    if fixture.file is not None:
        for number, corners in enumerate(convex_parts(Path(fixture.file))):
            name = fixture.name if number == 0 else f"{fixture.name}{_FURTHER}{number + 1}"
            spec.add_mesh(name=name, uservert=(corners * MM).ravel().tolist(), inertia=_SHELL)
            _add_geom(top, name, place, COLLISION_GROUP, _MESH, name)
        shown, seen = f"{fixture.name} seen", read_stl(Path(fixture.file))
        spec.add_mesh(
            name=shown,
            uservert=(seen.vertices * MM).ravel().tolist(),
            userface=seen.faces.ravel().tolist(),
            inertia=_SHELL,
        )
        _add_geom(top, shown, place, VISUAL_GROUP, _MESH, shown)
        return
    size, center = (np.array(values) * MM for values in fixture.box)
    kind, half = mujoco.mjtGeom.mjGEOM_BOX, 0.5 * size
    if fixture.diameter is not None:
        kind, half = mujoco.mjtGeom.mjGEOM_CYLINDER, np.array([half[0], half[2], 0.0])
    for name, group in ((fixture.name, COLLISION_GROUP), (f"{fixture.name} seen", VISUAL_GROUP)):
        _add_geom(top, name, place + center, group, kind, half)


_MESH = mujoco.mjtGeom.mjGEOM_MESH
_SHELL = mujoco.mjtMeshInertia.mjMESH_INERTIA_SHELL
"""Fixtures weigh by their tables; of a thin plate's mesh MuJoCo would want a volume."""


def _add_geom(
    top: mujoco.MjsSite, name: str, place: FloatArray, group: int, kind: mujoco.mjtGeom,
    shape: FloatArray | str,
) -> None:  # fmt: skip
    """Add a geom by its measures, or by the name of its mesh."""
    collides = group == COLLISION_GROUP
    top.parent.add_geom(
        name=name,
        type=kind,
        size=[0.0, 0.0, 0.0] if isinstance(shape, str) else shape.tolist(),
        meshname=shape if isinstance(shape, str) else "",
        pos=place.tolist(),
        material="" if collides else "steel",
        group=group,
        contype=PART_SIDE | CLAMPED_SIDE if collides else 0,
        conaffinity=TOOL_SIDE | FRAME_SIDE if collides else 0,
        mass=0.0,
    )
