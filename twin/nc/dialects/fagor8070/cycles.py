"""Drilling cycles of the Fagor CNC 8070.

Z names the reference plane, I the depth: absolute with G90, from the reference plane with G91. K is
a dwell at the bottom [s]. In G83, I is the depth of one peck and J their number. Every block that
names a point of the plane drills there, until G80 or another motion code; with G98 the tool goes
back to the height at which the cycle was called, with G99 to the reference plane.
"""

from twin.nc.control import Control
from twin.nc.dialect import GCode, Interpolation
from twin.nc.dialects.fagor8070.polar import take_goal
from twin.nc.drilling import Drilling, Retract, drill


def _cycle(number: int, meaning: str, retract: Retract, *, peck: bool = False) -> GCode:
    def start(control: Control) -> None:
        height = control.programmed[control.modal.plane.axes[2]]
        control.cycle_values.setdefault("start", height)
        _read_words(control)

    def perform(control: Control) -> None:
        _perform(control, f"G{number}", retract, peck=peck)

    return GCode(
        meaning=f"{meaning}: Z I" + (" J" if peck else "") + " K",
        group="cycle",
        sets={"cycle": Interpolation(perform)},
        action=start,
        ground="manual",
    )


def _read_words(control: Control) -> None:
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
    for address in "JK":
        if (word := control.take(address)) is not None:
            values[address] = control.number(word)


def _perform(control: Control, name: str, retract: Retract, *, peck: bool) -> None:
    values = control.cycle_values
    needed = ["I", "J"] if peck else ["I"]
    missing = [address for address in needed if address not in values]
    if missing:
        control.fail("cycle-word", f"{name} needs {' and '.join(missing)}")
    depth, reference = values["I"], values["Z"]
    bottom = reference - abs(depth) * values["J"] if peck else values["bottom"]
    if bottom >= reference or values.get("K", 0.0) < 0.0:
        message = f"{name} must drill downwards, from Z{reference:g} to {bottom:g}"
        control.fail("cycle-depth", message)
    back = reference if control.modal.return_to_reference else max(values["start"], reference)
    cycle = Drilling(
        reference=reference,
        bottom=bottom,
        back=back,
        dwell=values.get("K", 0.0),
        peck=abs(depth) if peck else 0.0,
        retract=retract,
    )
    drill(control, cycle, take_goal(control, arc=False).target)


_POCKET = "pockets are not milled by the twin as cycles; write their path"

CYCLES = {
    80: GCode(meaning="cycles off", group="cycle", sets={"cycle": None}, ground="manual"),
    81: _cycle(81, "drilling", Retract.RAPID),
    82: GCode(
        meaning="drilling with variable peck",
        group="cycle",
        refused="its words are not documented well enough to be followed; write G83",
        ground="manual",
    ),
    83: _cycle(83, "deep drilling in equal pecks", Retract.RAPID, peck=True),
    84: _cycle(84, "tapping", Retract.REVERSED),
    85: _cycle(85, "reaming, back with the feed", Retract.FEED),
    86: _cycle(86, "boring, back with the spindle stopped", Retract.STOPPED),
    87: GCode(meaning="rectangular pocket", group="cycle", refused=_POCKET, ground="manual"),
    88: GCode(meaning="circular pocket", group="cycle", refused=_POCKET, ground="manual"),
}
