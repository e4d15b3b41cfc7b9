"""How PLANE names a tilted plane: by angles, vectors, points, or axes of the machine.

Source: user's manuals Klartext of the TNC 640 ("Tilting the working plane"). Spatial angles turn about the fixed X, then
Y, then Z.
"""

from collections.abc import Callable, Mapping
from typing import NamedTuple

from twin.nc.control.control import Control
from twin.nc.dialects.heidenhain.memory import memory_of
from twin.nc.geometry.arcs import direction
from twin.nc.geometry.matrices import IDENTITY, Matrix, product
from twin.nc.geometry.planes import Vector, cross
from twin.nc.iso.orientation.tilted_plane import about, directions_of, plane_of_axes
from twin.nc.text.blocks import Statement

_STEEPEST = 89.9999
"""Of a projection angle (manual) [deg]."""


class PlaneWords(NamedTuple):
    """What a PLANE says: values by word, and words without values."""

    values: Mapping[str, float]
    flags: frozenset[str]

    def vector(self, *names: str) -> Vector:
        """Three values, 0 where they are left out."""
        x, y, z = (self.values.get(name, 0.0) for name in names)
        return (x, y, z)

    @property
    def sense(self) -> float:
        """The sign of the master axis that SEQ or SYM asks for; 0: either."""
        signs = {flag[-1] for flag in self.flags if flag[:3] in ("SEQ", "SYM")}
        return 1.0 if "+" in signs else -1.0 if "-" in signs else 0.0


def spatial(a: float, b: float, c: float) -> Matrix:
    """The turn of spatial angles [deg]."""
    return product(about(2, c), product(about(1, b), about(0, a)))


def _by_spatial(_control: Control, _statement: Statement, words: PlaneWords) -> Matrix:
    return spatial(*words.vector("SPA", "SPB", "SPC"))


def _by_euler(_control: Control, _statement: Statement, words: PlaneWords) -> Matrix:
    first, second, third = words.vector("EULPR", "EULNU", "EULROT")
    return product(about(2, first), product(about(0, second), about(2, third)))


def _by_projection(control: Control, statement: Statement, words: PlaneWords) -> Matrix:
    """By the angles of the plane's traces in Z/X and in Y/Z.

    Decision: they count as SPB and SPA do, X of the plane lies in Z/X, and ROT turns it about the tool; the manual shows
    the signs in a figure alone.
    """
    first, second, turn = words.vector("PROPR", "PROMIN", "ROT")
    if max(abs(first), abs(second)) > _STEEPEST:
        message = f"projection angles lie between -{_STEEPEST} and {_STEEPEST}"
        control.fail("tilted-plane", message, statement)
    (cosine, sine), (level, rise) = direction(first), direction(second)
    plane = _directions(control, statement, (cosine, 0.0, -sine), (0.0, level, rise))
    return product(plane, about(2, turn))


def _by_vectors(control: Control, statement: Statement, words: PlaneWords) -> Matrix:
    """By the normal, and a vector that X goes along as far as the normal lets it."""
    normal, base = words.vector("NX", "NY", "NZ"), words.vector("BX", "BY", "BZ")
    ordinate = cross(normal, base)
    return _directions(control, statement, cross(ordinate, normal), ordinate)


def _by_points(control: Control, statement: Statement, words: PlaneWords) -> Matrix:
    """By three points of it: X leads from the first to the second, and Y to the side of the third."""
    (a, b, c), *others = (
        words.vector(*(f"P{number}{axis}" for axis in "XYZ")) for number in (1, 2, 3)
    )
    along, aside = ((x - a, y - b, z - c) for x, y, z in others)
    return _directions(control, statement, along, aside)


def _directions(
    control: Control, statement: Statement, abscissa: Vector, ordinate: Vector
) -> Matrix:
    """As ``directions_of``."""
    try:
        return directions_of(abscissa, ordinate)
    except ValueError as error:
        control.fail("tilted-plane", f"PLANE: {error}", statement)


def _by_axes(control: Control, statement: Statement, words: PlaneWords) -> Matrix:
    names = control.settings.axes.names
    given = {name: words.values[name] for name in "ABC" if name in words.values}
    lacking = [name for name in given if name not in names]
    if control.settings.setup is None or lacking:
        message = f"the machine has no axis {lacking[0] if lacking else 'that turns'}"
        control.fail("tilted-plane", message, statement)
    return plane_of_axes(control, {names.index(name): value for name, value in given.items()})


def _by_increment(control: Control, statement: Statement, words: PlaneWords) -> Matrix:
    given = [
        (axis, words.values[name])
        for axis, name in enumerate(("SPA", "SPB", "SPC"))
        if name in words.values
    ]
    if len(given) != 1:
        control.fail("tilted-plane", "PLANE RELATIV needs one of SPA, SPB and SPC", statement)
    return product(memory_of(control).tilt or IDENTITY, about(*given[0]))


MATRICES: Mapping[str, Callable[[Control, Statement, PlaneWords], Matrix]] = {
    "SPATIAL": _by_spatial,
    "PROJECTED": _by_projection,
    "EULER": _by_euler,
    "VECTOR": _by_vectors,
    "POINTS": _by_points,
    "RELATIV": _by_increment,
    "RELATIVE": _by_increment,
    "AXIAL": _by_axes,
}
"""What makes the directions of the tilted axes, as columns, by the kind of PLANE."""
