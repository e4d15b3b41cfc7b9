"""``twin`` and ``python -m twin``: the command line, interrupted at any time.

A signal may come while the libraries are still being loaded: even then a sentence is said.
"""

import atexit
import gc
import os
import resource
import signal
import sys
import threading
import types

LEAST_ADDRESS_SPACE = 900_000_000
"""In less the libraries of a run cannot be loaded, and some die of it without a word, or never come
to an end [bytes]."""

COLLECT_AFTER = 500_000
"""New objects between two searches for garbage: what libraries make while they load, some 300,000, all stays."""

KNOWN_TO_MUJOCO = frozenset(
    [
        "egl",
        "osmesa",
        "glfw",
        "glx",
        "cgl",
        "wgl",
        "disable",
        "disabled",
        "off",
        "false",
        "0",
        "enable",
        "enabled",
        "on",
        "true",
        "1",
    ]
)
"""What MuJoCo takes in ``MUJOCO_GL`` (``mujoco/rendering/classic/gl_context.py``); with anything else it cannot be imported."""

_BOXING_NAME, _BOXING_MODULE = "_numba_unpickle", "namedtuple_"
"""What Numba calls in Python while compiled code hands its result over: a function, and constructors
of modules of such names."""
_LOADING, _LOAD = "<frozen importlib", "_find_and_load"
"""Where Python keeps the loading of modules, and the function that loads the one that it calls ``name``."""
_SOON_S = 0.005


def main() -> None:
    """Run the command line and exit with the code that the contract promises."""
    stopped: list[int] = []
    codes: list[int] = []

    def leave() -> None:
        # Python ends itself by the signal where an interruption went through an exec of text, as
        # libraries do, although it was dealt with.
        if stopped and codes:
            sys.stdout.flush()
            sys.stderr.flush()
            os._exit(codes[0])

    atexit.register(leave)  # the first to be registered is the last to be called
    try:
        _run(stopped)
    except SystemExit as leaving:
        # All is done and said: a signal that comes while Python puts itself away changes nothing.
        signal.signal(signal.SIGTERM, signal.SIG_IGN)
        signal.signal(signal.SIGINT, signal.SIG_IGN)
        # As Python does it: nothing means 0, a sentence means 1.
        codes.append(
            leaving.code if isinstance(leaving.code, int) else int(leaving.code is not None)
        )
        raise


def is_handing_over(frame: types.FrameType | None) -> bool:
    """Whether compiled code is just making Python objects of its result.

    Numba does not look whether that succeeded: an exception that is raised there is lost, or ends the
    process by a segmentation fault.

    Args:
        frame: What is being executed.
    """
    while frame is not None:
        module = str(frame.f_globals.get("__name__"))
        if frame.f_code.co_name == _BOXING_NAME or module.startswith(_BOXING_MODULE):
            return True
        frame = frame.f_back
    return False


def is_loading(frame: types.FrameType | None) -> bool:
    """Whether a library's module is being loaded.

    Libraries try what may be missing, and take any exception for its absence: an interruption is lost
    there, or leaves a library half loaded. Modules of this package let it through.
    """
    while frame is not None:
        code = frame.f_code
        if code.co_name == _LOAD and code.co_filename.startswith(_LOADING):
            package = str(frame.f_locals.get("name")).partition(".")[0]
            if package != "twin":
                return True
        frame = frame.f_back
    return False


def _choose_window_library() -> None:
    """MuJoCo needs none, for pictures are drawn in contexts of this package's own; what it refuses is said here."""
    wanted = os.environ.setdefault("MUJOCO_GL", "disable").lower().strip()
    if wanted and wanted not in KNOWN_TO_MUJOCO:
        print(
            f"the environment says MUJOCO_GL={wanted}, which MuJoCo does not know: unset it, or choose egl, osmesa or glfw",
            file=sys.stderr,
        )
        raise SystemExit(2)


def _run(stopped: list[int]) -> None:
    """Run the command line; the signals that came are put into the list."""

    def stop(number: int, frame: types.FrameType | None) -> None:
        if is_handing_over(frame) or is_loading(frame):
            again = threading.Timer(_SOON_S, os.kill, (os.getpid(), number))
            again.daemon = True
            again.start()
            return
        stopped.append(number)
        raise KeyboardInterrupt

    # Asked to end, by a batch system say, is the same as Ctrl-C: files are left whole or absent.
    signal.signal(signal.SIGTERM, stop)
    signal.signal(signal.SIGINT, stop)
    gc.set_threshold(COLLECT_AFTER)
    limit = resource.getrlimit(resource.RLIMIT_AS)[0]
    if 0 <= limit < LEAST_ADDRESS_SPACE:
        print(
            f"there is not enough memory to begin: {limit / 1e6:.0f} MB of address space are allowed "
            f"(ulimit -v), and {LEAST_ADDRESS_SPACE / 1e6:.0f} MB is the least",
            file=sys.stderr,
        )
        raise SystemExit(2)
    _choose_window_library()
    # Nor does pydantic need to search all that is installed for plug-ins, of which the tables of files have no use.
    os.environ.setdefault("PYDANTIC_DISABLE_PLUGINS", "__all__")
    try:
        import logging

        from twin.command_line.streams import prepare_streams

        prepare_streams()
        # Matplotlib complains where there is no home folder for what it keeps, and does without.
        logging.getLogger("matplotlib").setLevel(logging.ERROR)
        from twin.cli import main as run

        run(stopped)
    except (KeyboardInterrupt, ImportError):
        # A library that is interrupted while it is being loaded says that it cannot be.
        if not stopped:
            raise
        print("interrupted before anything was begun", file=sys.stderr)
        raise SystemExit(130) from None
    except MemoryError:
        print("there is not enough memory to begin", file=sys.stderr)
        raise SystemExit(2) from None


if __name__ == "__main__":
    main()
