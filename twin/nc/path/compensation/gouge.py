"""Elements of a compensated contour that were passed: a new one must not cross them."""

from twin.compilation.compilable import compilable
from twin.nc.geometry import curves
from twin.nc.geometry.curves import Box, Curve
from twin.nc.path.compensation.contour import (
    BOX,
    CURVE,
    HAS_CONTOUR,
    LINE,
    NECK,
    OLDEST,
    PASSED,
    Contour,
    curve_of,
    set_curve,
)


@compilable
def gouges(contour: Contour, element: Curve, box: Box, own: Curve, has_own: bool) -> bool:
    """Whether an element crosses one that was passed, and the contour does not cross itself there.

    Args:
        contour: Its ``measured`` becomes the line of the element that was passed.
        element: A part of the parallel, or the way around a corner.
        box: Where it lies.
        own: The element of the contour that it belongs to.
        has_own: It belongs to one.
    """
    history, left, low, right, high = contour.gouge_history, box[0], box[1], box[2], box[3]
    oldest, size = int(contour.counts[OLDEST]), len(contour.gouge_history)
    for number in range(int(contour.counts[PASSED])):
        place = (oldest + number) % size
        if history[place, BOX + 2] < left or history[place, BOX] > right:
            continue
        older = history[place]
        if older[BOX + 1] > high or older[BOX + 3] < low:
            continue
        if not curves.crossing_of(curve_of(older[:CURVE]), element)[0]:
            continue
        if not _excused(contour, number, own, has_own):
            contour.measured[0] = older[LINE]
            return True
    return False


@compilable
def _excused(contour: Contour, number: int, own: Curve, has_own: bool) -> bool:
    """The contour crosses itself near an element that was passed."""
    count, size = int(contour.counts[PASSED]), len(contour.gouge_history)
    oldest = int(contour.counts[OLDEST])
    for near in range(max(0, number - 2), min(number + 3, count)):
        older = contour.gouge_history[(oldest + near) % size]
        if older[HAS_CONTOUR] == 0.0:
            continue
        around = curve_of(older[CURVE : 2 * CURVE])
        if has_own and curves.crossing_of(around, own)[0]:
            return True
        for latest in range(max(0, count - 2), count):
            other = contour.gouge_history[(oldest + latest) % size]
            curve = curve_of(other[CURVE : 2 * CURVE])
            if other[HAS_CONTOUR] != 0.0 and curves.crossing_of(around, curve)[0]:
                return True
    return False


@compilable
def pass_by(contour: Contour, element: Curve, box: Box, own: Curve, has_own: bool) -> None:
    """Remember an element that was passed; the arguments are those of ``gouges``."""
    counts, history = contour.counts, contour.gouge_history
    latest = history[(counts[OLDEST] + counts[PASSED]) % len(history)]
    if counts[PASSED] == NECK:
        counts[OLDEST] = (counts[OLDEST] + 1) % len(history)
    else:
        counts[PASSED] += 1
    set_curve(latest[:CURVE], element)
    set_curve(latest[CURVE : 2 * CURVE], own)
    latest[HAS_CONTOUR] = 1.0 if has_own else 0.0
    latest[LINE] = contour.lookahead.codes[2]
    latest[BOX], latest[BOX + 1], latest[BOX + 2], latest[BOX + 3] = box
