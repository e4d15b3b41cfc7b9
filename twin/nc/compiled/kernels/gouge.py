"""Elements of a compensated contour that were passed, compiled: a new one must not cross them."""

from twin.compilation.compilable import compilable
from twin.nc.compiled.kernels.lookahead import curve_of, set_curve
from twin.nc.geometry import curves
from twin.nc.geometry.curves import Box, Curve
from twin.nc.path.contour_registers import BOX, CURVE, HAS_CONTOUR, LINE, OLDEST, PASSED, Contour


@compilable
def gouges(contour: Contour, element: Curve, box: Box, own: Curve) -> bool:
    """Whether an element crosses one that was passed, and the contour does not cross itself there.

    Args:
        contour: Compensation.
        element: A part of the parallel.
        box: Where it lies.
        own: The element of the contour that it belongs to.
    """
    for number in range(contour.counts[PASSED]):
        if _crosses(contour, number, element, box) and not _excused(contour, number, own):
            return True
    return False


@compilable
def crosses_passed(contour: Contour, element: Curve, box: Box, first: int) -> bool:
    """Whether an element crosses one that was passed, from the ``first`` on."""
    for number in range(first, contour.counts[PASSED]):
        if _crosses(contour, number, element, box):
            return True
    return False


@compilable
def _place(contour: Contour, number: int) -> int:
    """The row of an element that was passed, counted from the oldest."""
    return (contour.counts[OLDEST] + number) % len(contour.gouge_history)


@compilable
def _crosses(contour: Contour, number: int, element: Curve, box: Box) -> bool:
    older = contour.gouge_history[_place(contour, number)]
    if older[BOX] > box[2] or older[BOX + 2] < box[0]:
        return False
    if older[BOX + 1] > box[3] or older[BOX + 3] < box[1]:
        return False
    return curves.crossing_of(curve_of(older[:CURVE]), element)[0]


@compilable
def _excused(contour: Contour, number: int, own: Curve) -> bool:
    """The contour crosses itself near an element that was passed."""
    count = contour.counts[PASSED]
    for near in range(max(0, number - 2), min(number + 3, count)):
        older = contour.gouge_history[_place(contour, near)]
        if older[HAS_CONTOUR] == 0.0:
            continue
        around = curve_of(older[CURVE : 2 * CURVE])
        if curves.crossing_of(around, own)[0]:
            return True
        for latest in range(max(0, count - 2), count):
            other = contour.gouge_history[_place(contour, latest)]
            curve = curve_of(other[CURVE : 2 * CURVE])
            if other[HAS_CONTOUR] != 0.0 and curves.crossing_of(around, curve)[0]:
                return True
    return False


@compilable
def pass_by(contour: Contour, element: Curve, box: Box, held: Curve, has_contour: bool) -> None:
    """Remember an element that was passed."""
    counts, passed = contour.counts, contour.gouge_history
    if counts[PASSED] == len(passed):
        counts[OLDEST] = (counts[OLDEST] + 1) % len(passed)
        counts[PASSED] -= 1
    latest = passed[_place(contour, counts[PASSED])]
    counts[PASSED] += 1
    set_curve(latest[:CURVE], element)
    set_curve(latest[CURVE : 2 * CURVE], held)
    latest[HAS_CONTOUR] = 1.0 if has_contour else 0.0
    latest[LINE] = contour.lookahead.codes[2]
    latest[BOX], latest[BOX + 1], latest[BOX + 2], latest[BOX + 3] = box
