"""What this machine can draw and film, for ``twin doctor``."""

import dataclasses
import shutil
from pathlib import Path

import av
from av.codec.codec import UnknownCodecError

from twin.errors import RenderError
from twin.render.drawing.gl import FILAMENT, choose_backend, probe


@dataclasses.dataclass(frozen=True, slots=True)
class RenderFacts:
    """What was found.

    Attributes:
        backend: OpenGL backend that drew a test frame; empty when none did.
        filament: What Filament draws through; empty where it does not work.
        encoder: Name of the H.264 encoder; empty when there is none.
        memory_mb: Memory that is free for a run; None where the system does not tell [MB].
        disk_mb: Space on the disk of the working folder [MB].
        problems: What to install or mend, one sentence each.
    """

    backend: str
    renderer: str
    filament: str
    encoder: str
    memory_mb: float | None
    disk_mb: float
    problems: tuple[str, ...]

    @property
    def ready(self) -> bool:
        """Whether films can be made here."""
        return not self.problems


H264_ENCODER = "libx264"

LEAST_MEMORY_MB = 700.0
"""What a film in final quality at 1920 x 1080 was seen to take, and some more."""
LEAST_DISK_MB = 200.0
"""Room for the recording and the film of a long program."""
_MEMORY_FILE = Path("/proc/meminfo")


def render_facts() -> RenderFacts:
    """Draw a test frame and look for the encoder; never raises and never crashes."""
    problems = []
    backend = renderer = encoder = ""
    try:
        found = choose_backend()
        backend, renderer = found.backend, found.renderer
    except RenderError as error:
        problems.append(str(error))
    try:
        encoder = av.Codec(H264_ENCODER, "w").name
    except UnknownCodecError:
        problems.append(missing_encoder())
    memory, disk = free_memory_mb(), shutil.disk_usage(Path.cwd()).free / 1e6
    if memory is not None and memory < LEAST_MEMORY_MB:
        problems.append(
            f"{memory:.0f} MB of memory are free, films want {LEAST_MEMORY_MB:.0f}: "
            "close other programs, or film smaller and in draft quality"
        )
    if disk < LEAST_DISK_MB:
        problems.append(
            f"{disk:.0f} MB of disk are free in {Path.cwd()}, runs want {LEAST_DISK_MB:.0f}: "
            "free some, or write elsewhere by --out"
        )
    return RenderFacts(
        backend, renderer, probe(FILAMENT).renderer, encoder, memory, disk, tuple(problems)
    )


def free_memory_mb() -> float | None:
    """Memory that can still be taken [MB]; None where the system does not tell."""
    try:
        lines = _MEMORY_FILE.read_text(encoding="ascii").splitlines()
    except OSError:
        return None
    for line in lines:
        name, _, amount = line.partition(":")
        if name == "MemAvailable":
            return float(amount.split()[0]) * 1024 / 1e6
    return None


def missing_encoder() -> str:
    """What to do where PyAV was built without H.264."""
    return (
        f"PyAV {av.__version__} has no {H264_ENCODER}: install the wheel from PyPI "
        "(pip install --force-reinstall --only-binary av av)"
    )
