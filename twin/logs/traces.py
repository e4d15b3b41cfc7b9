"""Traces of controls that are no tables: CODESYS, SINUMERIK Operate (XML), SINUMERIK Edge (JSON)."""

import json
import re
import xml.etree.ElementTree as ET
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from twin.errors import UsageError
from twin.logs.channels import Channel, RawLog

CODESYS_FIRST_LINE = "[key]; [value]"
_VARIABLE = re.compile(r"\d+\.Variable; *(.*)")
_SAMPLE = re.compile(r" *; *([-+.\deE]+) *; *(.*)")
_TICK_S = {16: 1e-3, 32: 1e-6}
"""Bits of ``Flags`` that say what a time stamp counts [s]."""


def read_codesys_trace(path: Path, text: str, tick_s: float | None) -> RawLog:
    """Read a trace that CODESYS saved as CSV: every variable with its own time stamps.

    Args:
        tick_s: What a time stamp counts, where the file does not say it [s].

    Raises:
        UsageError: The file does not say what its time stamps count, or holds no variable.
    """
    flags = re.search(r"^Flags; *(\d+)", text, re.MULTILINE)
    ticks = {tick for bit, tick in _TICK_S.items() if flags and int(flags[1]) & bit}
    tick = tick_s if tick_s is not None else ticks.pop() if len(ticks) == 1 else None
    if tick is None:
        raise UsageError(
            f"{path}: its Flags do not say whether time stamps are milliseconds or microseconds; "
            'a map of columns does: time = { unit = "ms" }'
        )
    channels: list[Channel] = []
    name, stamps, cells = "", [], []

    def finish() -> None:
        if stamps:
            clock = np.array([_stamp(path, stamp) for stamp in stamps])
            channels.append(Channel(name, tuple(cells), clock * tick))

    for line in text.splitlines():
        variable, sample = _VARIABLE.fullmatch(line.strip()), _SAMPLE.fullmatch(line)
        if variable:
            finish()
            name, stamps, cells = variable[1], [], []
        elif sample:
            stamps.append(sample[1])
            cells.append(sample[2].strip())
    finish()
    if not channels:
        raise UsageError(f"{path}: is a CODESYS trace without a recorded variable")
    return RawLog(path, tuple(channels))


def _stamp(path: Path, text: str) -> float:
    try:
        return float(text)
    except ValueError as error:
        raise UsageError(f"{path}: time stamp '{text}' is not a number") from error


def read_sinumerik_trace(path: Path, text: str) -> RawLog:
    """Read a trace of SINUMERIK Operate: ``dataSignal`` names a signal, ``rec`` holds its values.

    Raises:
        UsageError: The file is no XML, or holds no recorded signal.
    """
    try:
        root = ET.fromstring(text)  # noqa: S314 (expat itself limits what entities expand to)
    except ET.ParseError as error:
        raise UsageError(f"{path}: is not XML: {error}") from error
    signals = [element.attrib for element in root.iter() if _local(element) == "dataSignal"]
    times: list[list[float]] = [[] for _ in signals]
    values: list[list[float]] = [[] for _ in signals]
    for record in (element for element in root.iter() if _local(element) == "rec"):
        for key, value in record.attrib.items():
            number = int(key[1:]) - 1 if re.fullmatch(r"f\d+", key) else -1
            if 0 <= number < len(signals):
                try:
                    times[number].append(float(record.attrib["time"]))
                    values[number].append(float(value))
                except (KeyError, ValueError) as error:
                    raise UsageError(f"{path}: a record has no number or no time") from error
    channels = [
        _signal(signal, np.array(times[index]), np.array(values[index]))
        for index, signal in enumerate(signals)
        if values[index]
    ]
    if not channels:
        raise UsageError(
            f"{path}: holds no dataSignal with records: not a trace of SINUMERIK Operate"
        )
    return RawLog(path, tuple(channels))


def _local(element: "ET.Element[str]") -> str:
    return element.tag.rpartition("}")[2]


def _signal(signal: Mapping[str, str], time: Any, values: Any) -> Channel:
    name, description = signal.get("name", ""), signal.get("description", "")
    return Channel(name or description, values, time, (description,), signal.get("unit", ""))


def read_edge_capture(path: Path, text: str) -> RawLog:
    """Read a JSON capture of SINUMERIK Edge: the header lists signals, the payload holds rows.

    A signal is named as ``DES_POS|X``: its kind and its axis; its address (``DES_POS|1``) is known too.

    Raises:
        UsageError: The file is no JSON, or not such a capture.
    """
    try:
        data = json.loads(text)
        header = data["Header"]
        signals = header["SignalListHFData"]
        rows = [row for part in data["Payload"] for row in part.get("HFData", ())]
        table = np.array(rows, np.float64)
        labels = [(f"{s['Name']}|{s.get('Axis', '')}", str(s.get("Address", ""))) for s in signals]
    except (ValueError, KeyError, TypeError, AttributeError, RecursionError) as error:
        raise UsageError(
            f"{path}: is not a capture of SINUMERIK Edge: Header.SignalListHFData must list the "
            f"signals and Payload hold HFData rows ({type(error).__name__}: {error})"
        ) from error
    if table.ndim != 2 or table.shape[1] != len(signals) or len(table) < 2:
        raise UsageError(
            f"{path}: its rows do not have one value for each of {len(signals)} signals"
        )
    cycle_ms = header.get("CycleTimeMs") if isinstance(header, dict) else None
    period = float(cycle_ms) * 1e-3 if isinstance(cycle_ms, int | float) and cycle_ms > 0 else None
    channels = tuple(
        Channel(name, table[:, index], aliases=(address,))
        for index, (name, address) in enumerate(labels)
    )
    counter = next((c for c in channels if c.name.startswith("CYCLE|")), None)
    if counter is not None and period is not None:
        clock = np.asarray(counter.cells, np.float64)
        clock = (clock - clock[0]) * period
        channels = tuple(
            Channel(c.name, c.cells, clock, c.aliases) for c in channels if c is not counter
        )
    return RawLog(path, channels, period)
