"""What a run left in its folder: every file under its own name must be whole."""

import json
import struct
from pathlib import Path

from twin.recording.reader import open_recording

STL_HEADER, STL_TRIANGLE = 84, 50


def complaints(folder: Path) -> list[str]:
    """What is torn in the folder of a run; a run that left little may be fine.

    Args:
        folder: The run's folder; it may be missing.
    """
    found = []
    for path in sorted(folder.glob("[!.]*")) if folder.is_dir() else []:
        try:
            _CHECKS[path.suffix](path)
        except (ValueError, OSError, struct.error, KeyError) as error:
            found.append(f"{path.name}: {error}")
    if (folder / "result.json").is_file() and not (folder / "recording.h5").is_file():
        found.append("a result without its recording")
    return found


def _check_json(path: Path) -> None:
    content = json.loads(path.read_text(encoding="utf-8"))
    if "verdict" not in content:
        raise ValueError("no verdict")


def _check_page(path: Path) -> None:
    if not path.read_text(encoding="utf-8").rstrip().endswith("</html>"):
        raise ValueError("the page does not end")


def _check_recording(path: Path) -> None:
    with open_recording(path) as recording:
        rows = sum(len(chunk) for chunk in recording.chunks())
        if rows != len(recording) or rows == 0:
            raise ValueError("samples are missing")


def _check_stl(path: Path) -> None:
    data = path.read_bytes()
    (count,) = struct.unpack_from("<I", data, STL_HEADER - 4)
    if len(data) != STL_HEADER + STL_TRIANGLE * count:
        raise ValueError("triangles are missing")


_CHECKS = {
    ".json": _check_json,
    ".html": _check_page,
    ".h5": _check_recording,
    ".stl": _check_stl,
}
