"""What becomes of golden programs when one number of one rule is changed.

``python -m tests.nc.one_rule hot`` changes all rules in one copy of the package, compiles that once
(about a minute of one core) and looks at the compiled kernels; the test does the same without.
"""

import shutil
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import NamedTuple

from tests.nc.running import ROOT

SEEN = """
import json, sys
from pathlib import Path
from tests.nc.running import WITH_TABLES, all_records
from tests.nc.test_golden import assert_same
from twin.compilation.speed import Speed
from twin.nc.dialects import dialect_named
from twin.nc.interpreter import Interpretation
from twin.nc.text.source import read_source

ways = {"interpreter": (10**9, Speed.COLD), "cold": (0, Speed.COLD), "hot": (0, Speed.HOT)}
for name in sys.argv[2:]:
    path = Path(name)
    dialect = dialect_named(path.parts[-3])
    wanted = [json.loads(line) for line in path.with_suffix(".jsonl").read_text().splitlines()]
    for way in sys.argv[1].split(","):
        first, speed = ways[way]
        source = read_source(path, dialect)
        run = Interpretation(source, dialect, WITH_TABLES, compiled_from=first, speed=speed)
        try:
            assert_same(all_records(run), wanted, name)
            print(way, "agrees")
        except (AssertionError, ValueError):  # a changed rule of numbers reads some that are none
            print(way, "differs")
"""
"""Runs golden programs in several ways, and prints for each whether it gives the golden moves."""


class Change(NamedTuple):
    """Another number, or another sense, in the one file of a rule.

    Attributes:
        file: The file, as the table of ``twin/nc/README.md`` names it.
        old: What stands there once.
        new: What is put in its place.
        golden: A golden program that shows the rule.
    """

    file: str
    old: str
    new: str
    golden: str


