"""What a command left behind, and machines for it to run on."""

import dataclasses
import re
from collections.abc import Callable
from pathlib import Path

from twin.files.shipped import machine_file
from twin.machine.load import read_machine


@dataclasses.dataclass(frozen=True)
class Finished:
    """What a command left behind."""

    code: int
    stdout: str
    stderr: str


Twin = Callable[..., Finished]


def machine_with_gain(folder: Path, factor: float, machine: str = "mill4") -> Path:
    """A copy of a machine whose position loops are turned up or down."""
    shipped = read_machine(machine_file(machine))
    text = shipped.path.read_text(encoding="utf-8")
    text = text.replace(f'model = "{shipped.file.model}"', f'model = "{shipped.model_path}"')
    text = re.sub(
        r"^kv = (.*)$", lambda kv: f"kv = {factor * float(kv[1])}", text, flags=re.MULTILINE
    )
    path = folder / "machine.toml"
    path.write_text(text, encoding="utf-8")
    return path
