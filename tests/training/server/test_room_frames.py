"""What pages are sent."""

import dataclasses
import json
import struct
import zlib

import numpy as np

from twin.cutting.heights.patches import LEVELS
from twin.training.room.run_settings import path_to_come
from twin.training.room.setup.live_cut import SliceLoads
from twin.training.scene.scene_file import read_scene, scene_path
from twin.training.server.app import RoomApp
from twin.training.server.attempts import CELLS_ACROSS
from twin.training.server.connections import MESSAGES, MOST_PAGES, Connections
from twin.training.server.driver import Driver
from twin.training.server.frames import (
    Changes,
    StockFeed,
    as_texts,
    panel_words,
    path_message,
    state_message,
)
from twin.training.session.session import SceneSession


def heights(message: bytes) -> tuple[slice, slice, np.ndarray]:
    kind, epoch, row, column, rows, columns = struct.unpack("<BxxxIHHHH", message[:16])
    assert kind == 2
    assert epoch > 0
    levels = np.frombuffer(zlib.decompress(message[16:]), "<u2", rows * columns)
    levels = levels.reshape(rows, columns)
    return slice(row, row + rows), slice(column, column + columns), levels


def tools(message: bytes | None) -> set[int]:
    """Numbers of the tools that have cut the cells of a patch."""
    assert message is not None
    rows, columns = struct.unpack("<HH", message[12:16])
    return set(zlib.decompress(message[16:])[2 * rows * columns :])


def test_a_page_that_follows_has_the_stock_as_it_is_cut():
    scene = dataclasses.replace(
        read_scene(scene_path("fagor_first_steps")), cells_across=CELLS_ACROSS
    )
    session = SceneSession(scene)
    room, feed = session.room, StockFeed()
    assert room.setup.work is not None
    stock = room.setup.work.map
    assert stock is not None
    shown = np.zeros(stock.heights.shape)
    assert min(shown.shape) >= 400
    session.submit({"do": "cycle_start"})
    epoch = version = -1
    sizes = []
    for _ in range(60):
        session.advance(10)
        feed.note(room)
        message, epoch, version = feed.patch(epoch, version)
        if message is not None:
            rows, columns, levels = heights(message)
            shown[rows, columns] = levels / LEVELS
            sizes.append(len(message))
    there = (stock.heights - stock.bottom) / (stock.top - stock.bottom)
    assert room.setup.work.removed > 0.0
    assert np.abs(shown - there).max() <= 0.51 / LEVELS
    assert max(sizes[1:]) < 20_000
    # A page that comes late, and one that sees the machine taken back, get the whole stock.
    assert heights(feed.patch(-1, -1)[0] or b"")[2].shape == shown.shape
    assert tools(feed.patch(-1, -1)[0]) == {0, room.setup.tables.spindle}
    session.rewind(100.0)
    feed.note(session.room)
    assert tools(feed.patch(-1, -1)[0]) == {0}
    assert (heights(feed.patch(epoch, version)[0] or b"")[2] == LEVELS).all()


def test_words_are_sent_when_they_change():
    driver = Driver(SceneSession(read_scene(scene_path("fagor_first_steps"))))
    changes = Changes()
    first = json.loads(changes.since_last(as_texts(panel_words(driver.look))))
    assert {"program", "mode", "alarm", "verdicts"} <= set(first)
    assert changes.since_last(as_texts(panel_words(driver.look))) == ""
    driver.ask({"do": "mode", "mode": "jog"}, "operator", 1)
    driver._step(0.01)
    assert changes.since_last(as_texts(panel_words(driver.look))) == '{"mode":"jog"}'
    assert len(state_message(driver.look, cutting=False)) == 8 + 8 * (7 + 5 * 4 + len(SliceLoads()))


