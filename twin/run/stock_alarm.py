"""What the cut must not do, as the alarm that it raises at the machine."""

from twin.cutting.events import CutEvent
from twin.job.job_file import ToolTable
from twin.machine.alarms import Alarm


def stock_alarm(event: CutEvent, tool: ToolTable) -> Alarm:
    """The alarm of a rapid, or of a feed with the spindle off, that met the stock.

    Args:
        event: What the cutter noted.
        tool: What was in the spindle.
    """
    depth = f"{event.depth_mm:.2f} mm deep into the stock"
    if event.what == "rapid":
        message = f"a rapid drives tool {tool.number} {depth}"
        return Alarm("rapid-into-stock", event.line, event.time_s, "", message)
    message = f"tool {tool.number} feeds {depth} with the spindle off"
    return Alarm("spindle-off", event.line, event.time_s, "", message)


def fixture_alarm(event: CutEvent, name: str) -> Alarm:
    """The alarm of a cutter that met what holds the part.

    Args:
        event: Where and how deep.
        name: Of the fixture.
    """
    message = f"the cutter meets the {name} ({event.depth_mm:.2f} mm deep)"
    return Alarm("collision", event.line, event.time_s, "", message)
