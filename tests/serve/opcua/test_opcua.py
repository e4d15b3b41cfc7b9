"""The machine in OPC UA: what the specification asks for is there and true, and nobody can change it."""

import asyncio
import contextlib
import socket
from collections.abc import AsyncIterator, Callable, Coroutine, Iterator
from pathlib import Path
from typing import Any

import asyncua.ua
import pytest
from asyncua.client.client import Client
from asyncua.common.events import get_filter_from_event_type

from twin.errors import UsageError
from twin.files.shipped import machine_file
from twin.machine.load import read_machine
from twin.serve.agent import Agent, Clock
from twin.serve.buffer import NORMAL, Condition
from twin.serve.device import device_of
from twin.serve.opcua.machine_tool import FOLDER, MACHINE_TOOL, MACHINERY, NAMESPACE
from twin.serve.opcua.server import Content, Endpoint, check_place, mirror

pytestmark = [
    pytest.mark.skipif(not FOLDER.is_dir(), reason="no node sets: run scripts/fetch_three.py"),
    pytest.mark.seconds("six node sets are read into a server"),
]
ua: Any = asyncua.ua
MACHINE = "mill5h"
"""X, Y, Z and the rotary axes B and C."""
EVERYWHERE = "0.0.0.0"  # noqa: S104 - to see it refused


class Served:
    """A server over an agent that the test feeds, and a client in it."""

    def __init__(self, agent: Agent, url: str, client: Client) -> None:
        self.agent, self.url, self.client = agent, url, client
        self.run: Callable[[Coroutine[Any, Any, Any]], Any] = asyncio.run

    async def node(self, *path: str) -> Any:
        spaces = {
            "m": await self.client.get_namespace_index(MACHINERY),
            "t": await self.client.get_namespace_index(MACHINE_TOOL),
            "o": await self.client.get_namespace_index(NAMESPACE),
            "0": 0,
        }
        names = ["m:Machines", f"o:{MACHINE}", *path]
        parts = [name.split(":", 1) for name in names]
        return await self.client.nodes.objects.get_child(
            [f"{spaces[space]}:{name}" for space, name in parts]
        )

    async def value(self, *path: str) -> Any:
        """The value of a node, once there is one: what was observed reaches node after node."""
        node = await self.node(*path)
        for _ in range(100):
            with contextlib.suppress(ua.uaerrors.BadWaitingForInitialData):
                return await node.read_value()
            await asyncio.sleep(0.05)
        return await node.read_value()

    async def until(self, wanted: Any, *path: str) -> None:
        for _ in range(100):
            if await self.value(*path) == wanted:
                return
            await asyncio.sleep(0.05)
        assert await self.value(*path) == wanted


@contextlib.asynccontextmanager
async def served() -> AsyncIterator[Served]:
    machine = read_machine(machine_file(MACHINE))
    agent = Agent(device_of(MACHINE, machine.axes), Clock(), "a test", 1000)
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        port = free.getsockname()[1]
    content = Content(machine, "part.nc", {1: "flat 10 mm", 7: "drill 6 mm"})
    task = asyncio.create_task(mirror(agent, Endpoint("127.0.0.1", port), content))
    url = f"opc.tcp://127.0.0.1:{port}"
    for _ in range(200):
        assert not task.done(), task.exception()
        with contextlib.suppress(OSError):
            _, writer = await asyncio.open_connection("127.0.0.1", port)
            writer.close()
            break
        await asyncio.sleep(0.1)
    try:
        async with Client(url, timeout=20) as client:
            yield Served(agent, url, client)
    finally:
        task.cancel()
        with contextlib.suppress(asyncio.CancelledError):
            await task


@pytest.fixture(scope="module")
def one() -> Iterator[Served]:
    """One server for all tests: it takes seconds to read its node sets."""
    with asyncio.Runner() as runner:
        context = served()
        found = runner.run(context.__aenter__())
        found.run = runner.run
        yield found
        runner.run(context.__aexit__(None, None, None))


def on_a_server(test: Callable[[Served], Coroutine[Any, Any, None]]) -> Callable[[Served], None]:
    def run(one: Served) -> None:
        one.run(test(one))

    run.__name__ = test.__name__
    return run


