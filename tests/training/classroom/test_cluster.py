"""Rooms of a class over the nodes of a Ray cluster: they run on both, answer who has their secret, and end."""

import asyncio
import contextlib
import functools
import http.client
import json

import pytest

from twin.training.classroom.door import HEADER, Door
from twin.training.classroom.hosts import ClusterHost
from twin.training.classroom.marks import ClassFile
from twin.training.classroom.rooms import Rooms, Seat
from twin.training.classroom.roster import Pupil

pytestmark = [
    pytest.mark.processes,
    pytest.mark.by_hand("two nodes of Ray and four rooms take minutes and 2 GB beside other tests"),
]
PATIENCE_S = 60.0


@pytest.fixture
def address(monkeypatch):
    """A cluster of two nodes, both on this computer."""
    pytest.importorskip("ray", reason="the extra 'cluster' is not installed")
    from ray.cluster_utils import Cluster

    monkeypatch.setenv("RAY_DISABLE_IMPORT_WARNING", "1")
    cluster = Cluster(
        initialize_head=True, head_node_args={"num_cpus": 1, "include_dashboard": False}
    )
    cluster.add_node(num_cpus=1)
    yield cluster.address
    cluster.shutdown()


def asked(door: Door, secret: str) -> tuple[int, bytes]:
    with contextlib.closing(door.connection()) as line:
        line.request("GET", "/operator/scene.json", headers={HEADER: secret})
        answer: http.client.HTTPResponse = line.getresponse()
        return answer.status, answer.read()


async def streamed(door: Door) -> dict:
    async with door.stream("/trainer/stream") as line:
        while True:
            said = await asyncio.wait_for(line.recv(), PATIENCE_S)
            if isinstance(said, str):
                return json.loads(said)


async def played(rooms: Rooms, seats: list[Seat]) -> None:
    for seat in seats:
        door = await rooms.opened(seat)
        status, scene = await asyncio.to_thread(asked, door, door.secret)
        assert (status, json.loads(scene)["name"]) == (200, "fagor_first_steps")
        assert (await asyncio.to_thread(asked, door, "guessed"))[0] == 403
        assert (await streamed(door))["mode"] == "auto"
    assert len({seat.node for seat in seats}) == 2, "the rooms are on both nodes"
    rooms.hand_out(seats[0], "fanuc_missing_point")
    for seat in seats:
        rooms.say(seat, {"do": "inject", "fault": {"kind": "alarm"}})
    end = asyncio.get_running_loop().time() + PATIENCE_S
    while any(seat.status.get("alarm") != "external" for seat in seats[1:]) or seats[0].status.get("scene") != "fanuc_missing_point":  # fmt: skip
        assert asyncio.get_running_loop().time() < end, [seat.status for seat in seats]
        await asyncio.sleep(0.1)
    process = seats[1].process
    assert process is not None
    await asyncio.to_thread(functools.partial(rooms.end, seats[1]))
    assert not process.is_alive()
    # Who comes back has a room again.
    await rooms.opened(seats[1])


def test_rooms_run_on_both_nodes(address, tmp_path):
    pupils = tuple(Pupil(name, "") for name in ("Anna", "Bob"))
    rooms = Rooms(pupils, "fagor_first_steps", None, ClassFile(tmp_path), ClusterHost(address))
    try:
        asyncio.run(played(rooms, list(rooms.seats.values())))
    finally:
        rooms.close()
