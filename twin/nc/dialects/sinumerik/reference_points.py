"""G74 and G75: rapidly to the reference points, or to the fixed point, of single axes."""

from twin.nc.control.codes import Action
from twin.nc.control.control import Control
from twin.nc.dialects.sinumerik.targets import forget_polar
from twin.nc.iso.machine_coordinates import machine_frame


def to_reference(number: int) -> Action:
    """Decision: both lie at machine zero, as the machine data have it in the state of delivery.

    The values of the words do not count; ``Z1=0`` names the axis of the machine.
    """

    def action(control: Control) -> None:
        control.take("FP")
        for name in control.settings.axes.names:
            word = control.take(f"{name}1")
            if word is not None:
                control.words[name] = word._replace(address=name)
        words = dict(control.take_axis_words())
        if not words:
            message = f"G{number} needs the axes that it moves"
            control.fail("reference-axes", message, hint=f"write G{number} Z1=0")
        with machine_frame(control, f"G{number}"):
            target = list(control.motion.programmed)
            for axis in words:
                target[axis] = 0.0
            control.line_to(target, rapid=True)
        forget_polar(control)

    return action