@on_a_server
async def test_the_specifications_parts_follow_what_the_agent_observed(one: Served) -> None:
    one.agent.observe(1.0, {
        "execution": "ACTIVE", "part_count": "3", "X_position": "12.5", "spindle_speed": "6000",
        "path_feedrate": "20", "line": "4", "mode": "AUTOMATIC", "feed_override": "80",
        "rapid_override": "50", "spindle_override": "110", "B_position_commanded": "-15.25",
    })  # fmt: skip
    channel = ("t:Monitoring", "o:Channel1")
    await one.until("4", *channel, "o:Line")
    await one.until(12.5, "t:Monitoring", "o:Axes", "o:X", "o:ActualPosition")
    turned = ("t:Monitoring", "o:Axes", "o:B", "o:CommandedPosition")
    await one.until(-15.25, *turned)
    assert (await one.value(*turned, "0:EngineeringUnits")).DisplayName.Text == "°"
    assert await one.value(*channel, "t:ChannelState") == 0
    await one.until(80.0, *channel, "t:FeedOverride")
    assert await one.value("t:Monitoring", "t:MachineTool", "t:FeedOverride") == 80.0
    assert await one.value(*channel, "t:RapidOverride") == 50.0
    assert await one.value("t:Monitoring", "o:Spindle", "t:Override") == 110.0
    assert await one.value(*channel, "t:ChannelMode") == 0
    assert await one.value("t:Monitoring", "o:Spindle", "t:IsRotating") is True
    job = ("t:Production", "t:ProductionPlan", "o:part.nc")
    assert await one.value(*job, "t:RunsCompleted") == 3
    state = await one.value("t:Production", "t:ActiveProgram", "t:State", "0:CurrentState")
    assert state.Text == "Running"
    tool = ("t:Equipment", "t:Tools", "o:T7")
    assert await one.value(*tool, "t:ControlIdentifier1") == 7
    one.agent.observe(1.5, {"execution": "FEED_HOLD", "mode": "MANUAL"})
    await one.until(1, *channel, "t:ChannelState")
    await one.until(2, *channel, "t:ChannelMode")
    assert await one.value("t:Monitoring", "t:MachineTool", "t:OperationMode") == 0
    state = await one.value("t:Production", "t:ActiveProgram", "t:State", "0:CurrentState")
    assert state.Text == "Interrupted"
    one.agent.observe(2.0, {"execution": "PROGRAM_COMPLETED", "spindle_speed": "0"})
    await one.until(2, *channel, "t:ChannelState")
    await one.until(False, "t:Monitoring", "o:Spindle", "t:IsRotating")


@on_a_server
async def test_what_was_never_observed_is_no_value(one: Served) -> None:
    node = await one.node("t:Monitoring", "o:Axes", "o:Y", "o:Load")
    await asyncio.sleep(0.2)
    data = await node.read_data_value(raise_on_bad_status=False)
    assert not data.StatusCode.is_good()


@on_a_server
async def test_every_mandatory_node_of_its_types_is_there(one: Served) -> None:
    async def holds(node: Any, kind: Any) -> None:
        for part in await kind.get_children():
            rules = await part.get_references(ua.ObjectIds.HasModellingRule)
            if not any(
                rule.NodeId.Identifier == ua.ObjectIds.ModellingRule_Mandatory for rule in rules
            ):
                continue
            name = await part.read_browse_name()
            found = await node.get_child([name])
            await holds(found, part)

    pending = [await one.node()]
    seen = 0
    while pending:
        node = pending.pop()
        if await node.read_node_class() == ua.NodeClass.Object:
            kind = one.client.get_node(await node.read_type_definition())
            await holds(node, kind)
            seen += 1
            pending += await node.get_children()
    assert seen > 20


class Events:
    """What a subscription is told."""

    def __init__(self) -> None:
        self.seen: list[Any] = []

    def event_notification(self, event: Any) -> None:
        self.seen.append(event)

    async def after(self, count: int) -> list[Any]:
        for _ in range(100):
            if len(self.seen) >= count:
                return self.seen
            await asyncio.sleep(0.05)
        raise AssertionError(f"{len(self.seen)} of {count} events")


FAULT = Condition("Fault", "soft-limit", "X would go to 500 mm")


@contextlib.asynccontextmanager
async def alerts(one: Served, *more: int) -> AsyncIterator[tuple[Events, Any]]:
    """A subscription of alerts, and of other events by their identifiers."""
    events = Events()
    space = await one.client.get_namespace_index(MACHINE_TOOL)
    subscription = await one.client.create_subscription(50, events)
    kinds = [
        one.client.get_node(ua.NodeId(39, space)),
        *map(one.client.get_node, map(ua.NodeId, more)),
    ]
    await subscription.subscribe_events(one.client.nodes.server, kinds)
    yield events, subscription
    await subscription.delete()


@on_a_server
async def test_an_alarm_is_a_condition_that_ends(one: Served) -> None:
    async with alerts(one) as (events, _):
        one.agent.observe(1.0, {"system": NORMAL})
        one.agent.observe(2.0, {"system": FAULT})
        await events.after(1)
        condition = ("t:Notification", "t:Messages", "o:System")
        assert await one.value(*condition, "0:ActiveState", "0:Id") is True
        assert await one.value(*condition, "t:ErrorCode") == "soft-limit"
        one.agent.observe(3.0, {"system": NORMAL})
        began, ended = await events.after(2)
    assert (began.ErrorCode, began.Message.Text) == ("soft-limit", "X would go to 500 mm")
    assert (began.Severity, began.Retain) == (800, True)
    assert (began.ActiveState.Text, ended.ActiveState.Text) == ("Active", "Inactive")
    assert (ended.ErrorCode, ended.Retain) == ("soft-limit", False)
    node = await one.node(*condition)
    assert began.NodeId == ended.NodeId == node.nodeid
    await one.until(False, *condition, "0:ActiveState", "0:Id")


