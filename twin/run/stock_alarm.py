"""What the cut must not do, as the alarm that it raises at the machine."""

from twin.cutting.events import CutEvent
from twin.job.job_file import ToolTable
from twin.machine.alarms import Alarm


def stock_alarm(event: CutEvent, tool: ToolTable) -> Alarm:
    """The alarm of what met the stock: a rapid, a feed with the spindle off, shank, holder, head.

    Args:
        event: What the cutter noted.
        tool: What was in the spindle.
    """
    depth = f"{event.depth_mm:.2f} mm deep"
    if event.what == "rapid":
        message = f"a rapid drives tool {tool.number} {depth} into the stock"
        return Alarm("rapid-into-stock", event.line, event.time_s, "", message)
    if event.what == "standing":
        message = f"tool {tool.number} feeds {depth} into the stock with the spindle off"
        return Alarm("spindle-off", event.line, event.time_s, "", message)
    if event.what == "flute":
        message = f"the shank of tool {tool.number} meets the part above its flutes ({depth})"
    elif event.what in ("shank", "holder"):
        message = f"the {event.what} of tool {tool.number} meets the part ({depth})"
    else:
        message = f"the {event.what} meets the part ({depth})"
    return Alarm("collision", event.line, event.time_s, "", message)
