"""Which room of ``twin`` imports which: rooms, floors, arrows, circles, arrows back up.

``python scripts/import_picture.py`` prints the picture and ends with 1 where the design is broken.
It reads the imports of every file as text, also those inside functions and for type checking only;
nothing of the package is run.
"""

import ast
import itertools
import sys
from collections.abc import Iterable, Iterator, Mapping
from pathlib import Path
from typing import NamedTuple

ROOT = Path(__file__).resolve().parent.parent

FLOORS: Mapping[str, tuple[str, ...]] = {
    "twin": (
        "errors processor units version",
        "columns copies files compilation web",
        "nc job",
        "toolpath logs",
        "motion",
        "recording",
        "machine compare cutting",
        "render calibrate coupling",
        "run",
        "api check link training view",
        "serve",
        "commands",
        "command_line",
        "cli",
        "__init__ __main__",
    ),
    "twin.nc": (
        "canonical geometry",
        "functions text",
        "path",
        "control",
        "iso",
        "dialects",
        "interpreter",
        "jsonl",
    ),
    "twin.motion": (
        "limits ramp_kernels steps",
        "blocks",
        "pieces",
        "profile",
        "retiming",
        "setpoints phases_of_pieces",
        "corner_trials",
        "phase_planner",
        "planner",
        "live report",
    ),
    "twin.compare": (
        "figures statistics_kernels",
        "statistics",
        "circular contour",
        "comparison",
        "trace verdict tracks",
        "result baseline_text track_comparison",
        "block_difference",
        "baseline report",
    ),
    "twin.render": (
        "drawing",
        "scene",
        "doctor frames hud machine_glb",
        "encoder gauge",
        "still",
        "film inspection_still",
    ),
    "twin.run": (
        "stages progress run_folder",
        "messages placement outcome waits",
        "preparation",
        "dry_run machining replay",
        "run",
        "results",
    ),
    "twin.machine": ("description", "model", "watching", "simulation", "circle", "describe check"),
    "twin.training": ("scene", "session", "sheets", "server"),
}
"""Of each folder with rooms, its rooms from the ground up; those of one floor know nothing of each
other. An import leads down, never up."""


class Arrow(NamedTuple):
    """One file imports another; both as dotted names of modules."""

    source: str
    target: str


def modules() -> dict[str, Path]:
    """Every module of the package by its dotted name."""
    found = {}
    for path in sorted((ROOT / "twin").rglob("*.py")):
        parts = path.relative_to(ROOT).with_suffix("").parts
        found[".".join(parts[:-1] if parts[-1] == "__init__" else parts)] = path
    return found


def arrows(known: Mapping[str, Path]) -> list[Arrow]:
    """Every import of one module of the package by another."""
    return [
        Arrow(name, target)
        for name, path in known.items()
        for target in sorted(set(_imported(path, known)))
        if target != name
    ]


def circles(edges: Iterable[Arrow]) -> list[list[str]]:
    """Groups of places that reach each other; none in a sound design."""
    onward: dict[str, set[str]] = {}
    for source, target in edges:
        onward.setdefault(source, set()).add(target)
    reached = {place: _reachable(place, onward) for place in onward}
    groups = {
        tuple(sorted(other for other in reached[place] if place in reached.get(other, ())))
        for place in onward
        if place in reached[place]
    }
    return [list(group) for group in sorted(groups)]


def arrows_up(edges: Iterable[Arrow]) -> list[Arrow]:
    """Imports that lead up, or across a floor, or from a room that no floor names."""
    return [
        edge
        for edge in edges
        for folder in FLOORS
        if _inside(edge.source, folder) and _inside(edge.target, folder)
        if not _leads_down(folder, edge)
    ]


def room(module: str, folder: str) -> str:
    """The room of a folder that a module lies in; of the folder's own file ``__init__``."""
    return module[len(folder) + 1 :].split(".", maxsplit=1)[0] or "__init__"


def rooms_without_floor(known: Iterable[str]) -> list[str]:
    """Rooms that exist and stand on no floor, and floors' rooms that do not exist."""
    wrong = []
    for folder, floors in FLOORS.items():
        named = set(itertools.chain.from_iterable(floor.split() for floor in floors))
        there = {room(module, folder) for module in known if _inside(module, folder)}
        wrong += [f"{folder}.{name}" for name in sorted((named ^ there) - {"__init__"})]
    return wrong


def room_arrows(edges: Iterable[Arrow], folder: str) -> set[Arrow]:
    """Arrows between the rooms of a folder."""
    pairs = {
        Arrow(room(edge.source, folder), room(edge.target, folder))
        for edge in edges
        if _inside(edge.source, folder) and _inside(edge.target, folder)
    }
    return {pair for pair in pairs if pair.source != pair.target}


def _inside(module: str, folder: str) -> bool:
    return module == folder or module.startswith(f"{folder}.")


def _leads_down(folder: str, edge: Arrow) -> bool:
    source, target = room(edge.source, folder), room(edge.target, folder)
    if source == target or target == "__init__":
        return True
    height = {name: i for i, floor in enumerate(FLOORS[folder]) for name in floor.split()}
    return height.get(target, len(height)) < height.get(source, -1)


def _reachable(place: str, onward: Mapping[str, set[str]]) -> set[str]:
    found: set[str] = set()
    waiting = list(onward.get(place, ()))
    while waiting:
        other = waiting.pop()
        if other not in found:
            found.add(other)
            waiting.extend(onward.get(other, ()))
    return found


def _imported(path: Path, known: Mapping[str, Path]) -> Iterator[str]:
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names if alias.name in known)
        elif isinstance(node, ast.ImportFrom) and (origin := node.module) in known:
            for alias in node.names:
                deeper = f"{origin}.{alias.name}"
                yield deeper if deeper in known else str(origin)


def _print_folder(folder: str, known: Mapping[str, Path], edges: list[Arrow]) -> None:
    pairs = room_arrows(edges, folder)
    print(
        f"{folder}: {sum(len(floor.split()) for floor in FLOORS[folder])} rooms, "
        f"{len(FLOORS[folder])} floors, {len(pairs)} arrows"
    )
    for floor in reversed(FLOORS[folder]):
        for name in floor.split():
            files = [path for module, path in known.items() if _inside(module, f"{folder}.{name}")]
            lines = sum(len(path.read_text(encoding="utf-8").splitlines()) for path in files)
            onto = " ".join(sorted(pair.target for pair in pairs if pair.source == name))
            print(f"  {name:14}{len(files):4} files {lines:6} lines  -> {onto}")
        print()


def main() -> int:
    """Print the picture; 1 where a circle closes or an arrow leads up."""
    known = modules()
    edges = arrows(known)
    for folder in FLOORS:
        _print_folder(folder, known, edges)
    closed, up, lost = circles(edges), arrows_up(edges), rooms_without_floor(known)
    print(f"{len(known)} files, {len(edges)} imports")
    print(
        f"circles among files: {len(closed)}",
        *(" <-> ".join(group) for group in closed),
        sep="\n  ",
    )
    print(f"arrows back up: {len(up)}", *(f"{a} imports {b}" for a, b in up), sep="\n  ")
    print(f"rooms without a floor: {len(lost)}", *lost, sep="\n  ")
    return 1 if closed or up or lost else 0


if __name__ == "__main__":
    sys.exit(main())
