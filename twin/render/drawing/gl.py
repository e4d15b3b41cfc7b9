"""Which OpenGL draws off-screen here: EGL, else OSMesa, else a message that says what to install.

The backends are tried in processes of their own, so that a driver that crashes takes nothing with
it. MuJoCo's classes for off-screen contexts are used directly, so that it does not matter who
imported ``mujoco`` first, nor with which ``MUJOCO_GL``.
"""

import dataclasses
import functools
import importlib
import json
import os
import subprocess
import sys
from typing import Any

from twin.errors import RenderError

BACKENDS = ("egl", "osmesa")
"""In the order in which they are tried: EGL also draws on a GPU."""

FILAMENT = "filament"
"""Not OpenGL, but tried likewise."""

PACKAGES = {"egl": "libegl1 libgl1-mesa-dri", "osmesa": "libosmesa6"}
"""What Debian and Ubuntu call them."""

_PROBE_SECONDS = 120


@dataclasses.dataclass(frozen=True, slots=True)
class Probe:
    """What trying a backend gave.

    Attributes:
        backend: ``egl``, ``osmesa`` or ``filament``.
        renderer: What OpenGL calls itself; empty when it does not work.
        error: Why it does not work; empty when it does.
    """

    backend: str
    renderer: str = ""
    error: str = ""


@functools.cache
def probe(backend: str) -> Probe:
    """Try to draw a test frame with a backend, in a process of its own."""
    environment = {
        name: value
        for name, value in os.environ.items()
        if name not in ("MUJOCO_GL", "PYOPENGL_PLATFORM")
    }
    environment["MUJOCO_GL"] = (
        "disable"  # keeps mujoco from opening a context that nobody asked for
    )
    environment["PYTHONPATH"] = os.pathsep.join(filter(None, sys.path))
    try:
        done = subprocess.run(  # noqa: S603 (this program's own module)
            [sys.executable, "-m", "twin.render.drawing.probe", backend],
            env=environment,
            capture_output=True,
            text=True,
            errors="replace",
            timeout=_PROBE_SECONDS,
            check=False,
        )
    except subprocess.TimeoutExpired:
        return Probe(backend, error=f"no test frame within {_PROBE_SECONDS} s")
    answer = _answer(done.stdout)
    if answer is None:
        lines = done.stderr.strip().splitlines()
        fallen = f"ended with signal {-done.returncode}" if done.returncode < 0 else "failed"
        return Probe(backend, error=lines[-1] if lines else f"the test frame {fallen}")
    return Probe(backend, renderer=answer.get("renderer", ""), error=answer.get("error", ""))


def _answer(output: str) -> dict[str, str] | None:
    for line in reversed(output.splitlines()):
        try:
            answer = json.loads(line)
        except ValueError:
            continue
        if isinstance(answer, dict):
            return answer
    return None


def choose_backend() -> Probe:
    """The first backend that works; ``MUJOCO_GL`` may name the one to use.

    Raises:
        RenderError: None works; the message says what was tried and what to install.
    """
    wanted = os.environ.get("MUJOCO_GL", "").lower().strip()
    tried = []
    for backend in (wanted,) if wanted in BACKENDS else BACKENDS:
        found = probe(backend)
        if not found.error:
            return found
        tried.append(f"  {backend}: {found.error}; needs the packages {PACKAGES[backend]}")
    raise RenderError(
        "no OpenGL that draws without a screen works here:\n"
        + "\n".join(tried)
        + f"\n  on Debian and Ubuntu: apt-get install {' '.join(PACKAGES.values())}"
    )


def open_context(backend: str, width: int, height: int) -> Any:
    """Open an off-screen context and make it current; ``free`` closes it.

    Args:
        backend: One of ``BACKENDS``.
        width: Of the pictures [px].
        height: Of the pictures [px].

    Raises:
        RenderError: The backend does not work in this process.
    """
    try:
        context = importlib.import_module(f"mujoco.{backend}").GLContext(width, height)
        context.make_current()
    except (ImportError, AttributeError, OSError, RuntimeError) as error:
        raise RenderError(
            f"OpenGL by {backend} cannot be opened: {error}; needs the packages {PACKAGES[backend]}"
        ) from error
    return context
