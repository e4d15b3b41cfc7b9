"""The documents of MTConnect 2.0: Devices, Streams, Assets and Error, as trees."""

import dataclasses
import xml.etree.ElementTree as ET  # only writes; nothing from outside is parsed
from collections.abc import Iterable, Iterator, Mapping, Sequence

from twin.serve.assets import CUTTING_TOOL
from twin.serve.buffer import Condition, Observation
from twin.serve.device import UNAVAILABLE, Component, DataItem
from twin.version import __version__

VERSION = "2.0"
_SCHEMA_INSTANCE = "http://www.w3.org/2001/XMLSchema-instance"
_MACHINE_ZERO = "machine_zero"
"""Identifier of the coordinate system in which the axes' motions are given."""
_CATEGORIES = {"SAMPLE": "Samples", "EVENT": "Events", "CONDITION": "Condition"}
"""Of each category the element that holds its observations, in the order of the schema."""


@dataclasses.dataclass(frozen=True, slots=True, kw_only=True)
class Header:
    """What is at the head of every document.

    Attributes:
        time: When the document was made, by the twin's clock, ISO 8601.
        instance: Number of this start of the agent; sequence numbers of another mean nothing here.
        device_changed: When the description of the device last changed, ISO 8601.
    """

    time: str
    instance: int
    device_changed: str
    buffer_size: int
    sender: str

    def attributes(self) -> dict[str, str]:
        """As attributes of every document; ``testIndicator`` says that no real machine is behind it."""
        return {
            "creationTime": self.time,
            "sender": self.sender,
            "instanceId": str(self.instance),
            "version": VERSION,
            "bufferSize": str(self.buffer_size),
            "testIndicator": "true",
        }

    def of_device(self) -> dict[str, str]:
        """As attributes of a document that reports the device."""
        return self.attributes() | {"deviceModelChangeTime": self.device_changed}


def device_element(device: Component, uuid: str, description: str) -> ET.Element:
    """The device with its components and data items; ``path`` requests search in it."""
    element = _component_element(device)
    element.set("uuid", uuid)
    about = ET.Element("Description", manufacturer="mill-twin", model=device.name)
    about.text = description
    element.insert(0, about)
    return element


def _component_element(component: Component) -> ET.Element:
    element = ET.Element(component.element, id=component.id, name=component.name)
    if any(each.motion for each in component.components):
        systems = ET.SubElement(ET.SubElement(element, "Configuration"), "CoordinateSystems")
        ET.SubElement(systems, "CoordinateSystem", id=_MACHINE_ZERO, type="MACHINE")
    if component.motion:
        ET.SubElement(element, "Configuration").append(_motion_element(component))
    if component.items:
        items = ET.SubElement(element, "DataItems")
        for item in component.items:
            ET.SubElement(items, "DataItem", _item_attributes(item))
    if component.components:
        inner = ET.SubElement(element, "Components")
        inner.extend(_component_element(each) for each in component.components)
    return element


def _motion_element(component: Component) -> ET.Element:
    motion = component.motion
    assert motion is not None
    attributes = {"id": _motion_id(component.id), "type": motion.type, "actuation": "DIRECT"}
    if motion.parent:
        attributes["parentIdRef"] = _motion_id(motion.parent)
    element = ET.Element("Motion", attributes | {"coordinateSystemIdRef": _MACHINE_ZERO})
    if motion.origin:
        ET.SubElement(element, "Origin").text = _vector(motion.origin)
    ET.SubElement(element, "Axis").text = _vector(motion.axis)
    return element


def _motion_id(axis: str) -> str:
    return f"{axis}_motion"


def _vector(values: Iterable[float]) -> str:
    return " ".join(f"{value:g}" for value in values)


def _item_attributes(item: DataItem) -> dict[str, str]:
    attributes = {"category": item.category, "id": item.id, "type": item.type}
    if item.sub_type:
        attributes["subType"] = item.sub_type
    if item.units:
        attributes |= {"units": item.units, "nativeUnits": item.units}
    return attributes


def devices_document(header: Header, device: ET.Element, assets: int) -> ET.Element:
    """The answer to ``probe``; ``assets`` are kept."""
    root = _root("Devices")
    ET.SubElement(root, "Header", header.of_device() | _asset_counts(assets))
    ET.SubElement(root, "Devices").append(device)
    return root


def assets_document(header: Header, found: Iterable[ET.Element], assets: int) -> ET.Element:
    """The answer to ``assets`` and ``asset``: some that were found of ``assets`` that are kept."""
    root = _root("Assets")
    attributes = header.of_device() | _asset_counts(assets)
    del attributes["bufferSize"]
    ET.SubElement(root, "Header", attributes)
    ET.SubElement(root, "Assets").extend(found)
    return root


def _asset_counts(assets: int) -> dict[str, str]:
    """Assets are those of the job, no more and no fewer; a buffer has one place at least."""
    return {"assetBufferSize": str(max(1, assets)), "assetCount": str(assets)}


