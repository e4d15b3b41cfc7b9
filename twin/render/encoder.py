"""Frames into an MP4 file: H.264 in yuv420p, which every player and browser shows."""

import collections
import concurrent.futures
import contextlib
from collections.abc import Callable, Iterator
from pathlib import Path

import av
import numpy as np
from av.codec.codec import UnknownCodecError
from av.error import FFmpegError

from twin.errors import RenderError
from twin.files import complete_or_absent
from twin.render.canvas import Pixels
from twin.render.doctor import H264_ENCODER, missing_encoder

QUALITY_CRF = "19"
"""Constant rate factor: 0 is lossless, 23 the encoder's default, 18 looks lossless."""

_WAITING = 6
"""Frames that may wait for the encoder; the drawing waits for it beyond that."""

Frame = Callable[[], Pixels]
"""Makes the pixels of a frame, shape (height, width, 3); called in the encoder's thread."""


class VideoWriter:
    """Encodes frames in a thread of its own; open it with ``video_writer``."""

    def __init__(self, path: Path, size: tuple[int, int], fps: int) -> None:
        self._container = av.open(str(path), "w", options={"movflags": "+faststart"})
        self._stream = self._container.add_stream(H264_ENCODER, rate=fps)
        self._stream.width, self._stream.height = size
        self._stream.pix_fmt = "yuv420p"
        self._stream.options = {"crf": QUALITY_CRF, "preset": "veryfast"}
        self._thread = concurrent.futures.ThreadPoolExecutor(1, "encoder")
        self._waiting: collections.deque[concurrent.futures.Future[None]] = collections.deque()

    def write(self, frame: Frame) -> None:
        """Add a frame after the last one.

        Raises:
            OSError, FFmpegError: An earlier frame could not be encoded or written.
        """
        while len(self._waiting) >= _WAITING:
            self._waiting.popleft().result()
        self._waiting.append(self._thread.submit(self._encode, frame))

    def finish(self) -> None:
        """Write what waits, and the end of the file.

        Raises:
            OSError, FFmpegError: Something could not be encoded or written.
        """
        for future in self._waiting:
            future.result()
        self._container.mux(self._stream.encode(None))
        self._container.close()

    def give_up(self) -> None:
        """End the thread, whatever waits, and close the file."""
        self._thread.shutdown(cancel_futures=True)
        with contextlib.suppress(OSError, FFmpegError):
            self._container.close()

    def _encode(self, frame: Frame) -> None:
        pixels = np.ascontiguousarray(frame())
        self._container.mux(self._stream.encode(av.VideoFrame.from_ndarray(pixels, "rgb24")))


@contextlib.contextmanager
def video_writer(path: Path, size: tuple[int, int], fps: int) -> Iterator[VideoWriter]:
    """Open a video; it appears under ``path`` when the block ends without error.

    Args:
        path: An ``.mp4`` file.
        size: Width and height, both even [px].
        fps: Frames per second.

    Raises:
        RenderError: There is no encoder, or the file cannot be written.
    """
    try:
        with complete_or_absent(path) as temporary:
            writer = VideoWriter(temporary, size, fps)
            try:
                yield writer
                writer.finish()
            finally:
                writer.give_up()
    except UnknownCodecError as error:
        raise RenderError(missing_encoder()) from error
    except (OSError, FFmpegError) as error:
        raise RenderError(f"{path}: the video cannot be written: {error.strerror}") from error
