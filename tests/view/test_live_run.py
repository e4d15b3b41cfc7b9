"""A run that goes on, on the page of a recorded one."""

import numpy as np
import pytest
from panel_player import browser
from test_view import JOB, PROGRAM

from twin.run.preparing.preparation import prepare
from twin.run.run import Run
from twin.view.app import open_view
from twin.view.live_run import LiveRun, MachineMoment


@pytest.mark.browser
def test_a_machine_that_moves_is_shown_where_it_is(tmp_path):
    (tmp_path / "square.nc").write_text(PROGRAM, encoding="utf-8")
    (tmp_path / "square.toml").write_text(JOB, encoding="utf-8")
    run = Run(prepare(tmp_path / "square.toml"))
    place = run.part_zero + np.array([3.0, 0.0, 5.0, 0.0])
    moments = [MachineMoment(0.5, 3, place)]
    live = LiveRun(run.preparation, lambda: moments[-1])
    wrong: list[str] = []
    with open_view(live, now=live.now) as address, browser() as opened:
        page = opened.new_page(viewport={"width": 1100, "height": 800})
        page.on("console", lambda message: wrong.append(message.text))
        page.goto(address)
        page.wait_for_selector("body[data-ready=yes]")
        page.wait_for_selector("body[data-view=ready]")
        page.wait_for_selector("body[data-line='3']")
        assert "3.000" in page.inner_text("#axes")
        moments.append(MachineMoment(1.25, 5, place + np.array([17.0, 0.0, 0.0, 0.0])))
        page.wait_for_selector("body[data-line='5']")
        assert "20.000" in page.inner_text("#axes")
        assert page.inner_text("#clock") == "1.250 s"
        assert not page.locator("#time").is_visible()
        assert not page.locator("#play").is_visible()
        page.screenshot(path=tmp_path / "live.png")
    assert not wrong
