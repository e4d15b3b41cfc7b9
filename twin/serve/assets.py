"""The tools of a job as cutting tool assets of MTConnect Part 4.1."""

import xml.etree.ElementTree as ET  # only writes; nothing from outside is parsed
from collections.abc import Iterable, Sequence

from twin.job.job_file import ToolTable

CUTTING_TOOL = "CuttingTool"


def tool_assets(uuid: str, tools: Iterable[ToolTable], time: str) -> list[ET.Element]:
    """One asset for each tool.

    Args:
        uuid: Of the machine that has them.
        time: Since when they are as they are, ISO 8601.
    """
    return [_tool_asset(uuid, tool, time) for tool in tools]


def _tool_asset(uuid: str, tool: ToolTable, time: str) -> ET.Element:
    identifier = f"T{tool.number}.{uuid}"
    attributes = {
        "assetId": identifier, "serialNumber": identifier, "toolId": tool.name or tool.kind,
        "deviceUuid": uuid, "timestamp": time,
    }  # fmt: skip
    element = ET.Element(CUTTING_TOOL, attributes)
    ET.SubElement(element, "Description").text = f"{tool.kind}, {tool.made_of}"
    life = ET.SubElement(element, "CuttingToolLifeCycle")
    ET.SubElement(ET.SubElement(life, "CutterStatus"), "Status").text = "AVAILABLE"
    ET.SubElement(life, "ProgramToolNumber").text = str(tool.number)
    if tool.speed is not None:
        ET.SubElement(life, "ProcessSpindleSpeed", nominal=f"{tool.speed:g}")
    measured = (
        ("CuttingDiameterMax", "DC", tool.diameter),
        ("DepthOfCutMax", "APMX", tool.flute),
        ("FunctionalLength", "LF", tool.length),
        ("ShankDiameter", "DMM", tool.shank or tool.diameter),
    )
    measurements = ET.SubElement(life, "Measurements")
    for name, code, value in measured:
        units = {"code": code, "units": "MILLIMETER", "nominal": f"{value:g}"}
        ET.SubElement(measurements, name, units).text = f"{value:g}"
    items = ET.SubElement(life, "CuttingItems", count=str(tool.teeth))
    ET.SubElement(items, "CuttingItem", indices=f"1-{tool.teeth}" if tool.teeth > 1 else "1")
    return element


def chosen_assets(
    assets: Sequence[ET.Element],
    identifiers: Sequence[str] | None,
    kind: str | None,
    count: int | None,
) -> list[ET.Element]:
    """Assets that a request asks for, the newest first, as the standard has it.

    Args:
        assets: All of them, the oldest first.
        identifiers: Of those that are asked for; None: all.
        kind: Their type; None: any.
        count: How many at most; None: all.

    Raises:
        LookupError: An identifier is unknown; its argument is the identifier.
    """
    known = {element.attrib["assetId"]: element for element in assets}
    if identifiers is not None:
        for identifier in identifiers:
            if identifier not in known:
                raise LookupError(identifier)
        return [known[identifier] for identifier in identifiers]
    found = [element for element in reversed(assets) if kind in (None, element.tag)]
    return found[:count]
