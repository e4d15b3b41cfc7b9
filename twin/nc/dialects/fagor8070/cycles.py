"""Canned cycles of the Fagor CNC 8070.

Z names the reference plane, I the depth: absolute with G90, from the reference plane with G91; D is
the distance from the reference plane to the surface of the part. Every block that names a point of
the plane runs the cycle there, until G80 or another motion code; with G98 the tool goes back to the
height at which the cycle was called, with G99 to the reference plane.

Decisions, since the manuals are only partly known: K is a dwell at the bottom [s]. In G83, I is the
depth of one peck and J their number. In G82, B is the first peck, R the factor of each next one, L
the least; after each the tool lifts by H, after every J of them (or where H is missing) to the
reference plane, and returns with rapid to C, 1 mm, above where it was.
"""

from collections.abc import Callable

from twin.nc.control import Control
from twin.nc.dialect import GCode, Ground
from twin.nc.dialects.fagor8070.pockets import mill_pocket
from twin.nc.dialects.fagor8070.polar import take_goal
from twin.nc.drilling import CHIP_CLEARANCE, Drilling, Retract, drill, pecks
from twin.nc.interpolation import Interpolation, PlainHole

_CLEARANCE = 1.0
"""G82: C where it is missing [mm]."""


def _cycle(
    number: int,
    meaning: str,
    words: str,
    interpolation: Callable[[str], Interpolation],
    *,
    lengths: str = "",
    ground: Ground = "decision",
) -> GCode:
    """A cycle by its words besides Z and I; ``lengths`` are those of them that count lengths."""

    def start(control: Control) -> None:
        height = control.programmed[control.modal.plane.axes[2]]
        control.cycle_values = {"start": height}
        _refuse_corner_type(control, words)
        for address in words:
            if (word := control.take(address)) is not None:
                in_mm = address in lengths
                value = control.length(word) if in_mm else control.number(word)
                control.cycle_values[address] = value
        _read_height(control)

    return GCode(
        meaning=f"{meaning}: Z I {' '.join(words)}".rstrip(),
        group="cycle",
        sets={"cycle": interpolation(f"G{number}")},
        action=start,
        ground=ground,
    )


def _holes(make: Callable[[Control, str], Drilling]) -> Callable[[str], Interpolation]:
    """A cycle that drills."""

    def interpolation(name: str) -> Interpolation:
        def drilling(control: Control) -> Drilling:
            return make(control, name)

        def run(control: Control) -> None:
            drill(control, drilling(control), take_goal(control, arc=False).target)

        return Interpolation(run, plain=PlainHole(drilling))

    return interpolation


def _refuse_corner_type(control: Control, words: str) -> None:
    """M and Q in a block of G87: rounded and chamfered corners."""
    if "A" not in words:
        return
    for word in control.block.words:
        if word.address == "Q" or (word.address == "M" and word.value in (0.0, 1.0, 2.0)):
            message = "corners of a pocket are as round as the tool; M and Q are not followed"
            control.fail("unsupported-word", message, word, "leave it out of the cycle's block")


def _read_height(control: Control) -> None:
    values, axis = control.cycle_values, control.modal.plane.axes[2]
    incremental = control.modal.incremental
    reference = control.take(control.settings.axes.names[axis])
    if reference is not None:
        base = control.programmed[axis] if incremental or reference.incremental else 0.0
        values["Z"] = control.length(reference) + base
    values.setdefault("Z", values["start"])
    depth = control.take("I")
    if depth is not None:
        relative = incremental or depth.incremental
        values["I"] = control.length(depth)
        values["bottom"] = control.length(depth) + (values["Z"] if relative else 0.0)


def _drilling(retract: Retract) -> Callable[[Control, str], Drilling]:
    def make(control: Control, name: str) -> Drilling:
        values = _needed(control, name, "I")
        return _made(control, name, values["bottom"], retract=retract)

    return make


