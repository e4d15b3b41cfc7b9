"""Drilling cycles G81 to G89 with the words of ISO 6983-1.

X and Y name the hole, Z its bottom, R the reference plane, P the seconds at the bottom, Q the depth
of one peck. All but X and Y stay in force, and every block that names a hole drills it, until G80
or a motion code. Decisions: with G91, R counts from where the tool stands and Z from R; a cycle
block without a hole drills where the tool stands; the tool returns to the height at which the cycle
was called, or with G99 to the reference plane.
"""

from twin.nc.control import Control
from twin.nc.dialect import GCode
from twin.nc.drilling import Drilling, Retract, drill, pecks
from twin.nc.interpolation import Interpolation, PlainHole


def _cycle(name: str, *, dwell: bool = False, peck: bool = False, retract: Retract) -> GCode:
    def start(control: Control) -> None:
        axis = control.modal.plane.axes[2]
        control.cycle_values.setdefault("start", control.programmed[axis])

    def drilling(control: Control) -> Drilling:
        return _drilling(control, name, dwell=dwell, peck=peck, retract=retract)

    def perform(control: Control) -> None:
        _read_words(control, dwell=dwell, peck=peck)
        drill(control, drilling(control), control.target())

    return GCode(
        meaning=f"{_MEANINGS[name]}: X Y Z R" + (" P" if dwell else "") + (" Q" if peck else ""),
        group="cycle",
        sets={"cycle": Interpolation(perform, plain=PlainHole(drilling))},
        action=start,
    )


def _read_words(control: Control, *, dwell: bool, peck: bool) -> None:
    """Take the words that stay in force."""
    axis = control.modal.plane.axes[2]
    letter = control.settings.axes.names[axis]
    values = control.cycle_values
    incremental = control.modal.incremental
    word = control.take("R")
    if word is not None:
        values["R"] = control.length(word) + (values["start"] if incremental else 0.0)
    word = control.take(letter)
    if word is not None:
        values[letter] = control.length(word) + (values.get("R", 0.0) if incremental else 0.0)
    for address, wanted in (("P", dwell), ("Q", peck)):
        if wanted and (word := control.take(address)) is not None:
            values[address] = control.number(word) if address == "P" else control.length(word)


def _drilling(
    control: Control, name: str, *, dwell: bool, peck: bool, retract: Retract
) -> Drilling:
    """The cycle in force, whose words must be there."""
    values = control.cycle_values
    letter = control.settings.axes.names[control.modal.plane.axes[2]]
    needed = ["R", letter, *(["Q"] if peck else [])]
    missing = [address for address in needed if address not in values]
    if missing:
        control.fail("cycle-word", f"{name} needs {' and '.join(missing)}")
    if values[letter] >= values["R"] or values.get("Q", 1.0) <= 0.0:
        control.fail(
            "cycle-depth",
            f"{name} must drill downwards, from R{values['R']:g} to {letter}{values[letter]:g}, "
            "in pecks above 0",
        )
    back = values["R"] if control.modal.return_to_reference else max(values["start"], values["R"])
    return Drilling(
        reference=values["R"],
        bottom=values[letter],
        back=back,
        dwell=values.get("P", 0.0) if dwell else 0.0,
        stops=pecks(control, values["R"], values[letter], values["Q"]) if peck else (),
        retract=retract,
    )


_MEANINGS = {
    "G81": "drilling",
    "G82": "drilling with dwell",
    "G83": "deep drilling in pecks",
    "G84": "tapping",
    "G85": "reaming, back with the feed",
    "G86": "boring, back with the spindle stopped",
    "G89": "reaming with dwell",
}

_BY_HAND = "the operator moves the axes by hand in it"

CYCLES = {
    80: GCode(meaning="drilling cycles off", group="cycle", sets={"cycle": None}),
    81: _cycle("G81", retract=Retract.RAPID),
    82: _cycle("G82", dwell=True, retract=Retract.RAPID),
    83: _cycle("G83", peck=True, retract=Retract.RAPID),
    84: _cycle("G84", dwell=True, retract=Retract.REVERSED),
    85: _cycle("G85", retract=Retract.FEED),
    86: _cycle("G86", retract=Retract.STOPPED),
    87: GCode(meaning="boring by hand", group="cycle", refused=_BY_HAND),
    88: GCode(meaning="boring by hand with dwell", group="cycle", refused=_BY_HAND),
    89: _cycle("G89", dwell=True, retract=Retract.FEED),
}
RETURN = {
    98: GCode(
        meaning="cycles return to the height of their call",
        group="return plane",
        sets={"return_to_reference": False},
    ),
    99: GCode(
        meaning="cycles return to the reference plane",
        group="return plane",
        sets={"return_to_reference": True},
    ),
}
