"""Reasons for a verdict shown as the interpreter shows errors: place, code, source line."""

from twin.compare.verdict import Reason
from twin.nc.diagnostics import Diagnostic
from twin.nc.source import Source


def reason_text(reason: Reason, source: Source) -> str:
    """Point a reason at the program line that it is about; one about the whole program has none.

    Args:
        reason: Why the run does not pass.
        source: The program that ran.
    """
    if not 0 < reason.line <= len(source.lines):
        return f"{source.name}: error {reason.what}: {reason.message}"
    text = source.lines[reason.line - 1]
    column = len(text) - len(text.lstrip())
    when = f" ({reason.time_s:.3f} s)" if reason.time_s else ""
    return str(
        Diagnostic(
            severity="error",
            code=reason.what,
            message=reason.message + when,
            file=source.name,
            line=reason.line,
            column=column + 1,
            width=max(len(text.strip()), 1),
            source=text,
        )
    )
