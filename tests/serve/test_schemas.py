"""Every state's documents against what the schemas of MTConnect 2.0 ask of the elements in them.

The official schemas are in no package: ``test_official_schemas.py`` takes them from a folder. Those beside
these tests were written after them, for what this agent writes alone.
"""

import re
from pathlib import Path

import pytest

from tests.serve.schema_check import Schemas
from tests.serve.test_device import probe_of
from twin.job.job_file import ToolTable
from twin.nc.canonical import Axes
from twin.serve.agent import Agent, Clock, RequestError
from twin.serve.buffer import NORMAL, Condition, Value
from twin.serve.device import device_of
from twin.serve.forms import XML

pytestmark = pytest.mark.oracle

AXES = Axes(("X", "Y", "Z", "C"), ("linear", "linear", "linear", "rotary"))
MOVING: dict[str, Value] = {
    "X_position": "-12.345678", "X_position_commanded": "-12.300000", "X_load": "3.25",
    "C_position": "721.5", "C_position_commanded": "721.5", "C_load": "0.00",
    "coolant_state": "ACTIVE", "door_state": "CLOSED", "spindle_load": "31.50",
    "path_feedrate": "50.0000", "spindle_speed": "8000", "feed_override": "80", "rapid_override": "50", "spindle_override": "110", "line": "12", "block": "N12 <G1> & X3",
    "tool_number": "3", "part_count": "7", "program": "part.nc",
}  # fmt: skip
STATES: dict[str, dict[str, Value]] = {
    "nothing known": {},
    "ready": {"availability": "AVAILABLE", "emergency_stop": "ARMED", "mode": "AUTOMATIC",
              "execution": "READY", "system": NORMAL},
    "active": {"execution": "ACTIVE", **MOVING},
    "held": {"execution": "FEED_HOLD", "mode": "SEMI_AUTOMATIC"},
    "completed": {"execution": "PROGRAM_COMPLETED", "path_feedrate": "0"},
    "alarm": {"execution": "STOPPED", "emergency_stop": "TRIGGERED", "mode": "MANUAL",
              "system": Condition("Fault", "hard-limit", "X < -300 & stays \x01 there")},
    "trainer's fault": {"mode": "MANUAL_DATA_INPUT",
                        "system": Condition("Warning", "friction", "of X, 900")},
}  # fmt: skip
"""What comes to be observed, state by state."""


TOOLS = (
    ToolTable(number=1),
    ToolTable(number=7, name="DRILL <6> & co", kind="drill", diameter=6.0, teeth=1, speed=4000.0),
)


@pytest.fixture(scope="module")
def schemas() -> Schemas:
    return Schemas(Path(__file__).with_name("schemas"))


def agent_in(state: str) -> Agent:
    """An agent of a machine that went through the states up to this one."""
    agent = Agent(device_of("mill & co", AXES), Clock(10.0), "made up", 200, TOOLS)
    for number, (name, values) in enumerate(STATES.items()):
        agent.observe(0.5 * number, values)
        if name == state:
            return agent
    raise AssertionError(f"no state '{state}'")


def documents(agent: Agent) -> dict[str, bytes]:
    """Everything that it can be asked for."""
    asked = {
        "current": ("current", {}),
        "current of one axis": ("current", {"path": "//Linear[@name='X']"}),
        "current as it was": ("current", {"at": "5"}),
        "sample": ("sample", {"count": "200"}),
        "sample backwards": ("sample", {"count": "-20"}),
        "sample of nothing": ("sample", {"from": str(agent.buffer.next_sequence)}),
    }
    found = {
        name: agent.answer(agent.query(request, parameters))[0]
        for name, (request, parameters) in asked.items()
    }
    found |= {
        "probe": agent.probe(),
        "assets": agent.assets({}),
        "the last asset": agent.assets({"count": "1"}),
        "assets of another kind": agent.assets({"type": "Fixture"}),
    }
    return {name: XML.written(each) for name, each in found.items()}


@pytest.mark.parametrize("state", STATES)
def test_the_documents_of_every_state_are_valid(schemas: Schemas, state: str) -> None:
    found = documents(agent_in(state))
    wrong = {name: schemas.complaints(document) for name, document in found.items()}
    assert wrong == {name: [] for name in found}


@pytest.mark.parametrize(
    ("request_name", "parameters"),
    [
        ("sample", {"from": "999999"}),
        ("sample", {"count": "none"}),
        ("current", {"at": "1", "interval": "100"}),
    ],
)
def test_documents_of_errors_are_valid(
    schemas: Schemas, request_name: str, parameters: dict[str, str]
) -> None:
    agent = agent_in("active")
    with pytest.raises(RequestError) as refused:
        agent.answer(agent.query(request_name, parameters))
    assert schemas.complaints(XML.written(agent.error(refused.value))) == []


def test_only_the_code_of_a_wrong_path_is_the_models_and_not_the_schemas(schemas: Schemas) -> None:
    agent = agent_in("active")
    with pytest.raises(RequestError) as refused:
        agent.query("current", {"path": "//["})
    (complaint,) = schemas.complaints(XML.written(agent.error(refused.value)))
    assert "INVALID_XPATH" in complaint


@pytest.mark.parametrize(
    ("valid", "broken"),
    [
        (rb' deviceModelChangeTime="[^"]*"', b""),
        (rb' instanceId="\d+"', b' instanceId="0"'),
        (rb">ACTIVE<", b">RUNNING<"),
        (rb' dataItemId="X_load"', b""),
        (rb"<Samples>", b"<Samples><Normal></Normal>"),
        (rb' timestamp="(\d+)-', rb' timestamp="\1/'),
        (rb">-12.345678<", b">12,3<"),
        (rb' assetType="CuttingTool"', b""),
        (rb' uuid="[^"]*"', b""),
        (rb' type="SYSTEM"', b""),
        (rb' subType="ABSOLUTE"', b' subType="absolute"'),
    ],
)
def test_what_is_wrong_is_found(schemas: Schemas, valid: bytes, broken: bytes) -> None:
    document = documents(agent_in("active"))["current"]
    changed, count = re.subn(valid, broken, document)
    assert count
    assert schemas.complaints(changed)


def test_numbers_and_moments_of_a_stream_hang_together() -> None:
    agent = agent_in("trainer's fault")
    began = agent.clock.at(0.0)
    text = documents(agent)["sample"].decode()
    sequences = [int(number) for number in re.findall(r' sequence="(\d+)"', text)]
    assert sorted(sequences) == list(range(sequences[0], sequences[0] + len(sequences)))
    header = dict(re.findall(r'(\w+)="([^"]*)"', text.partition("<Header ")[2].partition(">")[0]))
    assert int(header["nextSequence"]) == int(header["lastSequence"]) + 1 == max(sequences) + 1
    assert int(header["firstSequence"]) == min(sequences)
    assert header["deviceModelChangeTime"] == began
    stamps = re.findall(r' timestamp="([^"]*)"', text)
    assert min(stamps) == began
    assert {len(stamp) for stamp in stamps} == {len("2026-01-01T00:00:00.000000Z")}


def test_the_motions_of_axes_are_as_the_schemas_want_them(schemas: Schemas) -> None:
    document = XML.written(probe_of("mill5"))
    assert schemas.complaints(document) == []
    for valid, broken in ((b'="CONTINUOUS"', b'="ENDLESS"'), (b"<Axis>0 ", b"<Axis>")):
        assert schemas.complaints(re.sub(valid, broken, document, count=1))
