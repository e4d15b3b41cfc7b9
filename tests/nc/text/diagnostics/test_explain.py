"""Every diagnostic is explained, and every explanation's example earns its diagnostic."""

import ast
import re
from collections.abc import Iterator
from typing import Any

import pytest

from tests.nc.running import ROOT, run
from twin.nc.control.settings import ToolData
from twin.nc.text.diagnostics.explain import findings

_CODE = re.compile(r"[a-z0-9]+(-[a-z0-9]+)*")
_MAKERS = {"fail", "warn", "warn_once", "_warn", "_fail", "_refuse", "refuse", "ExpressionError"}


def codes_in_the_source() -> Iterator[str]:
    """First argument that looks like a code, of every call that makes a diagnostic."""
    for path in (ROOT / "twin" / "nc").rglob("*.py"):
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            if isinstance(node, ast.Call):
                name = getattr(node.func, "attr", getattr(node.func, "id", ""))
                texts = [a.value for a in node.args if isinstance(a, ast.Constant)]
                codes = [t for t in texts if isinstance(t, str) and _CODE.fullmatch(t)]
                if name in _MAKERS and codes:
                    yield codes[0]


def test_every_code_of_the_source_is_explained() -> None:
    assert set(codes_in_the_source()) <= set(findings())


@pytest.mark.parametrize("code", findings())
def test_the_example_earns_its_code(code: str) -> None:
    finding = findings()[code]
    text = "G1 " * 30_000 if code == "line-too-long" else finding.example
    changes: dict[str, Any] = {"tools": {1: ToolData(5.0, 60.0)}, **finding.settings}
    outcome = run(text, finding.dialect, **changes)
    assert code in [*outcome.codes, outcome.error.code if outcome.error else None]