CHANGES = (
    Change(
        "geometry/arcs",
        "- chord * chord / 4.0",
        "- chord * chord / 5.0",
        "fagor8070/rules/arc_forms",
    ),
    Change(
        "geometry/matrices",
        "turn = ((cosine, -sine, 0.0), (sine,",
        "turn = ((cosine, sine, 0.0), (-sine,",
        "fagor8070/codes/G73",
    ),
    Change(
        "geometry/curves",
        "dx, dy = -y * by, x * by",
        "dx, dy = y * by, -x * by",
        "fagor8070/rules/compensation",
    ),
    Change("geometry/planes", "_Z, _X, _Y)", "_X, _Z, _Y)", "gost/rules/planes_and_arcs"),
    Change(
        "geometry/lead_curves",
        "return (abs(sweep) < 180.0,",
        "return (abs(sweep) < 10.0,",
        "fagor8070/codes/G139",
    ),
    Change(
        "path/moves",
        "return target + here if incremental",
        "return target - here if incremental",
        "gost/codes/G91",
    ),
    Change("path/paces", "return counted * 60.0", "return counted * 61.0", "codesys/codes/G01"),
    Change(
        "path/compensation/leads",
        "element, part, element[2], rows",
        "element, part, element[1], rows",
        "codesys/codes/G41",
    ),
    Change(
        "path/compensation/follow",
        "if signed_offset < 0.0 else -abs(turn)",
        "if signed_offset > 0.0 else -abs(turn)",
        "gost/codes/G41",
    ),
    Change(
        "path/compensation/lookahead",
        "value[6] = part[4]",
        "value[6] = before[4] + 1.0",
        "codesys/decisions/smoothing_before_compensation",
    ),
    Change(
        "path/compensation/gouge",
        "            return True\n    return False\n\n\n@compilable\ndef _excused",
        "            return True\n    return True\n\n\n@compilable\ndef _excused",
        "codesys/codes/G40",
    ),
    Change(
        "geometry/corners",
        "turn * signed_offset < 0.0",
        "turn * signed_offset > 0.0",
        "fagor8070/rules/compensation",
    ),
    Change("text/lines", "_RETURN = 10, 13", "_RETURN = 32, 13", "gost/rules/drilling"),
    Change("text/plain_word", '_POINT: ".",', '_POINT: ",",', "gost/rules/drilling"),
    Change(
        "text/comments",
        "comment.opening.encode",
        "comment.closing.encode",
        "fanuc/rules/abbreviations",
    ),
    Change("text/arithmetic", "return a + b\n", "return a + b + 1.0\n", "fagor8070/rules/flow"),
    Change(
        "bytecode/expressions",
        "binary(operand, stack[place], stack[place + 1])",
        "binary(operand, stack[place + 1], stack[place])",
        "fagor8070/rules/flow",
    ),
    Change(
        "geometry/frame",
        "return (x + total[0], y + total[1], z + total[2])",
        "return (x + total[0] + 1.0, y + total[1], z + total[2])",
        "fagor8070/codes/G73",
    ),
    Change(
        "geometry/polar",
        "origin[0] + radius * cosine",
        "origin[0] - radius * cosine",
        "fagor8070/rules/polar",
    ),
    Change(
        "path/drilling_cycle",
        "given[BOTTOM] + above, given",
        "given[BOTTOM] + above + 1.0, given",
        "gost/rules/drilling",
    ),
    Change(
        "path/hole",
        "min(depth + hole.clearance, up)",
        "min(depth - hole.clearance, up)",
        "gost/rules/drilling",
    ),
    Change(
        "bytecode/effects",
        "state.shifts[operand, axis] = stack[top + axis]",
        "state.shifts[operand, axis] = stack[top + axis] + 1.0",
        "gost/rules/work_offsets",
    ),
    Change(
        "iso/base",
        "opcodes.REPORT, event_columns.DWELL",
        "opcodes.REPORT, event_columns.AUXILIARY",
        "gost/codes/G04",
    ),
    Change(
        "bytecode/coordinates",
        "state.part[axis] - state.total[axis]",
        "state.part[axis] - state.total[axis] + 1.0",
        "gost/codes/G43",
    ),
    Change(
        "bytecode/compensation",
        "signed_offset = side * radius",
        "signed_offset = -side * radius",
        "gost/codes/G41",
    ),
    Change(
        "bytecode/flow", "stack[top - 1] + width", "stack[top - 1] - width", "fagor8070/rules/flow"
    ),
    Change(
        "bytecode/instructions",
        "going_to(instruction.operand, to)",
        "going_to(to.behind, to)",
        "fagor8070/rules/flow",
    ),
    Change(
        "control/block_order",
        "steps.move(instead)",
        "steps.move(None)",
        "gost/codes/G04",
    ),
    Change(
        "bytecode/variables",
        "memory.local[depth, ~slot] = value",
        "memory.local[depth, ~slot] = value + 1.0",
        "fagor8070/rules/flow",
    ),
    Change("functions", "_STARTS, _STOPS = (3, 4)", "_STARTS, _STOPS = (30, 4)", "gost/codes/G94"),
    Change("bytecode/frames", "if call[AGAIN] > 0:", "if call[AGAIN] > 1:", "fagor8070/rules/flow"),
)


def outcomes(changes: tuple[Change, ...], ways: str) -> dict[str, list[str]]:
    """What the golden program of each change does in a copy of the package with all of them."""
    with tempfile.TemporaryDirectory() as name:
        copy = Path(name, "twin")
        shutil.copytree(ROOT / "twin", copy, ignore=shutil.ignore_patterns("__pycache__"))
        for change in changes:
            file = copy / "nc" / f"{change.file}.py"
            text = file.read_text(encoding="utf-8")
            assert text.count(change.old) == 1, change.file
            file.write_text(text.replace(change.old, change.new), encoding="utf-8")
        paths = [str(ROOT / "tests" / "golden" / f"{change.golden}.nc") for change in changes]
        path = f"sys.path[:0] = [{name!r}, {str(ROOT)!r}]"
        command = [sys.executable, "-c", f"import sys; {path}\n{SEEN}", ways, *paths]
        done = subprocess.run(command, capture_output=True, text=True, check=True, cwd=name)
        lines, count = done.stdout.splitlines(), len(ways.split(","))
        return {
            change.file: lines[count * number : count * (number + 1)]
            for number, change in enumerate(changes)
        }


if __name__ == "__main__":
    seen = outcomes(CHANGES, ",".join(sys.argv[1:]))
    for rule, found in seen.items():
        print(f"{rule}: {', '.join(found)}")
    sys.exit(any("agrees" in line for found in seen.values() for line in found))
