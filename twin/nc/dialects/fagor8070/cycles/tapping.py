"""G84 of the Fagor CNC 8070 with B: tapping in passes that break the chip.

B is the depth of a pass, H how far the tool goes back after each; without H, or with 0, it goes back
to the reference plane. Every way is made with the feed, the spindle reversed on the way back, since
the tap stays in its thread. Decision: the words are those that the manual names; K waits at the
bottom of the hole, as in G84 without B.
"""

import dataclasses

from twin.nc.bytecode.assembler import Assembler, UnsupportedError
from twin.nc.control.codes import GCode, Interpolation
from twin.nc.control.control import Control
from twin.nc.dialects.fagor8070.polar import take_goal
from twin.nc.iso.tapping import Passes, tap_in_passes
from twin.nc.path.drilling_cycle import MOST_PECKS


def tapping_code(code: GCode) -> GCode:
    """G84, whose blocks with B tap in passes."""
    tap = Interpolation(_tap)

    def call(control: Control) -> None:
        if control.words.get("B") is None:
            assert code.action is not None
            code.action(control)
            return
        _take_words(control)
        control.modal.cycle = tap

    def write(control: Control, assembler: Assembler) -> None:
        if control.take("B") is not None or code.compiler is None:
            raise UnsupportedError
        code.compiler(control, assembler)

    return dataclasses.replace(
        code, meaning=f"{code.meaning} R J; in passes: B H", action=call, compiler=write
    )


def _take_words(control: Control) -> None:
    height = control.programmed[control.modal.plane.axes[2]]
    control.cycle_values = values = {"start": height}
    across = control.settings.axes.names[control.modal.plane.axes[2]]
    for address in (across, "I", "B", "H", "K", "R", "J"):
        word = control.take(address)
        if word is None:
            continue
        value = control.length(word) if address in (across, *"IBH") else control.number(word)
        relative = control.modal.incremental or word.incremental
        if address == across and relative:
            value += height
        if address == "I" and relative:
            value += values.get(across, height)
        values[address] = value
    values["reference"] = values.get(across, height)
    if "I" not in values:
        control.fail("cycle-word", "G84 needs I")
    if values["B"] == 0.0 or values.get("H", 0.0) < 0.0:
        control.fail("cycle-depth", "G84 needs B above 0, and H not below 0")
    if values.get("R", 1.0) != 1.0 or values.get("J", 1.0) != 1.0:
        message = "only rigid tapping, R1, goes in passes, and back with the same feed"
        control.fail("unsupported-word", f"G84: {message}")
    if values.get("K", 0.0) < 0.0:
        control.fail("dwell", f"G84 cannot wait {values['K']:g} seconds")
    if not values["I"] < values["reference"]:
        heights = f"from {values['reference']:g} to {values['I']:g}"
        control.fail("cycle-depth", f"G84 must drill downwards, not {heights}")
    if (values["reference"] - values["I"]) / abs(values["B"]) > MOST_PECKS:
        message = f"the hole would need more than {MOST_PECKS} passes"
        control.fail("cycle-depth", message, hint="write a larger B")


def _tap(control: Control) -> None:
    """Tap at the point that the block names."""
    values = control.cycle_values
    reference = values["reference"]
    to_reference = control.modal.return_to_reference
    passes = Passes(
        reference=reference,
        bottom=values["I"],
        depth=abs(values["B"]),
        lift=values.get("H", 0.0),
        dwell=values.get("K", 0.0),
        back=reference if to_reference else max(values["start"], reference),
    )
    tap_in_passes(control, take_goal(control, arc=False).target, passes)
