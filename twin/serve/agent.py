"""The agent's answers to requests after MTConnect Part 1, without the network."""

import dataclasses
import datetime as dt
import re
import time
import uuid
import xml.etree.ElementTree as ET  # only searches in what was made here
from collections.abc import Iterable, Mapping

from twin.job.job_file import ToolTable
from twin.serve.assets import chosen_assets, tool_assets
from twin.serve.buffer import BUFFER_SIZE, Observation, ObservationBuffer, OutOfRangeError, Value
from twin.serve.device import Component
from twin.serve.documents import (
    Header,
    assets_document,
    device_element,
    devices_document,
    error_document,
    item_ids,
    sender_name,
    streams_document,
)

REQUESTS = ("probe", "current", "sample", "assets")
COUNT = 100
"""Observations of one answer, where the request does not say."""
HEARTBEAT_MS = 10_000
LEAST_INTERVAL_MS = 10
LONGEST_PAUSE_MS = 600_000
_LONGEST_PATH = 1000
_NUMBER = re.compile(r"[+-]?[0-9]{1,18}")


class Clock:
    """Time of day as the twin sees it: it starts at the time of day and may run faster."""

    def __init__(self, speed: float = 1.0) -> None:
        """Start.

        Args:
            speed: Seconds of the twin for each second of the day.
        """
        self._speed = speed
        self._began = dt.datetime.now(dt.UTC)
        self._since = time.monotonic()

    def elapsed_s(self) -> float:
        """Seconds of the twin since the start."""
        return (time.monotonic() - self._since) * self._speed

    def at(self, elapsed_s: float) -> str:
        """ISO 8601 in UTC, to the microsecond.

        Args:
            elapsed_s: Seconds of the twin since the start.
        """
        moment = self._began + dt.timedelta(seconds=elapsed_s)
        return moment.strftime("%Y-%m-%dT%H:%M:%S.%fZ")

    def now(self) -> str:
        """The twin's time, ISO 8601 in UTC."""
        return self.at(self.elapsed_s())


class RequestError(Exception):
    """A request that cannot be met.

    Attributes:
        code: One of the standard's error codes.
    """

    def __init__(self, code: str, message: str, status: int = 400) -> None:
        super().__init__(message)
        self.code = code
        self.status = status


@dataclasses.dataclass(frozen=True, slots=True, kw_only=True)
class Query:
    """A request of observations.

    Attributes:
        request: ``current`` or ``sample``.
        wanted: Identifiers of the data items.
        first: Number of the first observation, or of the moment; None for the default.
        interval_ms: Least pause between two documents of a stream; None for one document.
        heartbeat_ms: Longest pause between two documents of a stream.
    """

    request: str
    wanted: frozenset[str]
    first: int | None
    count: int
    interval_ms: int | None
    heartbeat_ms: int


