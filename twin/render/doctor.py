"""What this machine can draw and film, for ``twin doctor``."""

import dataclasses

import av
from av.codec.codec import UnknownCodecError

from twin.errors import RenderError
from twin.render.gl import choose_backend


@dataclasses.dataclass(frozen=True, slots=True)
class RenderFacts:
    """What was found.

    Attributes:
        backend: OpenGL backend that drew a test frame; empty when none did.
        renderer: What OpenGL calls itself.
        encoder: Name of the H.264 encoder; empty when there is none.
        problems: What to install or mend, one sentence each.
    """

    backend: str
    renderer: str
    encoder: str
    problems: tuple[str, ...]

    @property
    def ready(self) -> bool:
        """Whether films can be made here."""
        return not self.problems


H264_ENCODER = "libx264"


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
    return RenderFacts(backend, renderer, encoder, tuple(problems))


def missing_encoder() -> str:
    """What to do where PyAV was built without H.264."""
    return (
        f"PyAV {av.__version__} has no {H264_ENCODER}: install the wheel from PyPI "
        "(pip install --force-reinstall --only-binary av av)"
    )
