"""M70 to M73: what is in force is put aside, and put back."""

from twin.nc.control.codes import Action
from twin.nc.control.control import Control
from twin.nc.dialects.linuxcnc.memory import SYSTEMS, SavedState, memory_of, written_feed
from twin.nc.dialects.linuxcnc.offsets import change_preset, reframe, refuse_in_compensation

_COMPENSATION = "compensation"
_FRAME = ("offset", "units", "plane")
_AXES = (*"XYZABCUVW", "@", "^")
_KEPT_GROUPS = ("motion", "not modal", "length")
"""What neither M72 nor the end of a subroutine puts back."""


def save(*, until_return: bool) -> Action:
    """M70, and M73, which the end of the subroutine puts back."""

    def action(control: Control) -> None:
        memory = memory_of(control)
        state = SavedState(
            control.modal.fork(), written_feed(control), control.motion.spindle, memory.preset_on
        )
        memory.saved[control.program_counter.depth] = (state, until_return)

    return action


def forget(control: Control) -> None:
    """M71: nothing is put back."""
    memory_of(control).saved.pop(control.program_counter.depth, None)


def restore(control: Control) -> None:
    """M72: put back into force what M70 or M73 has put aside here; the block may not move."""
    saved = memory_of(control).saved.get(control.program_counter.depth)
    if saved is None:
        control.fail("code-words", "M72 puts back what M70 or M73 has put aside, and none has")
    axis = next((word for letter, word in control.words.items() if letter in _AXES), None)
    if axis is not None:
        hint = "write them in the next block"
        control.fail(
            "code-words", "axis words in a block with M72 are lost in the control", axis, hint
        )
    _put_back(control, saved[0])


def restore_at_return(control: Control) -> None:
    """The end of a subroutine puts back what M73 has put aside in it."""
    saved = memory_of(control).saved.pop(control.program_counter.depth, None)
    if saved is not None and saved[1]:
        _put_back(control, saved[0])


def _put_back(control: Control, state: SavedState) -> None:
    active, given = control.modal.active, state.modal.active
    if given.get(_COMPENSATION) != active.get(_COMPENSATION):
        message = "what was put aside would change the radius compensation"
        hint = "write G40, G41 or G42 itself before"
        control.fail("compensation-change", message, hint=hint)
    compensated = memory_of(control).compensation is not None
    if compensated and any(given.get(group) != active.get(group) for group in _FRAME):
        refuse_in_compensation(control)
    now, modal = control.modal, state.modal.fork()
    modal.interpolation, modal.cycle = now.interpolation, now.cycle
    for group in _KEPT_GROUPS:
        modal.active.put(group, active.get(group))
    now.restore(modal)
    control.motion.spindle = state.spindle
    if state.feed != written_feed(control):  # else nothing is written again (``rs274``)
        control.motion.feed, memory_of(control).converted_feed = state.feed, None
    system = f"G{control.modal.active.get('offset', 54):g}"
    memory_of(control).system = SYSTEMS.index(system) + 1
    if memory_of(control).preset_on != state.preset_on:
        change_preset(on=state.preset_on)(control)
    if not compensated:  # else the programmed position is that of the contour, not of the tool
        reframe(control)
