import hypothesis
import hypothesis.strategies as st
import numpy as np
import pytest

from twin.recording.reader import Recording
from twin.render.frames import deal, frame_ends


@hypothesis.settings(derandomize=True, max_examples=50)
@hypothesis.given(st.integers(1, 10_000), st.integers(1, 500))
def test_frames_rise_to_the_end(count: int, frames: int) -> None:
    ends = frame_ends(count, frames)
    assert len(ends) == frames
    assert ends[-1] == count
    assert ends[0] >= 1
    assert np.all(np.diff(ends) >= 0)


@pytest.mark.parametrize("frames", [1, 7, 1001, 1500])
def test_every_sample_is_dealt_once(
    recording: Recording, frames: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    whole = recording.column("time")
    chunks = recording.chunks
    monkeypatch.setattr(recording, "chunks", lambda: chunks(rows=130))
    ends = frame_ends(len(recording), frames)
    dealt = list(deal(recording, ends))
    np.testing.assert_array_equal(
        np.concatenate([samples.setpoint.time for samples, _ in dealt]), whole
    )
    behind = np.cumsum([len(samples) for samples, _ in dealt])
    np.testing.assert_array_equal(behind[[due for _, due in dealt]], ends)


def test_dealing_stops_at_the_last_frame(recording: Recording) -> None:
    dealt = list(deal(recording, np.array([3, 3, 10])))
    assert [len(samples) for samples, _ in dealt] == [3, 0, 7]
