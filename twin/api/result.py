"""The result of a run for interactive use: columns by name, data frames, the part, pictures."""

import contextlib
import dataclasses
import difflib
import html
import weakref
from collections.abc import Iterator
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from twin.errors import ExitCode, RecordingError, UsageError
from twin.extras import require_extra
from twin.nc.canonical import FloatArray
from twin.nc.text.diagnostics.diagnostics import Diagnostic
from twin.recording.alarms import Alarm
from twin.recording.form import COLUMNS, GROWTH, JOINT_COLUMNS, TOOL_COLUMNS
from twin.recording.reader import open_recording
from twin.run.judging.outcome import Outcome
from twin.run.run import Run
from twin.units import UM_PER_MM

if TYPE_CHECKING:
    import pandas as pd
    import trimesh
    from matplotlib.figure import Figure

    from twin.api.viewer import OpenViewer

CONTOUR_COLUMN = "contour_um"
"""Name of the contour error of every sample [µm]."""


class NoSuchColumnError(KeyError, UsageError):
    """A column that a run does not have."""

    def __str__(self) -> str:
        return str(self.args[0])


@dataclasses.dataclass(frozen=True, eq=False)
class Result:
    """A run that was carried out.

    Columns are those of ``recording.h5`` by their names there (``time`` [s], ``line``, ``joint/position``
    [mm or deg], ...), single axes behind a further slash (``joint/position/X``), and ``contour_um``.

    Attributes:
        outcome: Verdict, figures, alarms, scope, final positions.
        assumptions: What was assumed of a program without a job, a line each.
        close: What ends with it: its folder, where nobody asked for one.
    """

    run: Run
    outcome: Outcome
    folder: Path
    assumptions: tuple[str, ...] = ()
    close: contextlib.ExitStack = dataclasses.field(default_factory=contextlib.ExitStack)

    def __post_init__(self) -> None:
        weakref.finalize(self, self.close.close)

    @property
    def ok(self) -> bool:
        """Every tolerance holds and nothing raised an alarm."""
        return self.outcome.verdict.exit_code is ExitCode.OK

    @property
    def verdict(self) -> str:
        """``pass``, ``fail`` or ``alarm``."""
        return self.outcome.verdict.outcome

    @property
    def warnings(self) -> tuple[Diagnostic, ...]:
        """Of the interpreter, the program and the cut, each with its line."""
        return self.outcome.warnings

    @property
    def alarms(self) -> tuple[Alarm, ...]:
        """Of the machine, in order."""
        return self.outcome.alarms

    @property
    def recording(self) -> Path | None:
        """The recording; None where nothing moved."""
        path = self.folder / "recording.h5"
        return path if path.is_file() else None

    @cached_property
    def columns(self) -> tuple[str, ...]:
        """Names that ``result[...]`` takes, those of single axes among them."""
        if self.recording is None:
            return ()
        names = [*COLUMNS, *JOINT_COLUMNS, CONTOUR_COLUMN, *TOOL_COLUMNS, GROWTH]
        found = []
        for name in names:
            values = self._dataset(name)
            if values is not None:
                found += [name, *(f"{name}/{part}" for part in self._parts(values))]
        return tuple(found)

    def __getitem__(self, name: str) -> npt.NDArray[Any]:
        """A column, shape (n,), or (n, k) of all axes at once.

        Raises:
            NoSuchColumnError: There is none of this name; the message lists those that there are.
        """
        if name in self.columns:
            whole, _, part = name.rpartition("/")
            if whole in self.columns:
                values = self._dataset(whole)
                assert values is not None
                return values[:, self._parts(values).index(part)]
            values = self._dataset(name)
            assert values is not None
            return values
        near = difflib.get_close_matches(name, self.columns, 1)
        hint = f"did you mean '{near[0]}'? " if near else ""
        whole = [each for each in self.columns if each[-2:-1] != "/"]
        there = f"columns: {', '.join(whole)}" if whole else "nothing moved: there are none"
        raise NoSuchColumnError(f"no column '{name}': {hint}{there}")

    def column(self, name: str) -> npt.NDArray[Any]:
        """One dataset of the recording, such as ``joint/position``, shape (n,) or (n, k).

        Raises:
            RecordingError: Nothing moved, so that there is none.
        """
        if self.recording is None:
            raise RecordingError("nothing moved: there is no recording")
        with open_recording(self.recording) as recording:
            return recording.column(name)

    def frame(self) -> "pd.DataFrame":
        """All columns, a row for every sample.

        Raises:
            UsageError: pandas is not installed.
        """
        require_extra("notebook", "Result.frame")
        import pandas as pd

        return pd.DataFrame({name: self[name] for name in self.columns if self[name].ndim == 1})

    def by_line(self) -> "pd.DataFrame":
        """Figures of every source line of the program, in the order of the lines.

        Columns ``seconds``, ``contour_um`` (greatest), ``contour_rms_um``, and the greatest following error of
        every axis, ``following/X`` [µm or mdeg].

        Raises:
            UsageError: pandas is not installed.
        """
        require_extra("notebook", "Result.by_line")
        import pandas as pd

        line = self["line"] if self.columns else np.zeros(0, np.int64)
        order = np.argsort(line, kind="stable")
        order = order[line[order] > 0]
        lines, firsts, counts = np.unique(line[order], return_index=True, return_counts=True)
        columns: dict[str, npt.NDArray[Any]] = {
            "seconds": counts * self.run.machine.file.servo_period_s
        }
        if len(order):
            contour = self[CONTOUR_COLUMN][order]
            columns[CONTOUR_COLUMN] = np.maximum.reduceat(contour, firsts)
            columns["contour_rms_um"] = np.sqrt(np.add.reduceat(contour**2, firsts) / counts)
            for name in self.run.machine.axes.names:
                lag = self[f"setpoint/position/{name}"] - self[f"joint/position/{name}"]
                most = np.maximum.reduceat(np.abs(lag[order]), firsts)
                columns[f"following/{name}"] = most * UM_PER_MM
        return pd.DataFrame(columns, index=pd.Index(lines, name="line"))

    @property
    def part(self) -> "trimesh.Trimesh | None":
        """The machined stock in program coordinates [mm]; None where nothing was cut."""
        path = self.folder / "part.stl"
        if not path.is_file():
            return None
        import trimesh

        mesh = trimesh.load_mesh(path)
        assert isinstance(mesh, trimesh.Trimesh)
        return mesh

    @property
    def path(self) -> FloatArray:
        """Where the tool's tip was commanded to be, program coordinates, shape (n, 3) [mm]."""
        return self._tip("setpoint/position")

    @property
    def actual_path(self) -> FloatArray:
        """Where the joints had the tool's tip, program coordinates, shape (n, 3) [mm]."""
        return self._tip("joint/position")

    def plot(self) -> "Figure":
        """The path with its contour error, and the axes over time.

        Raises:
            UsageError: Nothing moved.
        """
        from twin.api.plots import plot_run

        if self.recording is None:
            raise UsageError("nothing moved: there is nothing to draw")
        return plot_run(
            self["time"],
            self.path,
            self[CONTOUR_COLUMN],
            self["joint/position"] - self.run.part_zero,
            self.run.machine.axes,
        )

    def show(self) -> "OpenViewer":
        """Open the viewer, in a notebook's cell or by its link. ``close()`` ends it.

        Raises:
            UsageError: Nothing moved, or a package of the extra ``train`` is missing.
        """
        from twin.api.viewer import OpenViewer

        if self.recording is None:
            raise UsageError("nothing moved: there is nothing to show")
        return OpenViewer(self.recording)

    def _tip(self, name: str) -> FloatArray:
        run = self.run
        zero = run.part_frame.position(run.part_zero[None])[0]
        return run.part_frame.position(self[name]) - zero

    def _dataset(self, name: str) -> npt.NDArray[Any] | None:
        """A whole dataset; None where the recording has none of this name."""
        assert self.recording is not None
        with open_recording(self.recording) as recording:
            if name == CONTOUR_COLUMN:
                return recording.contour_um(0, len(recording))
            try:
                return recording.column(name)
            except RecordingError:
                return None

    def _parts(self, values: npt.NDArray[Any]) -> tuple[str, ...]:
        """Names of a dataset's columns: none of one with a value a sample."""
        if values.ndim == 1:
            return ()
        axes = self.run.machine.axes.names
        return axes if values.shape[1] == len(axes) else ("X", "Y", "Z")

    def _head(self) -> Iterator[tuple[str, str]]:
        """The figures that stand first."""
        contour = self.outcome.figures.contour
        yield "verdict", self.verdict
        if self.outcome.samples:
            yield "contour error", f"{contour.max:.1f} µm (line {contour.worst_line})"
        yield "machine time", f"{self.outcome.duration_s:.3f} s"
        if self.outcome.cut is not None:
            yield "removed", f"{self.outcome.cut.removed_mm3:,.0f} mm³"
        for alarm in self.alarms:
            yield "alarm", f"{alarm.code} (line {alarm.line}): {alarm.message}"
        for reason in self.outcome.verdict.reasons[len(self.alarms) :]:
            yield "fails", f"{reason.what} (line {reason.line}): {reason.message}"
        for warning in self.warnings:
            yield "warning", f"{warning.code} (line {warning.line}): {warning.message}"

    def __repr__(self) -> str:
        listed = ", ".join(
            value if name == "verdict" else f"{name} {value}" for name, value in self._head()
        )
        return f"<Result {self._name}: {listed}>"

    def _repr_html_(self) -> str:
        rows = [*self._head(), *(("", line) for line in self.outcome.scope.lines())]
        cells = "".join(
            f"<tr><th style='text-align:left'>{html.escape(name)}</th>"
            f"<td style='text-align:left'>{html.escape(value)}</td></tr>"
            for name, value in rows
        )
        return f"<table><caption>{html.escape(self._name)}</caption>{cells}</table>"

    @property
    def _name(self) -> str:
        return Path(self.run.preparation.source.name).name
