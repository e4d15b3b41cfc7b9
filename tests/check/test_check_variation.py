"""Sweeps: which runs they ask for, and that the changes reach job and machine."""

import functools
import os
import signal
from pathlib import Path

import pytest
from command_line import Twin

from twin.check.outcome import CheckOutcome
from twin.check.runner import check_variant, run_tasks
from twin.check.task import CheckSettings, JobVariant
from twin.check.variation import variants
from twin.errors import ExitCode, UsageError
from twin.files.toml import changed
from twin.run.preparing.preparation import prepare

JOB = Path(__file__).parents[2] / "programs" / "mefi" / "helix.toml"


def test_every_combination_in_order() -> None:
    found = variants(JOB, ["machine.axes.X.kv=5,7.5", "job.default_feed=100:300:3"])
    assert [tuple(value for _, value in variant.changes) for variant in found] == [
        (5, 100.0), (5, 200.0), (5, 300.0), (7.5, 100.0), (7.5, 200.0), (7.5, 300.0),
    ]  # fmt: skip
    assert str(found[0]).endswith("machine.axes.X.kv=5 job.default_feed=100.0")


@pytest.mark.parametrize(
    "text",
    ["kv=5", "machine.=5", "machine.axes.X.kv", "machine.axes.X.kv=", "machine.axes.X.kv=1:2:x",
     "machine.axes.X.kv=1:2:1", "machine.axes.X.kv=1:2:1e9", "other.key=1"],
)  # fmt: skip
def test_what_says_no_values_is_refused(text: str) -> None:
    with pytest.raises(UsageError, match="--vary"):
        variants(JOB, [text])


def test_a_key_stands_once() -> None:
    with pytest.raises(UsageError, match="twice"):
        variants(JOB, ["job.default_feed=1", "job.default_feed=2"])


def test_changes_go_to_their_own_file_and_leave_the_rest() -> None:
    data = {"axes": {"X": {"kv": 1, "travel": 3}}, "name": "m"}
    changes = [("machine.axes.X.kv", 9), ("job.name", "other")]
    assert changed(data, "machine", changes) == {
        "axes": {"X": {"kv": 9, "travel": 3}},
        "name": "m",
    }
    assert data["axes"] == {"X": {"kv": 1, "travel": 3}}
    with pytest.raises(UsageError, match="no table"):
        changed(data, "machine", [("machine.name.first", 1)])


def test_changes_reach_machine_and_job() -> None:
    changes = [("machine.axes.X.kv", 3.5), ("job.default_feed", 77.0)]
    preparation = prepare(JOB, changes=changes)
    assert preparation.machine.axis("X").kv == 3.5
    assert preparation.settings.default_feed == 77.0


def test_an_unknown_key_is_a_finding_of_its_run() -> None:
    outcome = check_variant(JobVariant(JOB, (("machine.axes.X.kw", 3),)), CheckSettings())
    assert outcome.exit_code is ExitCode.USAGE
    assert "unknown key 'axes.X.kw'" in outcome.findings[0].message
    assert outcome.as_json()["changes"] == {"machine.axes.X.kw": 3}


def check_that_loses_its_worker_once(task: JobVariant) -> CheckOutcome:
    marker = Path(str(dict(task.changes)["job.marker"]))
    if not marker.exists():
        marker.touch()
        os.kill(os.getpid(), signal.SIGKILL)
    return CheckOutcome(
        program=str(task.path), verdict="pass", exit_code=ExitCode.OK, changes=task.changes
    )


@pytest.mark.parametrize("vary", ["machine.axes.X.kw=5,6", "job.nonsense=5"])
def test_a_key_that_does_not_exist_is_a_wrong_command_line(twin: Twin, vary: str) -> None:
    done = twin("sweep", JOB, "--vary", vary, "--jobs", 1)
    assert done.code == 2
    assert "unknown key" in done.stderr


@pytest.mark.processes
def test_a_lost_worker_is_replaced(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    pytest.importorskip("ray", reason="the extra 'cluster' is not installed")
    # What workers import of these files lies beside this one and in the folder above.
    places = Path(__file__).parents[:2]
    monkeypatch.setenv("PYTHONPATH", os.pathsep.join(map(str, places)))
    task = JobVariant(JOB, (("job.marker", str(tmp_path / "died")),))
    found = run_tasks([task], check_that_loses_its_worker_once, jobs=None, cluster="local")
    assert [outcome.verdict for outcome in found] == ["pass"]
    assert (tmp_path / "died").exists()


@pytest.mark.processes
def test_a_cluster_on_this_computer_gives_the_same_outcomes() -> None:
    pytest.importorskip("ray", reason="the extra 'cluster' is not installed")
    tasks = variants(JOB, ["machine.axes.X.kw=1:3:3"])
    check = functools.partial(check_variant, settings=CheckSettings())
    here = list(run_tasks(tasks, check, jobs=1, cluster=None))
    there = list(run_tasks(tasks, check, jobs=None, cluster="local"))
    assert sorted(each.changes for each in there) == [each.changes for each in here]
    assert {each.findings for each in there} == {each.findings for each in here}
