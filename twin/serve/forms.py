"""The two forms in which a document is sent: XML, and JSON as the reference agent writes it.

MTConnect Part 1 defines the XML. The JSON is version 2 of the form that the institute's own agent answers with:
attributes are members, text is the member ``value``, and what may stand several times is a list under its name.
"""

import io
import json
import math
import xml.etree.ElementTree as ET  # only writes; nothing from outside is parsed
from collections.abc import Callable
from typing import NamedTuple
from xml.sax.saxutils import XMLGenerator
from xml.sax.xmlreader import AttributesImpl

from twin.serve.documents import Holder

_JSON_VERSION = 2
_SINGLE = frozenset(
    {
        "Header", "Description", "Devices", "Components", "DataItems", "Streams", "Samples",
        "Events", "Condition", "Errors", "Assets", "CuttingToolLifeCycle", "CutterStatus", "Measurements",
        "CuttingItems", "ProgramToolNumber", "ProcessSpindleSpeed", "Configuration", "CoordinateSystems",
        "Motion", "Origin", "Axis",
    }
)  # fmt: skip
"""Elements that stand once at most in their parent."""
_VECTORS = frozenset({"Origin", "Axis"})
"""Elements whose text is three numbers: a list of them in JSON."""
_WHOLE_NUMBERS = frozenset(
    {
        "sequence", "instanceId", "bufferSize", "assetBufferSize", "assetCount", "firstSequence",
        "lastSequence", "nextSequence",
    }
)  # fmt: skip


class DocumentFormat(NamedTuple):
    """How documents are written.

    Attributes:
        written: A document's tree as bytes.
    """

    media_type: str
    written: Callable[[ET.Element], bytes]


def accepted_form(accept: str) -> DocumentFormat:
    """The form that a client asks for; XML where it names none, or both with the same weight.

    Args:
        accept: The header of that name (RFC 9110, section 12.5.1); empty where there is none.
    """
    quality = {"json": 0.0, "xml": 0.0}
    for part in accept.lower().split(","):
        media_type, *parameters = (each.strip() for each in part.split(";"))
        weight = next((each[2:] for each in parameters if each.startswith("q=")), "1")
        try:
            value = float(weight)
        except ValueError:
            continue  # What cannot be read is no wish.
        if media_type == "application/json":
            quality["json"] = max(quality["json"], value)
        elif media_type in ("text/xml", "application/xml", "text/*", "application/*", "*/*"):
            quality["xml"] = max(quality["xml"], value)
    return JSON if quality["json"] > quality["xml"] else XML


def _xml(root: ET.Element) -> bytes:
    out = io.StringIO()
    # Every tag is ended for itself, so that what is written already can stand between two of them.
    writer = XMLGenerator(out, "UTF-8", short_empty_elements=False)
    writer.startDocument()
    _write(writer, out, root)
    return out.getvalue().encode()


def _write(writer: XMLGenerator, out: io.StringIO, element: ET.Element) -> None:
    writer.startElement(element.tag, AttributesImpl(element.attrib))
    if element.text:
        writer.characters(element.text)
    if isinstance(element, Holder):
        out.writelines(element.xml())
    for child in element:
        _write(writer, out, child)
    writer.endElement(element.tag)


def _json(root: ET.Element) -> bytes:
    members: dict[str, object] = {"jsonVersion": _JSON_VERSION}
    header = root.find("Header")
    if header is not None:
        members["schemaVersion"] = header.attrib["version"]
    for child in root:
        members[child.tag] = _members(child)
    return json.dumps({root.tag: members}, ensure_ascii=False).encode()


def _members(element: ET.Element, *, measured: bool = False) -> dict[str, object]:
    """An element as an object; of ``measured`` ones the value is a number."""
    members: dict[str, object] = {
        name: int(value) if name in _WHOLE_NUMBERS else value
        for name, value in element.attrib.items()
    }
    if element.text:
        members["value"] = _number(element.text) if measured else element.text
    children = element.children() if isinstance(element, Holder) else element
    for child in children:
        inner = _inner(child, element)
        if child.tag in _SINGLE:
            members[child.tag] = inner
        else:
            several = members.setdefault(child.tag, [])
            assert isinstance(several, list)
            several.append(inner)
    return members


def _inner(child: ET.Element, parent: ET.Element) -> dict[str, object] | list[float]:
    if child.tag in _VECTORS:
        return [float(value) for value in (child.text or "").split()]
    return _members(child, measured=parent.tag == "Samples")


def _number(text: str) -> float | str:
    """What was measured; ``UNAVAILABLE`` stays a word, and so does what JSON has no number for."""
    try:
        number = float(text)
    except ValueError:
        return text
    return number if math.isfinite(number) else text


XML = DocumentFormat("text/xml", _xml)
JSON = DocumentFormat("application/json", _json)
