"""A class of six in a real browser: two scenes each, one who leaves and comes back, a server that is restarted."""

import re
from pathlib import Path

import pytest
from class_server import ClassServer, until
from panel_player import PATIENCE_S, browser, without_view

from twin.training.classroom.marks import ClassFile

pytestmark = pytest.mark.browser
NAMES = ["Anna", "Bob <i>x</i>", "Čeněk", "Дарья", "Emma, jr.", "=F"]
AXE = Path(__file__).resolve().parents[3] / ".axe" / "axe.min.js"
FINDINGS = """async () => (await axe.run()).violations
  .map((one) => `${one.id}: ${one.nodes.map((node) => node.html).join(" ")}`)"""


def opened(context, address: str):
    page = context.new_page()
    page.set_default_timeout(1e3 * PATIENCE_S)
    place, token = address.split("#")
    page.goto(f"{place}?language=en#{token}")
    page.wait_for_selector("body[data-ready=yes]")
    return page


def hand_in(page) -> None:
    page.click("[data-key='tab tasks']")
    page.click("[data-key=finish]")
    page.click("[data-key='finish yes']")
    page.wait_for_selector("#score:not([hidden])")


def row(teacher, name: str) -> str:
    return teacher.locator("#seats tr", has=teacher.locator("th", has_text=name)).inner_text()


def test_no_mark_is_lost_and_the_teachers_page_is_right(tmp_path):
    roster, out = tmp_path / "roster.csv", tmp_path / "class"
    roster.write_text("name\n" + "\n".join(f'"{name}"' for name in NAMES), encoding="utf-8")
    server = ClassServer(roster, out)
    try:
        with browser() as chromium:
            contexts = {name: chromium.new_context(bypass_csp=True) for name in ["teacher", *NAMES]}
            for context in contexts.values():
                without_view(context)
            teacher = opened(contexts["teacher"], server.links["teacher"])
            if AXE.is_file():
                teacher.add_script_tag(path=AXE)
                assert teacher.evaluate(FINDINGS) == []
            pages = {name: opened(contexts[name], server.links[name]) for name in NAMES}
            for name, page in pages.items():
                page.click("[data-key=cycle_start]")
                until(lambda name=name: "RUNNING" in row(teacher, name), f"{name} runs")
            teacher.click("[data-key=hold]")
            for page in pages.values():
                page.wait_for_selector("#state-chip >> text=FROZEN")
            teacher.click("[data-key='go on']")
            pages["Anna"].click("#emergency")
            until(lambda: "ALARM" in row(teacher, "Anna"), "the alarm")
            # One leaves and comes back: his room has waited.
            attempt = pages["=F"].inner_text("#clock").split()[0]
            pages["=F"].close()
            until(lambda: "page closed" in row(teacher, "=F"), "who has left")
            pages["=F"] = opened(contexts["=F"], server.links["=F"])
            assert float(pages["=F"].inner_text("#clock").split()[0]) > float(attempt)
            for page in pages.values():
                hand_in(page)
            before = server.links
            server.stop()
            server = ClassServer(roster, out)
            assert server.links == before
            # Pages that were open find their rooms again, without a link.
            for name, page in pages.items():
                page.wait_for_selector("body[data-line=up]")
                page.wait_for_selector("[data-key=finish]", state="attached")
                until(
                    lambda name=name: re.search(r"First steps: \d+/10", row(teacher, name)),
                    "the mark",
                )
            teacher.on("dialog", lambda dialog: dialog.accept())
            teacher.select_option("[data-key=scene]", "codesys_opening_angle")
            teacher.click("[data-key='hand out']")
            for page in pages.values():
                page.wait_for_selector("#control >> text=CODESYS")
                page.wait_for_selector("body[data-ready=yes]")
                hand_in(page)
            for name in NAMES:
                until(
                    lambda name=name: len(re.findall(r": \d+/\d+", row(teacher, name))) == 2, "two"
                )
    finally:
        server.stop()
    marks = [(one.pupil, one.scene) for one in ClassFile(out).marks() if one.handed_in]
    wanted = [
        (name, scene) for name in NAMES for scene in ("codesys_opening_angle", "fagor_first_steps")
    ]
    assert sorted(marks) == sorted(wanted)
