"""What a dialect understands, as a page made from its declaration.

``python -m twin.nc.dialects.pages`` writes the pages beside the dialects' modules; a test keeps them so.
"""

from collections.abc import Iterable, Sequence
from pathlib import Path

from twin.files.atomic import write_text
from twin.nc.control.codes import GCode
from twin.nc.control.dialect import Dialect
from twin.nc.dialects import DIALECTS, OWN
from twin.nc.dialects.feed_tables import feed_rows

_BASIS = {
    "control page": "the control's own page",
    "manual": "the control's manuals",
    "decision": "decided here",
}

_REFUSED = (
    "Codes that the control knows and the twin does not follow. Any other G code is unknown and "
    "refused as well."
)


def overview() -> str:
    """One line for each dialect."""
    width = max(len(name) for name in DIALECTS)
    return "\n".join(f"{d.name:{width}}  {d.title}" for d in DIALECTS.values()) + "\n"


def describe(dialect: Dialect) -> str:
    """The page of one dialect, as Markdown."""
    supported = {n: code for n, code in dialect.codes.g.items() if not code.refused}
    refused = {n: code for n, code in dialect.codes.g.items() if code.refused}
    start = ", ".join(map(dialect.code_name, sorted(dialect.codes.start)))
    sections = [
        f"# {dialect.title} (`{dialect.name}`)",
        "Made from the declaration in this folder by `python -m twin.nc.dialects.pages`.",
        f"Units: {dialect.units}.",
        f"Comments: {_comments(dialect)}. Files are read as UTF-8, else as {dialect.code_page}.",
        *(
            (
                f"In force when a program starts: {start}.",
                "## G codes",
                _g_table(dialect, supported),
            )
            if supported
            else ()
        ),
        "## M codes",
        _m_table(dialect),
        "## Words",
        _word_table(dialect),
        *_expression_sections(dialect),
        *_feed_sections(dialect),
        *(
            section
            for title, rows in dialect.tables.items()
            for section in (f"## {title}", _table(("word", "meaning"), rows.items()))
        ),
        *(("## Refused", _REFUSED, _refused_table(dialect, refused)) if supported else ()),
        "## Decisions where the documents are silent",
        f"Each is shown by a program of `tests/golden/{dialect.name}/decisions`.",
        _decisions(dialect),
        "## Told apart by",
        _marks(dialect),
    ]
    return "\n\n".join(section for section in sections if section) + "\n"


def _marks(dialect: Dialect) -> str:
    """What tells its programs from others, with the controls that know it too."""
    lines: list[str] = []
    for mark in dialect.marks:
        others = [
            each.name
            for each in OWN.values()
            if each.name != dialect.name and mark.shown in {other.shown for other in each.marks}
        ]
        lines.append(f"- {mark.shown}" + (f"; known to {', '.join(others)} too" if others else ""))
    return "\n".join(lines)


def _comments(dialect: Dialect) -> str:
    return ", ".join(
        f"`{comment.opening} {comment.closing}`"
        if comment.closing
        else f"`{comment.opening}` to the end of the line"
        + (", where it begins one" if comment.whole_line else "")
        for comment in dialect.syntax.comments
    )


def _g_table(dialect: Dialect, codes: dict[float, GCode]) -> str:
    rows = [
        (
            dialect.code_name(number),
            code.meaning,
            code.group or ("this block" if code.non_modal else ""),
            _BASIS[code.basis],
        )
        for number, code in sorted(codes.items())
    ]
    return _table(("code", "meaning", "group", "known from"), rows)


def _m_table(dialect: Dialect) -> str:
    rows = [
        (
            f"M{number}",
            code.meaning,
            "after the motion" if code.after_motion else "before the motion",
        )
        for number, code in sorted(dialect.codes.m.items())
    ]
    if dialect.codes.any_m:
        rows.append(("any other", "a function of the machine", "before the motion"))
    return _table(("code", "meaning", "when"), rows)


def _word_table(dialect: Dialect) -> str:
    """Words by their meanings, those of the same meaning in one row."""
    rows: dict[str, list[str]] = {}
    for word, meaning in sorted(dialect.words.meanings.items()):
        rows.setdefault(meaning, []).append(word)
    return _table(("word", "meaning"), [(" ".join(words), text) for text, words in rows.items()])


def _feed_sections(dialect: Dialect) -> list[str]:
    """What F counts in every kind of move; the column of inverse time where the control has it."""
    if dialect.name not in OWN:
        return []
    rows, timed = feed_rows(dialect.name), 93 in dialect.codes.g
    head = ("move", "F as a rate", *(("F of G93",) if timed else ()), "known from")
    cells = [(r.kind, r.rate, *((r.inverse,) if timed else ()), r.basis) for r in rows]
    return [
        "## What F counts",
        f"Each cell is shown, with its time, by a program of `tests/golden/{dialect.name}/feeds`.",
        _table(head, cells),
    ]


def _expression_sections(dialect: Dialect) -> list[str]:
    syntax = dialect.syntax.expressions
    if syntax is None:
        return []
    operators = " ".join(f"`{name}`" for name in syntax.operators)
    functions = ", ".join(f"`{name}`" for name in sorted(syntax.functions))
    keywords = ", ".join(f"`{name}`" for name in sorted(dialect.codes.statements))
    opening, closing = syntax.brackets
    return [
        "## Computed values and program flow",
        f"Operators: {operators}. Brackets: `{opening} {closing}`.",
        f"Functions: {functions}.",
        f"Statements: {keywords}.",
    ]


def _refused_table(dialect: Dialect, codes: dict[float, GCode]) -> str:
    if not codes:
        return "None."
    rows = [
        (dialect.code_name(number), code.meaning, code.refused)
        for number, code in sorted(codes.items())
    ]
    return _table(("code", "meaning", "why"), rows)


def _decisions(dialect: Dialect) -> str:
    return "\n".join(
        f"- **{each.question}** {each.answer} *{each.reason}* (`{each.example}.nc`)"
        for each in dialect.decisions
    )


def _table(head: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    """A table whose columns are as wide as their widest cell, to be read as it is."""
    cells = [[cell.replace("|", "\\|") for cell in line] for line in (head, *rows)]
    widths = [max(map(len, column)) for column in zip(*cells, strict=True)]
    cells.insert(1, ["-" * width for width in widths])
    return "\n".join(
        "| "
        + " | ".join(cell.ljust(width) for cell, width in zip(line, widths, strict=True))
        + " |"
        for line in cells
    )


def page_of(dialect: Dialect) -> Path:
    """Where the dialect's page lies."""
    return Path(__file__).with_name(f"{dialect.name}.md")


def write_pages() -> None:
    """Write every page again."""
    for dialect in OWN.values():
        write_text(page_of(dialect), describe(dialect))


if __name__ == "__main__":
    write_pages()
