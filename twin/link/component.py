"""The realtime component of LinuxCNC: its source, and whether the one that is installed is ours."""

import hashlib
import os
import re
import shutil
import subprocess
from functools import cache
from pathlib import Path

import jinja2

from twin.errors import UsageError
from twin.files.atomic import write_text
from twin.link.packet import (
    ANSWER,
    ANSWER_STATES,
    JOINTS,
    MAGIC,
    REQUEST,
    REQUEST_STATES,
    VERSION,
    c_declaration,
)

NAME = "mill_twin"
COMPILER = "halcompile"
COMPILER_PACKAGE = "linuxcnc-uspace-dev"
_USUAL_MODULES = Path("/usr/lib/linuxcnc/modules")
_BUILD_TIMEOUT_S = 120


@cache
def templates() -> jinja2.Environment:
    """What the files for LinuxCNC are written from."""
    return jinja2.Environment(
        loader=jinja2.PackageLoader("twin.link", "templates"),
        undefined=jinja2.StrictUndefined,
        keep_trailing_newline=True,
        autoescape=False,  # noqa: S701 - no page of the web is made of them
    )


def source(stamp: str = "") -> str:
    """The component for ``halcompile``.

    Args:
        stamp: By which the compiled form is distinguished from those of other versions.
    """
    return (
        templates()
        .get_template(f"{NAME}.comp.j2")
        .render(
            joints=JOINTS,
            magic=MAGIC,
            version=VERSION,
            request=c_declaration("request", REQUEST),
            answer=c_declaration("answer", ANSWER),
            request_states=REQUEST_STATES,
            answer_states=ANSWER_STATES,
            stamp=stamp,
        )
    )


def stamp() -> str:
    """What the compiled form of this version's component holds, and no other's."""
    return f"mill-twin {hashlib.sha256(source().encode()).hexdigest()}"


def module_folder(linuxcnc: Path) -> Path:
    """Where LinuxCNC loads realtime components from; from nowhere else.

    Args:
        linuxcnc: Its start script, which says where.
    """
    found = re.search(
        r"^LINUXCNC_RTLIB_DIR=(\S+)$", linuxcnc.read_text(encoding="utf-8"), re.MULTILINE
    )
    return _USUAL_MODULES if found is None else Path(found.group(1))


def is_installed(modules: Path) -> bool:
    """Whether the component of this very version lies among LinuxCNC's."""
    module = modules / f"{NAME}.so"
    return module.is_file() and stamp().encode() in module.read_bytes()


def install(folder: Path, modules: Path) -> None:
    """Write the component's source into a folder, and build and install it where that is needed.

    LinuxCNC loads realtime components from one folder of the system alone, so that it takes root,
    once for each version of the component.

    Args:
        folder: For the source, ``mill_twin.comp``.
        modules: Where LinuxCNC loads realtime components from.

    Raises:
        UsageError: It is not installed and cannot be; the message says what to do.
    """
    path = folder / f"{NAME}.comp"
    write_text(path, source(stamp()))
    if is_installed(modules):
        return
    if shutil.which(COMPILER) is None:
        raise UsageError(
            f"LinuxCNC has no component of the twin yet, and {COMPILER}, which builds it, is missing: "
            f"install Debian's package {COMPILER_PACKAGE}"
        )
    if not os.access(modules, os.W_OK):
        raise UsageError(
            f"LinuxCNC loads realtime components only from {modules}: as root, once, say\n"
            f"    sudo {COMPILER} --install {path}"
        )
    try:
        built = subprocess.run(  # noqa: S603 - names no user has a hand in
            [COMPILER, "--install", path.name],
            cwd=folder, capture_output=True, text=True, timeout=_BUILD_TIMEOUT_S, check=False,
        )  # fmt: skip
    except subprocess.TimeoutExpired as error:
        raise UsageError(f"{COMPILER} took longer than {_BUILD_TIMEOUT_S} s") from error
    if built.returncode or not is_installed(modules):
        raise UsageError(f"{COMPILER} could not build {path}:\n{built.stdout}{built.stderr}")
