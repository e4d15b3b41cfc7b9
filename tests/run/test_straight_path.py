"""How straight ``twin run`` goes from package to package before its first sample.

A stay is a call from one package of ``twin`` into a folder of another, the first into a file, if that leads on to other
files. A return is a stay in a folder that had been left, a climb one in a layer above the caller's. Not counted: the two
lowest layers, which know nothing of the trade; what libraries call, such as validators; taking items from generators.
"""

import functools
import inspect
import sys
import tomllib
from pathlib import Path
from types import FrameType
from typing import NamedTuple

import pytest

import twin
import twin.processor
from twin.commands.runs import run as command
from twin.files.shipped import resource_root
from twin.recording.writer import RecordingWriter

PACKAGE = Path(twin.__file__).parent
PROJECT = tomllib.loads((PACKAGE.parent / "pyproject.toml").read_text(encoding="utf-8"))
LAYERS = next(c for c in PROJECT["tool"]["importlinter"]["contracts"] if c["id"] == "twin")[
    "layers"
]
HEIGHT = {
    name: n for n, layer in enumerate(reversed(LAYERS), start=-2) for name in layer.split(" | ")
}
"""Of each package; those of the two lowest layers are below 0."""


class Call(NamedTuple):
    caller: int
    file: Path
    generator: bool

    @property
    def package(self) -> str:
        return self.file.parts[0].removesuffix(".py")


class _FirstSample(BaseException):
    pass


def calls_before_first_sample(job: Path, out: Path) -> list[Call]:
    calls: list[Call] = []
    numbers: dict[FrameType, int | None] = {}

    def note(frame: FrameType, event: str, _: object) -> None:
        code, caller = frame.f_code, frame.f_back
        if event != "call" or frame in numbers or not code.co_filename.startswith(f"{PACKAGE}/"):
            return
        if caller is not None and caller.f_code.co_filename == functools.__file__:
            caller = caller.f_back  # A cached property.
        by = (
            0 if code is command.run_and_print.__code__ else numbers.get(caller) if caller else None
        )
        numbers[frame] = None if by is None else len(calls)
        if by is not None:
            path = Path(code.co_filename).relative_to(PACKAGE)
            calls.append(Call(by, path, bool(code.co_flags & inspect.CO_GENERATOR)))
        if code is RecordingWriter.append.__code__:
            raise _FirstSample

    sys.setprofile(note)
    try:
        with pytest.raises(_FirstSample):
            command.run_and_print(job, out, dialect=None, machine=None, video=False, strict=False)
    finally:
        sys.setprofile(None)
    return calls


def stays(calls: list[Call]) -> list[tuple[str, bool]]:
    """The folders in which the path stays, and whether it climbs there."""
    leads_on = [False] * len(calls)
    for call, leads in zip(reversed(calls), reversed(range(len(calls))), strict=True):
        other_file = HEIGHT[call.package] >= 0 and call.file != calls[call.caller].file
        leads_on[call.caller] |= other_file or leads_on[leads]
    found: list[tuple[str, bool]] = []
    read: set[Path] = set()
    for call, leads in zip(calls, leads_on, strict=True):
        from_height, height = HEIGHT[calls[call.caller].package], HEIGHT[call.package]
        crosses = call.package != calls[call.caller].package and height >= 0
        folder = call.file.parent.as_posix()
        stay = crosses and leads and not call.generator and call.file not in read
        if stay and [folder] != [each for each, _ in found[-1:]]:
            found.append((folder, height > from_height))
        read.add(call.file)
    return found


@pytest.mark.seconds("a run is followed call by call")
def test_a_run_goes_straight(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(command, "announce_compilation", lambda **_: None)
    monkeypatch.setattr(twin.processor, "available_cores", lambda: 1)
    job = Path(resource_root("programs") / "gallery/fagor8070/medallion.toml")
    path = stays(calls_before_first_sample(job, tmp_path / "out"))
    folders = [folder for folder, _ in path]
    returns = len(folders) - len(set(folders))
    assert len(folders) <= 16, folders
    assert returns <= 3, folders
    assert not any(climbs for _, climbs in path), path
