"""A class of the real command: rooms begin and end, marks stay, and nobody gets into another's room."""

import json
import os
import signal
import sys
import urllib.error
from pathlib import Path

import pytest
from class_server import ClassServer, class_server, stream, until

from twin.training.classroom.marks import ClassFile

pytestmark = [
    pytest.mark.processes,
    pytest.mark.skipif(sys.platform != "linux", reason="looks for processes in /proc"),
    pytest.mark.three_js,
]

NAMES = ("Anna", "<b>Bob</b>", "../teacher")


@pytest.fixture(scope="module")
def roster(tmp_path_factory):
    path = tmp_path_factory.mktemp("roster") / "roster.csv"
    path.write_text("\n".join(NAMES), encoding="utf-8")
    return path


@pytest.fixture(scope="module")
def school(roster, tmp_path_factory):
    with class_server(roster, tmp_path_factory.mktemp("class")) as server:
        yield server


def seat_of(name: str, told: dict) -> dict:
    return next(seat for seat in told["seats"] if seat["name"] == name)


def test_the_teacher_sees_holds_and_hands_out(school):
    with stream(school, "Anna") as pupil, stream(school, "teacher") as teacher:
        pupil.until(lambda told: told["mode"] == "auto", "a room")
        assert pupil.told["signature"] in ("", "Anna")
        pupil.say(do="cycle_start")
        room = teacher.until(lambda told: seat_of("Anna", told)["room"], "the pupil's room")
        assert (room["scene"], room["of"], room["pages"]) == ("fagor_first_steps", 10, 1)
        assert seat_of("<b>Bob</b>", teacher.told)["room"] is None
        key = school.role("Anna")
        teacher.say(do="hold", seats=[key])
        pupil.until(lambda told: told["frozen"], "the hold")
        pupil.say(do="go_on")
        pupil.until(lambda told: told["refusals"], "a refusal: that is the teacher's")
        teacher.say(do="go_on", seats=[key])
        pupil.until(lambda told: not told["frozen"], "the end of the hold")
        attempt = pupil.told["attempt"]
        teacher.say(do="hand_out", seats=[key], scene="mefi_lead")
        pupil.until(lambda told: told["attempt"] != attempt, "the scene that was handed out")
        teacher.until(
            lambda told: seat_of("Anna", told)["room"]["scene"] == "mefi_lead", "the scene"
        )
        for wrong in (
            {"do": "hand_out", "seats": [key], "scene": "/etc/passwd"},
            {"do": "hold", "seats": ["seat-99"]},
            {"do": "end"},
            {"do": "hold", "seats": "all"},
        ):
            teacher.told.pop("refused", None)
            teacher.say(**wrong)
            teacher.until(lambda told: told.get("refused"), f"a refusal of {wrong}")
        assert school.get(f"/teacher/{key}/scene.json", school.enter("teacher"))[0] == 200


def test_nobody_gets_into_anothers_room_or_is_the_teacher(school):
    anna, bob = school.role("Anna"), school.role("<b>Bob</b>")
    cookie = school.enter("Anna")
    for path in (
        f"/{bob}/scene.json", f"/{bob}/stream", "/teacher/class.json", "/teacher/marks.csv", "/teacher/stream",
        f"/teacher/{anna}/scene.json", f"/{anna}/../teacher/class.json", f"/{anna}/%2e%2e/teacher/marks.json",
        f"/{anna}/../{bob}/scene.json", "/operator/scene.json",
    ):  # fmt: skip
        assert school.get(path, cookie)[0] in (401, 404), path
    for path in (
        "trainer/scene.json", "../trainer/scene.json", "%2e%2e/trainer/scene.json", "words/..%2f..%2ftrainer%2fscene.json",
        "words/xx.json", "marks.csv", "page/..%2f..%2flaunch.py", "page/%2e%2e/app.py", "view/../../server.py",
    ):  # fmt: skip
        assert school.get(f"/{anna}/{path}", cookie)[0] in (401, 404), path
    forged = cookie.replace(anna, bob)
    assert school.get(f"/{bob}/scene.json", forged)[0] == 401
    for token in (school.links["<b>Bob</b>"].split("#")[1], "", "\x00", "a" * 5000):
        with pytest.raises(urllib.error.HTTPError, match=r"401|429"):
            school.enter("Anna", token)
    for query in ("?tool=1%0d%0aX: y", "?tool=\u00e9".encode().decode("latin-1"), "?tool=-1"):
        status = (
            school.get(f"/{anna}/machine.json{query.replace(' ', '%20')}", cookie)[0]
            if query.isascii()
            else 404
        )
        assert status == 404, query


def test_two_browsers_with_one_link_share_the_room_and_one_has_the_panel(school):
    with stream(school, "<b>Bob</b>") as first, stream(school, "<b>Bob</b>") as second:
        first.until(lambda told: told.get("has_panel"), "the panel")
        second.until(lambda told: told.get("has_panel") is False, "no panel")
        second.say(do="cycle_start")
        second.say(panel="ask")
        first.until(lambda told: told["somebody_asks"], "a question")
        assert first.told["running"] == ""
        first.say(panel="give")
        second.until(lambda told: told["has_panel"], "the panel")
        second.say(do="cycle_start")
        first.until(lambda told: told["running"] == "program", "the same machine")


def handed_in(server: ClassServer, name: str) -> None:
    """Come, ask for a hint, hand in."""
    with stream(server, name) as page:
        page.until(lambda told: "over" in told, "a room")
        page.say(do="hint")
        page.until(lambda told: told["hints"] == 1, "a hint")
        page.say(do="finish")
        page.until(lambda told: told["over"], "the hand-in")


def test_marks_and_links_outlive_the_server_and_a_room_that_is_killed(roster, tmp_path):
    server = ClassServer(roster, tmp_path)
    cookie = server.enter("Anna")
    try:
        handed_in(server, "Anna")
        (room,) = server.rooms()
        os.kill(room, signal.SIGKILL)
        until(lambda: not server.rooms(), "the room's end")
        handed_in(server, "../teacher")
        (room,) = server.rooms()
    finally:
        server.stop(signal.SIGKILL)
    until(lambda: not Path(f"/proc/{room}").exists(), "the end of a room whose class is gone")
    again = ClassServer(roster, tmp_path)
    try:
        assert again.links == server.links
        assert again.get(f"/{again.role('Anna')}/scene.json", cookie)[0] == 200
        status, text = again.get("/teacher/marks.json", again.enter("teacher"))
        assert status == 200
        names = [one["actor"]["account"]["name"] for one in json.loads(text)]
        assert names == ["../teacher", "Anna"]
    finally:
        assert again.stop() == 0
    assert [one.handed_in for one in ClassFile(tmp_path).marks()] == [True, True]
    assert all(Path(one.sheet).is_relative_to(tmp_path) for one in ClassFile(tmp_path).marks())