def streams_document(
    header: Header,
    device: Component,
    uuid: str,
    observations: Sequence[Observation],
    sequences: tuple[int, int, int],
) -> ET.Element:
    """The answer to ``current`` and ``sample``.

    Args:
        observations: In any order.
        sequences: Number of the first and the last observation that is remembered, and of the one
            with which the next request goes on.
    """
    root = _root("Streams")
    first, last, following = (str(number) for number in sequences)
    numbers = {"firstSequence": first, "lastSequence": last, "nextSequence": following}
    ET.SubElement(root, "Header", header.of_device() | numbers)
    stream = ET.SubElement(ET.SubElement(root, "Streams"), "DeviceStream")
    stream.attrib |= {"name": device.name, "uuid": uuid}
    wanted = {observation.item for observation in observations}
    holders: dict[str, Holder] = {}
    for component in device.walk():
        seen = [item for item in component.items if item.id in wanted]
        if seen:
            holders |= dict(_component_stream(stream, component, seen))
    for observation in sorted(observations, key=lambda each: each.sequence):
        holders[observation.item].observations.append(observation)
    return root


class Holder(ET.Element):
    """An element that holds observations of one category: they become its children as it is written.

    Attributes:
        data_items: Of the observations, by their identifiers.
        observations: In the order of their numbers.
    """

    def __init__(self, tag: str, data_items: Mapping[str, DataItem]) -> None:
        super().__init__(tag)
        self.data_items = data_items
        self.observations: list[Observation] = []

    def children(self) -> Iterator[ET.Element]:
        """The observations as elements."""
        for observation in self.observations:
            yield _observation_element(self.data_items[observation.item], observation)

    def xml(self) -> Iterator[str]:
        """The observations as they are written, each of which is written once for all clients."""
        for observation in self.observations:
            if not observation.xml:
                element = _observation_element(self.data_items[observation.item], observation)
                observation.xml = ET.tostring(element, encoding="unicode")
            yield observation.xml


def _component_stream(
    stream: ET.Element, component: Component, seen: Sequence[DataItem]
) -> Iterator[tuple[str, Holder]]:
    """Add a component to a stream; yield the holder of each of its data items."""
    element = ET.SubElement(stream, "ComponentStream", component=component.element)
    element.attrib |= {"name": component.name, "componentId": component.id}
    for category, tag in _CATEGORIES.items():
        found = {item.id: item for item in seen if item.category == category}
        if found:
            holder = Holder(tag, found)
            element.append(holder)
            yield from ((item, holder) for item in found)


def _observation_element(item: DataItem, observation: Observation) -> ET.Element:
    value = observation.value
    attributes = {
        "dataItemId": item.id,
        "sequence": str(observation.sequence),
        "timestamp": observation.time,
    }
    if item.category == "CONDITION":
        condition = value if isinstance(value, Condition) else Condition("Unavailable")
        element = ET.Element(condition.level, attributes | {"type": item.type})
        if condition.code:
            element.set("nativeCode", condition.code)
        element.text = _legal(condition.text) or None
        return element
    element = ET.Element(item.element, attributes)
    if item.sub_type:
        element.set("subType", item.sub_type)
    if item.type in ("ASSET_CHANGED", "ASSET_REMOVED"):
        element.set("assetType", "" if value == UNAVAILABLE else CUTTING_TOOL)
    element.text = UNAVAILABLE if isinstance(value, Condition) else _legal(value)
    return element


def error_document(header: Header, code: str, message: str) -> ET.Element:
    """The answer to a request that cannot be met.

    Args:
        code: One of the standard's, such as ``OUT_OF_RANGE``.
    """
    root = _root("Error")
    ET.SubElement(root, "Header", header.attributes())
    error = ET.SubElement(ET.SubElement(root, "Errors"), "Error", errorCode=code)
    error.text = _legal(message)
    return root


def _root(kind: str) -> ET.Element:
    space = f"urn:mtconnect.org:MTConnect{kind}:{VERSION}"
    return ET.Element(
        f"MTConnect{kind}",
        {
            "xmlns": space,
            "xmlns:xsi": _SCHEMA_INSTANCE,
            "xsi:schemaLocation": (
                f"{space} http://schemas.mtconnect.org/schemas/MTConnect{kind}_{VERSION}.xsd"
            ),
        },
    )


def _legal(text: str) -> str:
    """A program may hold control characters, which no XML document can, escaped or not."""
    return "".join(
        letter if letter >= " " or letter in "\t\n" else "\N{REPLACEMENT CHARACTER}"
        for letter in text
        if not "\ud800" <= letter <= "\udfff" and letter not in "\ufffe\uffff"
    )


def item_ids(elements: Iterable[ET.Element]) -> set[str]:
    """Identifiers of the data items in some elements of a device, themselves included."""
    found: set[str] = set()
    for element in elements:
        found |= {item.attrib["id"] for item in element.iter("DataItem")}
    return found


def sender_name() -> str:
    """How the agent calls itself."""
    return f"mill-twin {__version__}"
