"""Frames into a video file: MP4 (H.264 in yuv420p plays everywhere), or GIF or WebP for a page."""

import collections
import concurrent.futures
import contextlib
import dataclasses
from collections.abc import Callable, Iterator, Mapping
from fractions import Fraction
from pathlib import Path

import av
import numpy as np
from av.codec.codec import UnknownCodecError
from av.error import FFmpegError
from av.filter import Graph

from twin.errors import RenderError
from twin.files.atomic import complete_or_absent
from twin.render.doctor import H264_ENCODER, missing_encoder
from twin.render.drawing.canvas import Pixels


@dataclasses.dataclass(frozen=True, slots=True)
class Format:
    """How a kind of file is encoded.

    Attributes:
        palette: Whether it shows 256 colours at a time.
    """

    encoder: str
    pixels: str
    encoder_options: Mapping[str, str]
    file_options: Mapping[str, str]
    palette: bool = False


FORMATS = {
    # Rate factor 0 is lossless, 23 the encoder's default, 18 looks lossless.
    ".mp4": Format(
        H264_ENCODER, "yuv420p", {"crf": "19", "preset": "veryfast"}, {"movflags": "+faststart"}
    ),
    ".gif": Format("gif", "pal8", {}, {"loop": "0"}, palette=True),
    ".webp": Format("libwebp_anim", "yuv420p", {"quality": "70"}, {"loop": "0"}),
}

_WAITING = 6
"""Frames that may wait for the encoder; the drawing waits for it beyond that."""

Frame = Callable[[], Pixels]
"""Makes the pixels of a frame, shape (height, width, 3); called in the encoder's thread."""


class VideoWriter:
    """Encodes frames in a thread of its own; open it with ``video_writer``."""

    def __init__(self, path: Path, size: tuple[int, int], fps: int) -> None:
        kind = FORMATS[path.suffix.lower()]
        self._container = av.open(str(path), "w", options=dict(kind.file_options))
        stream = self._container.add_stream(kind.encoder, rate=fps)
        assert isinstance(stream, av.VideoStream)
        stream.width, stream.height = size
        stream.pix_fmt = kind.pixels
        stream.options = dict(kind.encoder_options)
        self._stream = stream
        self._time_base = Fraction(1, fps)
        self._palettes = _palettes(size, self._time_base) if kind.palette else None
        self._frames = 0
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
        """Write the buffered frames, and the end of the file.

        Raises:
            OSError, FFmpegError: Something could not be encoded or written.
        """
        for future in self._waiting:
            future.result()
        self._container.mux(self._stream.encode(None))
        self._container.close()

    def give_up(self) -> None:
        """End the thread, drop the buffered frames and close the file."""
        self._thread.shutdown(cancel_futures=True)
        with contextlib.suppress(OSError, FFmpegError):
            self._container.close()

    def _encode(self, frame: Frame) -> None:
        picture = av.VideoFrame.from_ndarray(np.ascontiguousarray(frame()), "rgb24")
        picture.pts, picture.time_base = self._frames, self._time_base
        self._frames += 1
        if self._palettes is not None:
            self._palettes.vpush(picture)
            picture = self._palettes.vpull()
        self._container.mux(self._stream.encode(picture))


def _palettes(size: tuple[int, int], time_base: Fraction) -> Graph:
    """A filter that chooses 256 colours again for every frame."""
    graph = Graph()
    source = graph.add_buffer(
        width=size[0], height=size[1], format=av.VideoFormat("rgb24"), time_base=time_base
    )
    split = graph.add("split")
    choose = graph.add("palettegen", "stats_mode=single")
    use = graph.add("paletteuse", "new=1:dither=bayer")
    sink = graph.add("buffersink")
    source.link_to(split)
    split.link_to(choose, 0, 0)
    split.link_to(use, 1, 0)
    choose.link_to(use, 0, 1)
    use.link_to(sink)
    graph.configure()
    return graph


@contextlib.contextmanager
def video_writer(path: Path, size: tuple[int, int], fps: int) -> Iterator[VideoWriter]:
    """Open a video; it appears under ``path`` when the block ends without error.

    Args:
        path: The file; its suffix is one of ``FORMATS``.
        size: Width and height, both even [px].

    Raises:
        RenderError: There is no encoder or no such format, or the file cannot be written.
    """
    if path.suffix.lower() not in FORMATS:
        raise RenderError(f"{path}: films are written as {', '.join(FORMATS)}")
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
