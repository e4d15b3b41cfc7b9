"""Reference of codes: exit codes, and what every error, warning and alarm means."""

import ast
import inspect
from collections.abc import Iterator

import twin.errors
from twin.command_line.streams import CLOSED_PIPE
from twin.commands.explain import codes
from twin.errors import ExitCode
from twin.nc.text.diagnostics.explain import findings

_LEAD = (
    "A message begins with its place and its code: `part.nc:4:1: error soft-limit: ...`. `twin explain CODE` "
    'tells what stands here; `expect = "CODE"` in a job lets `twin check` pass a program that is to end so.'
)
_GROUPS = {
    "alarm": "Alarms of the machine",
    "warning": "Warnings of the run",
    "tolerance": "Tolerances",
    "baseline": "Baselines",
    "check": "Checks of many programs",
}


def codes_page() -> str:
    """Exit codes, then every code by group."""
    sections = [
        "# Codes",
        _LEAD,
        "## Exit codes",
        _exit_codes(),
    ]
    for group, heading in _GROUPS.items():
        sections.append(f"## {heading}")
        for name, code in codes().items():
            if code.group == group:
                sections += [f"### `{name}`", f"{code.text} {code.remedy}"]
    sections += [
        "## The NC program",
        "What the interpreter says of a program, with exit code 3 where it is an error.",
    ]
    for name, finding in sorted(findings().items()):
        sections += [
            f"### `{name}`",
            f"{finding.text} {finding.remedy}",
            f'```text title="a program that causes it, {finding.dialect}"\n{_shortened(finding.example)}\n```',
        ]
    return "\n\n".join(sections) + "\n"


def _shortened(example: str) -> str:
    return "\n".join(
        line if len(line) < 200 else f"{line[:100]} ..." for line in example.splitlines()
    )


def _exit_codes() -> str:
    rows = [f"| {int(code)} | {meaning} |" for code, meaning in exit_codes()]
    return "\n".join(("| code | meaning |", "|---|---|", *rows))


def exit_codes() -> Iterator[tuple[int, str]]:
    """Every exit code with the words at its declaration."""
    said = {
        ExitCode.OK: "Done; where a tolerance was asked for, it holds.",
        ExitCode.INTERRUPTED: "Interrupted; what was complete is kept, nothing is torn.",
    }
    (declared,) = ast.parse(inspect.getsource(ExitCode)).body
    assert isinstance(declared, ast.ClassDef)
    name = ""
    for node in declared.body:
        if isinstance(node, ast.Assign) and isinstance(node.targets[0], ast.Name):
            name = node.targets[0].id
        elif name and isinstance(node, ast.Expr) and isinstance(node.value, ast.Constant):
            said[ExitCode[name]] = str(node.value.value)
    yield from ((int(code), said[code]) for code in twin.errors.ExitCode)
    yield CLOSED_PIPE, "Whoever read the output went away before its end (`| head`)."
