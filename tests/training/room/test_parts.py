"""Each part of a room changes its own state: no other file writes to it."""

import ast
from collections.abc import Iterator
from pathlib import Path

import pytest

TWIN = Path(__file__).parents[3] / "twin"
PARTS = [
    path for folder in ("room", "program") for path in (TWIN / "training" / folder).rglob("*.py")
]
OTHERS = [*(TWIN / "training").rglob("*.py"), *(TWIN / "serve").rglob("*.py")]
MUTATORS = {"append", "appendleft", "extend", "pop", "popleft", "remove", "setdefault", "update"}  # fmt: skip
NO_PARTS = {"evidence", "motion", "seat", "_operation"}
"""Objects of other kinds that have fields of the same names: records of their only user, and the interpreter's state."""
MOST_METHODS, MOST_LINES, LONGEST_INIT = 25, 400, 60


def classes(path: Path) -> list[ast.ClassDef]:
    return [node for node in ast.parse(path.read_text()).body if isinstance(node, ast.ClassDef)]


def fields(part: ast.ClassDef) -> set[str]:
    """Attributes that a class assigns to itself, and fields of a dataclass that is not frozen."""
    own = {node.attr for node in assigned(part) if is_own(node.value)}
    if any(
        "dataclass" in ast.unparse(one) and "frozen" not in ast.unparse(one)
        for one in part.decorator_list
    ):
        own |= {node.target.id for node in part.body if isinstance(node, ast.AnnAssign) and isinstance(node.target, ast.Name)}  # fmt: skip
    return own


def assigned(tree: ast.AST) -> Iterator[ast.Attribute]:
    """Attributes that are assigned, deleted, or changed in place."""
    for node in ast.walk(tree):
        targets: list[ast.expr] = []
        if isinstance(node, ast.Assign | ast.Delete):
            targets = list(node.targets)
        elif isinstance(node, ast.AugAssign | ast.AnnAssign):
            targets = [node.target]
        elif (
            isinstance(node, ast.Call)
            and isinstance(node.func, ast.Attribute)
            and node.func.attr in MUTATORS
        ):
            targets = [node.func.value]
        while targets:
            target = targets.pop()
            if isinstance(target, ast.Tuple | ast.List):
                targets += target.elts
            elif isinstance(target, ast.Subscript | ast.Starred):
                targets.append(target.value)
            elif isinstance(target, ast.Attribute):
                yield target


def is_own(node: ast.expr) -> bool:
    return isinstance(node, ast.Name) and node.id == "self"


def foreign(text: str, state: set[str]) -> list[str]:
    """Writes to state of something else than ``self``."""
    found = [node for node in assigned(ast.parse(text)) if node.attr in state]
    return [
        ast.unparse(node)
        for node in found
        if not is_own(node.value) and name_of(node.value) not in NO_PARTS
    ]


def name_of(node: ast.expr) -> str:
    """The last name of an expression such as ``room.panel``."""
    return node.attr if isinstance(node, ast.Attribute) else ast.unparse(node)


STATE = {name for path in PARTS for part in classes(path) for name in fields(part)}


def test_the_state_of_the_parts_is_known():
    assert {"mode", "active", "running", "moves", "coolant", "work", "zero", "ending"} <= STATE


@pytest.mark.parametrize(
    "text",
    ["room.panel.mode = 'jog'", "a, room.slot.waiting = 1, 2", "room.alarms.history.append(x)",
     "tables.zero[1] += 2.0", "del room.alarms.broken[3]"],
)  # fmt: skip
def test_a_write_from_elsewhere_is_seen(text):
    assert foreign(text, STATE)


def test_no_other_file_writes_to_a_part():
    found = {path.name: foreign(path.read_text(), STATE) for path in OTHERS}
    assert {name: writes for name, writes in found.items() if writes} == {}


def test_parts_are_small():
    long_files = [path.name for path in PARTS if len(path.read_text().splitlines()) > MOST_LINES]
    methods = {
        part.name: [node for node in part.body if isinstance(node, ast.FunctionDef)]
        for path in PARTS
        for part in classes(path)
    }
    large = [name for name, each in methods.items() if len(each) > MOST_METHODS]
    slow = [
        name
        for name, each in methods.items()
        for node in each
        if node.name == "__init__" and (node.end_lineno or 0) - node.lineno > LONGEST_INIT
    ]
    assert (long_files, large, slow) == ([], [], [])
