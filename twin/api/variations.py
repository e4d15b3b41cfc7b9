"""Many runs at once: values of a job or its machine varied, over cores or a cluster."""

import functools
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from twin.check.outcome import CheckOutcome
from twin.check.runner import check_variant, run_tasks
from twin.check.task import CheckSettings
from twin.check.variation import combinations
from twin.errors import UsageError
from twin.extras import require_extra
from twin.files.shipped import shipped_program
from twin.run.progress import no_progress, shown_progress

if TYPE_CHECKING:
    import pandas as pd


def sweep(
    program: str | Path,
    vary: Mapping[str, Sequence[object]],
    *,
    machine: str | None = None,
    dialect: str | None = None,
    jobs: int | None = None,
    cluster: str | None = None,
    progress: bool = True,
) -> "pd.DataFrame":
    """Run a job for every combination of values, as ``twin sweep`` does.

    Args:
        program: The job, the program, or a shipped one's name.
        vary: Values by their key: ``machine.axes.X.kv``, ``job.default_feed``.
        jobs: How many at a time; one for each core by default.
        cluster: Address of the Ray cluster to run on instead; ``local`` starts one here.
        progress: Tell on stderr how far it is.

    Returns:
        A row for each combination, in the order of their product, with a column for each key, ``verdict``,
        ``contour_um``, ``worst_line``, ``cycle_time_s``, ``findings``, ``warnings``.

    Raises:
        UsageError: The job is missing, a key or value is none, or pandas is not installed.
    """
    require_extra("notebook", "twin.sweep")
    import pandas as pd

    path = Path(program)
    found = path if path.is_file() else shipped_program(str(program))
    if found is None:
        raise UsageError(f"{program}: no such file")
    tasks = combinations(found, [(key, list(values)) for key, values in vary.items()])
    settings = CheckSettings(machine=machine, dialect=dialect)
    check = functools.partial(check_variant, settings=settings)
    outcomes: dict[tuple[object, ...], CheckOutcome] = {}
    with shown_progress() as shown:
        report = shown if progress else no_progress
        for outcome in run_tasks(tasks, check, jobs=jobs, cluster=cluster):
            outcomes[outcome.changes] = outcome
            report("sweep", len(outcomes) / len(tasks))
    return pd.DataFrame([_row(outcomes[task.changes]) for task in tasks])


def _row(outcome: CheckOutcome) -> dict[str, object]:
    return {
        **dict(outcome.changes),
        "verdict": outcome.verdict,
        "contour_um": outcome.contour_um,
        "worst_line": outcome.worst_line,
        "cycle_time_s": outcome.cycle_time_s,
        "findings": "; ".join(str(found) for found in outcome.findings),
        "warnings": "; ".join(str(found) for found in outcome.warnings),
    }
