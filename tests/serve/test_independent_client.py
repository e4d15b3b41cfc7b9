"""The agent as somebody else's client sees it, and its words against the standard's own model.

``pymtconnect`` is generated from the SysML model of MTConnect 2; its client asks for JSON.
"""

import importlib
import importlib.util
import time
from collections.abc import Iterator

import pytest
from pymtconnect import mtconnect_client as client

from tests.serve.test_http_server import AXES, FAULT, served
from twin.serve.agent import Agent, Clock
from twin.serve.buffer import NORMAL
from twin.serve.device import Component, DataItem, device_of
from twin.serve.forms import JSON, XML, accepted_form
from twin.serve.playback import Tick

pytestmark = pytest.mark.oracle

PERIOD_S = 0.01
SHIFT = [
    ("READY", NORMAL), ("ACTIVE", NORMAL), ("STOPPED", FAULT), ("READY", NORMAL),
]  # fmt: skip
"""What happens to the machine, half a second each."""


def machine() -> Iterator[Tick]:
    """It waits, runs, breaks down, and is reset; then it waits for ever."""
    for number in range(100_000):
        execution, system = SHIFT[min(number // 50, len(SHIFT) - 1)]
        values = {"X_position": f"{number}", "execution": execution, "system": system}
        yield Tick(number * PERIOD_S, values | {"availability": "AVAILABLE"})


@pytest.fixture
def address() -> Iterator[str]:
    """Where an agent of this machine listens."""
    agent = Agent(device_of("mill", AXES), Clock(), "made up", size=5000)
    with served(agent, machine()) as port:
        yield f"http://127.0.0.1:{port}"


def test_it_finds_the_device(address: str) -> None:
    header, devices = client.probe(address)
    assert header.version == "2.0"
    assert [device.name for device in devices] == ["mill"]


def test_it_sees_the_machine_run_break_down_and_be_ready_again(address: str) -> None:
    seen: list[str] = []
    patience = time.monotonic() + 20.0
    for _, events, _ in client.stream_sample(address, interval=20, from_seq=1, count=500):
        seen.extend(event.result for event in events if event.type == "Execution")
        if seen[-2:] == ["STOPPED", "READY"]:
            break
        assert time.monotonic() < patience, "the machine was never ready again"
    assert seen == ["UNAVAILABLE", "READY", "ACTIVE", "STOPPED", "READY"]


def test_it_sees_the_fault(address: str) -> None:
    faults: list[object] = []
    for _ in range(100):
        _, _, conditions = client.sample(address, from_seq=1, count=5000)
        faults = [each.native_code for each in conditions if each.state == "Fault"]
        if faults:
            break
        time.sleep(0.05)
    assert faults == ["hard-limit"]


def _enumeration(name: str) -> set[str]:
    module = importlib.import_module(f"pymtconnect.Enums.DataTypes.{name}Enum")
    return {member.value for member in getattr(module, f"{name}Enum")}


def _is_class(package: str, name: str) -> bool:
    return importlib.util.find_spec(f"pymtconnect.Classes.{package}.{name}") is not None


@pytest.mark.parametrize(
    ("component", "item"),
    [
        pytest.param(component, item, id=item.id)
        for component in device_of("mill", AXES).walk()
        for item in component.items
    ],
)
def test_every_data_item_is_one_of_the_standard(component: Component, item: DataItem) -> None:
    kind = item.category.capitalize()
    assert item.type in _enumeration(kind)
    assert _is_class("ComponentTypes", component.element) or component.element == "Device"
    if item.units:
        assert item.units.replace("/", "_PER_") in _enumeration("Unit")
    if item.sub_type:
        assert item.sub_type in _enumeration("DataItemSubType")
        assert _is_class(f"{kind}Types", f"{item.element}_{item.sub_type.capitalize()}")


@pytest.mark.parametrize(
    ("accept", "form"),
    [
        ("", XML),
        ("*/*", XML),
        ("application/json", JSON),
        ("text/html,application/xhtml+xml,application/xml;q=0.9,*/*;q=0.8", XML),
        ("application/json, text/xml;q=0.5", JSON),
        ("application/json;q=0.5, application/xml", XML),
        ("application/json;q=nonsense", XML),
    ],
)
def test_the_form_is_the_one_asked_for(accept: str, form: object) -> None:
    assert accepted_form(accept) is form