def _equal_pecks(control: Control, name: str) -> Drilling:
    values = _needed(control, name, "IJ")
    depth, surface = abs(values["I"]), values["Z"] - values.get("D", 0.0)
    bottom = surface - depth * values["J"]
    if depth <= 0.0:
        control.fail("cycle-depth", f"{name} needs pecks above 0")
    return _made(control, name, bottom, stops=pecks(control, surface, bottom, depth))


def _variable_pecks(control: Control, name: str) -> Drilling:
    values = _needed(control, name, "IB")
    surface, factor = values["Z"] - values.get("D", 0.0), values.get("R", 1.0)
    every, lift = values.get("J", 0.0), values.get("H", 0.0)
    if values["B"] <= 0.0 or factor <= 0.0 or lift < 0.0 or every != int(every) or every < 0.0:
        message = f"{name} needs B and R above 0, H not below 0, and J a count"
        control.fail("cycle-depth", message)
    stops = pecks(control, surface, values["bottom"], values["B"], factor, values.get("L", 0.0))
    full_every = 1 if lift == 0.0 else int(every) or len(stops) + 1
    clearance = values.get("C", _CLEARANCE)
    return _made(
        control,
        name,
        values["bottom"],
        stops=stops,
        full_every=full_every,
        lift=lift,
        clearance=clearance,
    )


def _needed(control: Control, name: str, addresses: str) -> dict[str, float]:
    values = control.cycle_values
    missing = [address for address in addresses if address not in values]
    if missing:
        control.fail("cycle-word", f"{name} needs {' and '.join(missing)}")
    return values


def _made(
    control: Control,
    name: str,
    bottom: float,
    *,
    retract: Retract = Retract.RAPID,
    stops: tuple[float, ...] = (),
    full_every: int = 1,
    lift: float = 0.0,
    clearance: float = CHIP_CLEARANCE,
) -> Drilling:
    values = control.cycle_values
    reference = values["Z"]
    if bottom >= reference or values.get("K", 0.0) < 0.0 or clearance < 0.0:
        message = f"{name} must drill downwards, from Z{reference:g} to {bottom:g}"
        control.fail("cycle-depth", message)
    back = reference if control.modal.return_to_reference else max(values["start"], reference)
    return Drilling(
        reference=reference,
        bottom=bottom,
        back=back,
        dwell=values.get("K", 0.0),
        stops=stops,
        clearance=clearance,
        full_every=full_every,
        lift=lift,
        retract=retract,
    )


def _pocket(*, circular: bool) -> Callable[[str], Interpolation]:
    def interpolation(name: str) -> Interpolation:
        return Interpolation(lambda control: mill_pocket(control, name, circular=circular))

    return interpolation


CYCLES = {
    80: GCode(meaning="cycles off", group="cycle", sets={"cycle": None}, ground="manual"),
    81: _cycle(81, "drilling", "K", _holes(_drilling(Retract.RAPID)), ground="manual"),
    82: _cycle(
        82, "drilling in variable pecks", "BDRLHJCK", _holes(_variable_pecks), lengths="BDLHC"
    ),
    83: _cycle(83, "deep drilling in equal pecks", "JDK", _holes(_equal_pecks), lengths="D"),
    84: _cycle(84, "tapping", "K", _holes(_drilling(Retract.REVERSED))),
    85: _cycle(85, "reaming, back with the feed", "K", _holes(_drilling(Retract.FEED))),
    86: _cycle(
        86, "boring, back with the spindle stopped", "K", _holes(_drilling(Retract.STOPPED))
    ),
    87: _cycle(
        87,
        "rectangular pocket",
        "DAJKBCLHV",
        _pocket(circular=False),
        lengths="DJKBCLHV",
        ground="manual",
    ),
    88: _cycle(
        88, "circular pocket", "DJBCLHV", _pocket(circular=True), lengths="DJBCLHV", ground="manual"
    ),
}
