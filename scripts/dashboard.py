"""A dashboard's picture of a machine that speaks MTConnect.

``python scripts/dashboard.py ADDRESS OUT.png [SECONDS]`` reads ``/probe``, ``/current`` and then ``/sample``
again and again, as a monitor does, from ``twin serve`` or any other agent.
"""

import sys
import time
import urllib.request
from collections import defaultdict
from datetime import datetime
from xml.etree import ElementTree as ET

import matplotlib as mpl

mpl.use("Agg")
import matplotlib.pyplot as plt
from matplotlib.axes import Axes

Course = list[tuple[float, str]]
"""Times [s] and values as they were told."""
COUNT = 5000
"""Observations that are asked for at once."""
COLORS = {"X": "tab:red", "Y": "tab:green", "Z": "tab:blue", "C": "tab:purple"}
STATES = {"READY": "0.75", "ACTIVE": "tab:green", "STOPPED": "tab:red",
          "FEED_HOLD": "tab:orange", "PROGRAM_COMPLETED": "tab:cyan"}  # fmt: skip


def asked(address: str, question: str) -> ET.Element:
    """An answer of the agent."""
    url = address.rstrip("/") + question
    if not url.startswith("http://"):
        sys.exit(f"{address} is no address such as http://127.0.0.1:5000/")
    with urllib.request.urlopen(url, timeout=10) as answer:  # noqa: S310 (http, as asked above)
        return ET.fromstring(answer.read())  # noqa: S314 (an agent of this computer)


def names_of(probe: ET.Element) -> dict[str, str]:
    """Component and kind of each data item, by its identifier."""
    found: dict[str, str] = {}
    for component in probe.iter():
        own = component.find("{*}DataItems")
        for item in [] if own is None else own:
            kind = f"{item.get('type')} {item.get('subType') or ''}".strip()
            found[str(item.get("id"))] = f"{component.get('name')} {kind}"
    return found


def watch(address: str, seconds: float) -> dict[str, Course]:
    """What the agent told in some seconds, by component and kind."""
    names, courses = names_of(asked(address, "/probe")), defaultdict[str, Course](list)
    document, end, start = asked(address, "/current"), time.monotonic() + seconds, 0.0
    while True:
        header = document.find("{*}Header")
        if header is None:
            sys.exit(f"{address} tells of no sequence")
        # What was told long ago still holds: it is drawn from the beginning.
        start = start or _moment(str(header.get("creationTime")))
        for told in document.iter():
            if name := names.get(str(told.get("dataItemId"))):
                when = max(0.0, _moment(str(told.get("timestamp"))) - start)
                courses[name].append((when, told.text or ""))
        if time.monotonic() > end:
            break
        time.sleep(0.2)
        document = asked(address, f"/sample?from={header.get('nextSequence')}&count={COUNT}")
    return courses


def _moment(text: str) -> float:
    return datetime.fromisoformat(text).timestamp()


def draw(courses: dict[str, Course], path: str, title: str) -> None:
    """Positions, load, feed and what the control does, over time."""
    last = max((when for course in courses.values() for when, _ in course), default=0.0)
    figure, rows = plt.subplots(4, 1, figsize=(9, 7), sharex=True, height_ratios=(3, 2, 2, 1))
    for axis, (word, label) in zip(
        rows, (("POSITION ACTUAL", "position [mm]"), ("LOAD", "load [%]"), ("FEEDRATE", "feed [mm/s]")),
        strict=False,
    ):  # fmt: skip
        for name, course in sorted(courses.items()):
            numbers = [(when, float(value)) for when, value in course if _is_number(value)]
            if word in name and numbers:
                numbers.append((last, numbers[-1][1]))
                part = name.split()[0]
                color = COLORS.get(part, "0.2")
                axis.step(*zip(*numbers, strict=True), where="post", lw=1, label=part, color=color)
        axis.set_ylabel(label)
        axis.grid(alpha=0.3)
        axis.legend(loc="upper left", bbox_to_anchor=(1.0, 1.0), fontsize=8)
    _states(rows[3], next((c for name, c in courses.items() if "EXECUTION" in name), []))
    rows[3].set_xlabel("time of the machine [s]")
    figure.suptitle(title)
    figure.tight_layout()
    figure.savefig(path, dpi=90)


def _states(axis: Axes, course: Course) -> None:
    left, right = 0.0, axis.get_xlim()[1]
    ends = [when for when, _ in course[1:]] + [right]
    for (when, state), until in zip(course, ends, strict=False):
        axis.barh(0, until - when, left=when, color=STATES.get(state, "0.9"), label=state)
    shown = dict(zip(*axis.get_legend_handles_labels()[::-1], strict=True))
    axis.legend(
        shown.values(), shown.keys(), loc="upper left", bbox_to_anchor=(1.0, 1.0), fontsize=8
    )
    axis.set_yticks([])
    axis.set_xlim(left, right)
    axis.set_ylabel("execution")


def _is_number(text: str) -> bool:
    try:
        float(text)
    except ValueError:
        return False
    return True


def main(arguments: list[str]) -> int:
    """Watch an agent and draw what it told."""
    if len(arguments) not in (2, 3):
        sys.exit(__doc__)
    address, path = arguments[:2]
    seconds = float(arguments[2]) if len(arguments) > 2 else 20.0
    draw(watch(address, seconds), path, f"{address}: what an MTConnect agent told")
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