def test_a_typing_error_in_mdi_is_told_in_every_language():
    driver = Driver(SceneSession(read_scene(scene_path("gost_part_zero"))))
    for command in (
        {"do": "mode", "mode": "mdi"},
        {"do": "mdi", "text": "G0 G77"},
        {"do": "cycle_start"},
    ):
        driver.ask(command, "operator", 1)
        driver._step(0.01)
    driver._shown = -1.0
    driver._step(0.2)
    words = RoomApp._translated(panel_words(driver.look))
    message = words["alarm"]["message"]
    assert words["alarm"]["code"] == "program"
    assert message["en"] == "unknown-g: G77 is unknown to gost"
    assert [message[language].split(" - ")[0] for language in ("ru", "it", "cs")] == ["«G77»"] * 3


def test_the_panel_is_asked_for_and_given():
    connections = Connections()
    first, second, trainer = (
        connections.open("operator"),
        connections.open("operator"),
        connections.open("trainer"),
    )
    watcher = connections.open("watcher")
    assert first is not None
    assert second is not None
    assert trainer is not None
    assert watcher is not None
    start, stop = {"do": "cycle_start"}, {"do": "emergency_stop"}
    assert [connections.allows(one, start) for one in (first, second, trainer, watcher)] == [True, False, True, False]  # fmt: skip
    assert [connections.allows(one, stop) for one in (first, second, trainer, watcher)] == [True, True, True, False]  # fmt: skip
    assert not connections.allows(second, stop | {"pressed": False})
    for what in ("give", "keep"):
        connections.hand_over(second, what)
    connections.hand_over(watcher, "ask")
    connections.hand_over(second, "ask")
    assert connections.allows(first, start)
    assert connections.words(first)["somebody_asks"]
    connections.hand_over(first, "keep")
    assert not connections.words(first)["somebody_asks"]
    connections.hand_over(second, "ask")
    connections.hand_over(first, "give")
    assert [connections.allows(one, start) for one in (first, second)] == [False, True]
    connections.close(second)
    assert connections.allows(first, start)


def test_there_is_an_end_to_pages_and_to_what_one_may_say():
    connections = Connections()
    pages = [connections.open("watcher") for _ in range(MOST_PAGES + 1)]
    assert pages[-1] is None
    # Watchers leave connections for who acts.
    acting = [connections.open("operator") for _ in range(MOST_PAGES + 1)]
    assert sum(page is not None for page in pages + acting) == MOST_PAGES
    assert acting[0] is not None
    assert connections.allows(acting[0], {"do": "cycle_start"})
    page = pages[0]
    assert page is not None
    assert sum(page.within_rate_limit() for _ in range(10_000)) < 2 * MESSAGES


def test_a_path_is_a_head_and_then_its_points():
    session = SceneSession(read_scene(scene_path("fagor_first_steps")))
    preview = path_to_come(session.room).drawn()
    message = path_message(preview, {"en": "a word", "cs": "slovíčko"})
    (length,) = struct.unpack("<I", message[:4])
    head = json.loads(message[4 : 4 + length])
    assert length % 4 == 0
    assert (head["moves"], head["complete"], head["message"]["cs"]) == (
        preview.moves,
        True,
        "slovíčko",
    )
    points = np.frombuffer(message, "<f4", 3 * head["points"], 4 + length)
    rapid = np.frombuffer(message, "u1", -1, 4 + length + points.nbytes)
    assert np.array_equal(points.reshape(-1, 3), preview.points)
    assert np.array_equal(rapid.astype(bool), preview.rapid)


def test_the_machine_answers_between_two_slices_and_outlives_a_question_that_fails():
    driver = Driver(SceneSession(read_scene(scene_path("fagor_first_steps"))))
    tick, failing = driver.inquire(lambda room: room.tick), driver.inquire(lambda _room: 1 / 0)
    assert not tick.done()
    driver._step(0.0)
    assert tick.result() == 0
    assert isinstance(failing.exception(), ZeroDivisionError)
    assert driver.session.room.alarm is None
