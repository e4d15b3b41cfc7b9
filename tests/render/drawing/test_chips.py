"""Chips: none in the air, more where more is removed, around the tool and above its tip."""

import dataclasses

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from twin.job.job_file import StockTable
from twin.render.drawing.canvas import DRAFT
from twin.render.drawing.chips import FLIGHT_S, GRAVITY, MOST, RISE, SPEED, chips
from twin.render.scene.scene import RenderScene
from twin.render.scene.stage import stage

TIP = np.array([0.3, -0.2, 0.9])
DIAMETER = 0.01


def test_air_gives_none_and_the_most_is_bounded() -> None:
    assert len(chips(TIP, DIAMETER, 0.0, 1).position) == 0
    counts = [len(chips(TIP, DIAMETER, rate, 1).position) for rate in (0.1, 10.0, 100.0, 1e9)]
    assert counts == sorted(set(counts))
    assert counts[-1] == MOST


@given(st.integers(0, 2**40), st.floats(1e-3, 1e6))
def test_chips_lie_within_their_flight(seed: int, rate: float) -> None:
    flying = chips(TIP, DIAMETER, rate, seed)
    off = flying.position - TIP
    reach = 0.5 * DIAMETER + SPEED[1] * FLIGHT_S
    assert np.all(np.hypot(off[:, 0], off[:, 1]) <= reach + 1e-12)
    assert np.all(off[:, 2] <= SPEED[1] * RISE[1] * FLIGHT_S)
    assert np.all(off[:, 2] >= -0.5 * GRAVITY * FLIGHT_S**2)
    turned = flying.rotation @ flying.rotation.transpose(0, 2, 1)
    assert np.allclose(turned, np.eye(3), atol=1e-12)
    again = chips(TIP, DIAMETER, rate, seed)
    assert np.array_equal(again.position, flying.position)


def test_chips_are_seen_while_stock_is_cut_and_only_then(scene: RenderScene) -> None:
    assert scene.stock is not None
    far = StockTable(shape="box", size=(10.0, 10.0, 5.0), position=(400.0, 0.0, 0.0))
    bright = []
    for stock in (scene.stock, far):
        with stage(dataclasses.replace(scene, stock=stock), (320, 240), DRAFT) as play:
            for samples in scene.recording.chunks():
                play.advance(samples[:700])
                break
            picture = play.picture("top").astype(int)
            with_none = play._drawing.draw(play.data, int(play.model.camera("top").id))
            bright.append(int((np.abs(picture - with_none).sum(axis=2) > 30).sum()))
    assert bright[0] > 3
    assert bright[1] == 0