@on_a_server
async def test_who_comes_later_asks_for_the_condition_that_stands(one: Served) -> None:
    start, end = ua.ObjectIds.RefreshStartEventType, ua.ObjectIds.RefreshEndEventType
    one.agent.observe(4.0, {"system": FAULT})
    await one.until(True, "t:Notification", "t:Messages", "o:System", "0:ActiveState", "0:Id")
    async with alerts(one, start, end) as (events, subscription):
        conditions = one.client.get_node(ua.ObjectIds.ConditionType)
        number = ua.Variant(subscription.subscription_id, ua.VariantType.UInt32)
        await conditions.call_method("0:ConditionRefresh", number)
        first, standing, last = await events.after(3)
        one.agent.observe(5.0, {"system": NORMAL})
        await events.after(4)
        await conditions.call_method("0:ConditionRefresh", number)
        kinds = [each.EventType.Identifier for each in (await events.after(6))[4:]]
    assert [first.EventType.Identifier, last.EventType.Identifier] == [start, end]
    assert (standing.ErrorCode, standing.Retain) == ("soft-limit", True)
    assert kinds == [start, end], "nothing stands any more"


@on_a_server
async def test_a_filter_by_a_type_holds_its_subtypes(one: Served) -> None:
    """As node-opcua's and UaExpert's: all that can be acknowledged, or no alarm at all."""
    told: dict[int, Events] = {}
    asked = ua.ObjectIds.AcknowledgeableConditionType, ua.ObjectIds.DialogConditionType
    for kind in asked:
        found = await get_filter_from_event_type([one.client.get_node(kind)])
        is_of = ua.ContentFilterElement(
            ua.FilterOperator.OfType, [ua.LiteralOperand(ua.Variant(ua.NodeId(kind)))]
        )
        found.WhereClause = ua.ContentFilter([is_of])
        told[kind] = Events()
        subscription = await one.client.create_subscription(50, told[kind])
        await subscription.subscribe_events(one.client.nodes.server, evfilter=found)
    one.agent.observe(20.0, {"system": FAULT})
    await told[asked[0]].after(1)
    one.agent.observe(21.0, {"system": NORMAL})
    await told[asked[0]].after(2)
    assert told[asked[1]].seen == []


@on_a_server
async def test_a_trainers_fault_is_a_condition_of_less_weight(one: Served) -> None:
    async with alerts(one) as (events, _):
        warning = Condition("Warning", "friction", "of X, 900")
        for number, condition in enumerate((warning, FAULT, warning, NORMAL), 1):
            one.agent.observe(5.0 + number, {"system": condition})
            await events.after(number)
    told = [(each.ErrorCode, each.Severity, each.Retain) for each in events.seen]
    alarm, less = ("soft-limit", 800, True), ("friction", 400, True)
    assert told == [less, alarm, less, ("friction", 1, False)]


@on_a_server
async def test_nobody_changes_a_bit(one: Served) -> None:
    position = await one.node("t:Monitoring", "o:Axes", "o:X", "o:ActualPosition")
    machine = await one.node()
    for attack in (
        position.write_value(1.0),
        machine.add_folder(1, "mine"),
        machine.delete(),
        position.set_writable(),
    ):
        with pytest.raises(ua.UaError):
            await attack
    for name in ("admin", "Admin", "root"):
        other = Client(one.url, timeout=10)
        other.set_user(name)
        other.set_password("x")
        with pytest.raises((ua.UaError, OSError)):
            async with other:
                pass


@on_a_server
async def test_nonsense_at_the_port_leaves_clients_alone(one: Served) -> None:
    port = int(one.url.rpartition(":")[2])
    header = b"HELF\xff\xff\xff\x7f"
    for nonsense in (b"", b"GET / HTTP/1.1\r\n\r\n", b"\0" * 4096, header, header + b"A" * 70000):
        reader, writer = await asyncio.open_connection("127.0.0.1", port)
        writer.write(nonsense)
        with contextlib.suppress(OSError):
            await writer.drain()
            writer.write_eof()
        with contextlib.suppress(OSError, TimeoutError):
            await asyncio.wait_for(reader.read(1000), 2.0)
        writer.close()
    assert (
        await one.value("t:Production", "t:ProductionPlan", "o:part.nc", "t:Identifier")
        == "part.nc"
    )


def test_without_certificates_only_this_computer_is_served(tmp_path: Path) -> None:
    with pytest.raises(UsageError, match="--opcua-trust"):
        check_place(Endpoint(EVERYWHERE, 4840))
    with pytest.raises(UsageError, match="no folder"):
        check_place(Endpoint(EVERYWHERE, 4840, tmp_path / "none"))
    check_place(Endpoint(EVERYWHERE, 0, tmp_path))
    with socket.socket() as taken:
        taken.bind(("127.0.0.1", 0))
        taken.listen()
        with pytest.raises(UsageError, match="in use"):
            check_place(Endpoint("127.0.0.1", taken.getsockname()[1]))