class Agent:
    """Answers about one device.

    Attributes:
        observed_s: Up to when, by the twin's clock since its start [s].
    """

    def __init__(
        self,
        device: Component,
        clock: Clock,
        description: str,
        size: int = BUFFER_SIZE,
        tools: Iterable[ToolTable] = (),
    ) -> None:
        self.device = device
        self.clock = clock
        self.observed_s = 0.0
        items = [item.id for component in device.walk() for item in component.items]
        self.buffer = ObservationBuffer(items, clock.at(0.0), size)
        self._uuid = str(uuid.uuid5(uuid.NAMESPACE_DNS, f"{device.name}.mill-twin"))
        self._instance = int(time.time())
        self._began = clock.at(0.0)
        self._element = device_element(device, self._uuid, description)
        self._assets = tool_assets(self._uuid, tools, self._began)
        for asset in self._assets:
            self.buffer.add("asset_changed", self._began, asset.attrib["assetId"])

    def observe(self, elapsed_s: float, values: Mapping[str, Value]) -> None:
        """Remember what changed.

        Args:
            elapsed_s: When, by the twin's clock since its start [s].
            values: By identifier of the data item.
        """
        self.observed_s = elapsed_s
        moment = self.clock.at(elapsed_s)
        for item, value in values.items():
            self.buffer.add(item, moment, value)

    def require_device(self, name: str) -> None:
        """Refuse a device that this agent does not know.

        Raises:
            RequestError: It has neither this name nor this identifier.
        """
        if name not in (self.device.name, self._uuid):
            message = f"no device '{name[:_LONGEST_PATH]}': there is {self.device.name}"
            raise RequestError("NO_DEVICE", message, 404)

    def probe(self) -> ET.Element:
        """The document that describes the device."""
        return devices_document(self._header(), self._element, len(self._assets))

    def assets(self, parameters: Mapping[str, str], identifiers: str | None = None) -> ET.Element:
        """The document of the tools.

        Args:
            parameters: Of ``assets``: ``type`` and ``count``.
            identifiers: Of those that are asked for, joined by ``;``; None: all.

        Raises:
            RequestError: One is unknown, or a parameter wrong.
        """
        asked = None if identifiers is None else identifiers.split(";")
        count = _number(parameters, "count", 1)
        try:
            found = chosen_assets(self._assets, asked, parameters.get("type"), count)
        except LookupError as error:
            message = f"no asset '{str(error.args[0])[:_LONGEST_PATH]}': /assets lists them all"
            raise RequestError("ASSET_NOT_FOUND", message, 404) from None
        return assets_document(self._header(), found, len(self._assets))

    def query(self, request: str, parameters: Mapping[str, str]) -> Query:
        """Read the parameters of ``current`` or ``sample``.

        Raises:
            RequestError: One is wrong; the message says what would have worked.
        """
        interval = None
        if "at" in parameters and "interval" in parameters:
            raise RequestError(
                "INVALID_REQUEST", "'at' is a moment, and 'interval' a stream: give one"
            )
        if "interval" in parameters:
            asked = _number(parameters, "interval", 0, LONGEST_PAUSE_MS)
            interval = max(asked or 0, LEAST_INTERVAL_MS)
        heartbeat = _number(parameters, "heartbeat", 1, LONGEST_PAUSE_MS)
        count = _number(parameters, "count")
        if interval is not None and count is not None and count < 0:
            raise RequestError("INVALID_REQUEST", "a stream ('interval') needs a 'count' above 0")
        return Query(
            request=request,
            wanted=self._wanted(parameters.get("path")),
            first=_number(parameters, "from" if request == "sample" else "at", 0),
            count=min(COUNT, self.buffer.size) if count is None else count,
            interval_ms=interval,
            heartbeat_ms=HEARTBEAT_MS if heartbeat is None else heartbeat,
        )

    def answer(self, query: Query) -> tuple[ET.Element, int, bool]:
        """One document of observations.

        Returns:
            The document, the number with which the next request goes on, and whether the document
            holds any observation.

        Raises:
            RequestError: The buffer does not hold what is asked for.
        """
        buffer = self.buffer
        try:
            if query.request == "current":
                found = buffer.current(query.wanted, query.first)
                following = buffer.next_sequence
            else:
                found, following = buffer.sample(query.wanted, query.first, query.count)
        except OutOfRangeError as error:
            raise RequestError("OUT_OF_RANGE", str(error), 404) from error
        return self._streams(found, following), following, bool(found)

    def error(self, error: RequestError) -> ET.Element:
        """The document that reports an error."""
        return error_document(self._header(), error.code, str(error))

    def _streams(self, found: list[Observation], following: int) -> ET.Element:
        first, last = self.buffer.first_sequence, self.buffer.next_sequence - 1
        sequences = (first, last, following)
        return streams_document(self._header(), self.device, self._uuid, found, sequences)

    def _header(self) -> Header:
        return Header(
            time=self.clock.now(),
            instance=self._instance,
            device_changed=self._began,
            buffer_size=self.buffer.size,
            sender=sender_name(),
        )

    def _wanted(self, path: str | None) -> frozenset[str]:
        if path is None:
            return frozenset(item_ids([self._element]))
        if len(path) > _LONGEST_PATH:
            raise RequestError("INVALID_XPATH", f"'path' is longer than {_LONGEST_PATH} letters")
        document = ET.Element("document")
        root = ET.SubElement(document, "MTConnectDevices")
        ET.SubElement(root, "Devices").append(self._element)
        found: set[str] = set()
        for part in path.split("|"):
            search = part.strip()
            absolute = search[:1] == "/"
            within, search = (document, f".{search}") if absolute else (root, search)
            try:
                found |= item_ids(within.iterfind(search))
            except (SyntaxError, KeyError, ValueError, TypeError, IndexError) as error:
                message = f"'path' cannot be read at '{search}': //Axes//DataItem[@type='LOAD'] can"
                raise RequestError("INVALID_XPATH", message) from error
        if not found:
            raise RequestError("INVALID_XPATH", "'path' names no data item of the device")
        return frozenset(found)


def _number(
    parameters: Mapping[str, str], name: str, least: int | None = None, most: int | None = None
) -> int | None:
    text = parameters.get(name)
    if text is None:
        return None
    number = int(text) if _NUMBER.fullmatch(text) else None
    if number is None:
        raise RequestError("INVALID_REQUEST", f"'{name}' must be a whole number")
    if (least is not None and number < least) or (most is not None and number > most):
        limits = f"{least} or more" if most is None else f"{least} to {most}"
        raise RequestError("OUT_OF_RANGE", f"'{name}' is {number}; it must be {limits}", 404)
    return number
