"""``twin plan PROGRAM|JOB``: the cycle time, where it goes, and pictures of the speeds."""

import json
import math
from pathlib import Path

import numpy as np
import typer
from rich.console import Console
from rich.table import Table

from twin.commands.console import table_console
from twin.compilation.announcement import announce_compilation
from twin.errors import UsageError
from twin.motion.report.summary import Summary, summarize
from twin.run.dry_run.dry_run import interpreted
from twin.run.pipeline import planned
from twin.run.preparing.preparation import prepare

MOST_ROWS = 20
"""Blocks in the table for people: those that lose most."""


def plan_and_print(
    path: Path,
    out: Path | None,
    *,
    dialect: str | None,
    machine: str | None,
    form: str,
    strict: bool,
) -> None:
    """Plan a program or a job, print where its time goes and draw its speeds.

    Args:
        out: Folder for ``plan.png``; ``out/<program>`` by default.
        form: ``text`` or ``json``.

    Raises:
        UsageError: The format is unknown, or the program cannot be prepared.
        ProgramError: The program is wrong.
    """
    if form not in ("text", "json"):
        raise UsageError(f"--format {form}: use text or json")
    announce_compilation()
    preparation = prepare(path, dialect=dialect, machine=machine, strict=strict)
    twin_machine, program = preparation.machine, interpreted(preparation)
    summary = summarize(
        program.timed_chunks(),
        twin_machine.motion_limits,
        start=program.start,
        axes=twin_machine.axes,
    )
    folder = out or Path("out") / preparation.job.program.stem
    folder.mkdir(parents=True, exist_ok=True)
    from twin.motion.report.drawing import draw_plan

    picture = folder / "plan.png"
    samples = math.ceil(summary.total / twin_machine.file.servo_period_s)
    draw_plan(planned(program, preparation), twin_machine.axes, samples, picture)
    if form == "json":
        typer.echo(json.dumps(_as_json(summary, picture), indent=2))
    else:
        _print(summary, picture)


def _as_json(summary: Summary, picture: Path) -> dict[str, object]:
    lost = summary.lost()
    return {
        "schema": 1,
        "cycle_s": summary.total,
        "by_cause_s": summary.by_cause(),
        "lost_to_s": summary.by_reason(),
        "ramps_bound_by_s": summary.ramps,
        "blocks": [
            {
                "line": int(summary.line[row]),
                "move": int(summary.move[row]),
                "seconds": float(summary.seconds[row].sum()),
                "lost_s": float(lost[row]),
                "lost_to_s": summary.lost_to[row],
            }
            for row in range(len(summary.line))
        ],
        "plot": str(picture),
    }


def _print(summary: Summary, picture: Path) -> None:
    console = table_console()
    typer.echo(f"cycle time {summary.total:.3f} s, {len(summary.line)} blocks that take time")
    for title, figures in (
        ("time spent", summary.by_cause()),
        ("time lost to", summary.by_reason()),
        ("ramps bound by", summary.ramps),
    ):
        table = Table(box=None, pad_edge=False)
        table.add_column(title, min_width=38)
        table.add_column("s", justify="right")
        table.add_column("share", justify="right")
        for name, seconds in figures.items():
            if seconds > 1e-6:
                table.add_row(name, f"{seconds:.3f}", f"{seconds / summary.total:.1%}")
        if table.row_count:
            typer.echo()
            console.print(table)
    _print_blocks(console, summary)
    typer.echo(f"\ndrawn: {picture}")


def _print_blocks(console: Console, summary: Summary) -> None:
    lost = summary.lost()
    worst = np.sort(np.argsort(-lost, kind="stable")[:MOST_ROWS])
    table = Table(box=None, pad_edge=False)
    for heading in ("line", "s", "lost", "most of it to"):
        table.add_column(heading, justify="left" if heading == "most of it to" else "right")
    for row in worst:
        reasons = summary.lost_to[row]
        reason = max(reasons, key=lambda name: reasons[name]) if reasons else ""
        table.add_row(
            str(summary.line[row]), f"{summary.seconds[row].sum():.3f}", f"{lost[row]:.3f}",
            reason if lost[row] > 1e-6 else "",
        )  # fmt: skip
    if table.row_count:
        left = len(summary.line) - table.row_count
        typer.echo(f"\nblocks{f' that lose most ({left} more)' if left else ''}")
        console.print(table)
