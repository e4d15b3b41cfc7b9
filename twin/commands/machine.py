"""``twin machine``: list, show, check the machines, and run the circular test on one."""

import json
import sys
from pathlib import Path
from typing import TYPE_CHECKING

from twin.compilation.announcement import announce_compilation
from twin.errors import ExitCode, UsageError
from twin.files.shipped import machine_file
from twin.machine.describe import MachineFacts, describe, shipped_machines
from twin.machine.description.config import MachineConfig
from twin.machine.description.kinematics import in_words
from twin.machine.load import read_machine

if TYPE_CHECKING:
    from twin.machine.circle.circular_test import CircularTest

FORMATS = ("text", "json")
PLOTS = (".svg", ".png", ".pdf")


def print_machines(form: str) -> None:
    """Print the shipped machines with their axes.

    Raises:
        UsageError: The format is unknown.
    """
    _require_format(form)
    machines = shipped_machines()
    if form == "json":
        _print_json([{"name": m.file.name, "axes": list(m.axes.names)} for m in machines])
        return
    for machine in machines:
        sys.stdout.write(f"{machine.file.name:24}{' '.join(machine.axes.names):12}{machine.path}\n")


def print_machine(name: str, *, feed: float, form: str) -> None:
    """Print a machine's figures.

    Args:
        name: A shipped machine's name, or a machine file.
        feed: What the expected lag is given for [mm/min or deg/min].
        form: ``text`` or ``json``.

    Raises:
        UsageError: No such machine, an unknown format, a feed that is none.
        ConfigError: The machine file or its model is wrong.
    """
    _require_format(form)
    if not 0 < feed < float("inf"):
        raise UsageError(f"feed must be positive, not {feed:g}")
    facts = describe(_machine(name), feed)
    if form == "json":
        _print_json(facts.as_contract())
        return
    sys.stdout.write("\n".join(_fact_lines(facts)) + "\n")


def print_check(name: str) -> ExitCode:
    """Check a machine's folder against its contract and print point by point.

    Returns:
        ``FAILED`` where a point is not kept that is not only for machines that ship.
    """
    machine = _machine(name)
    from twin.machine.check import check_machine

    findings = check_machine(machine)
    for finding in findings:
        verdict = "note " if finding.notice else "FAULT"
        meant = " (asked of machines that ship)" if finding.notice else ""
        sys.stdout.write(f"{verdict if finding.faults else 'ok   '}  {finding.point}{meant}\n")
        for fault in finding.faults:
            sys.stdout.write(f"         {fault}\n")
    if not findings[-1].faults:
        sys.stdout.write(f"{in_words(machine.axes.names, machine.kinematics)}\n")
    failed = any(finding.faults and not finding.notice for finding in findings)
    return ExitCode.FAILED if failed else ExitCode.OK


def print_circle(
    name: str, *, radius: float, feed: float, plane: str, form: str, plot: Path
) -> None:
    """Run the circular test, draw it and print its figures.

    Args:
        name: A shipped machine's name, or a machine file.
        radius: [mm].
        feed: [mm/min].
        plane: ``XY``, ``ZX``, ``YZ``, or with the table ``XYC``, ``ZXB``, ``YZA``.
        form: ``text`` or ``json``.
        plot: Where the picture goes; its suffix tells the kind.

    Raises:
        UsageError: The machine cannot run that circle, or an argument is unknown.
        OSError: The picture cannot be written.
    """
    _require_format(form)
    if plot.suffix not in PLOTS:
        raise UsageError(f"no plot of kind '{plot.suffix}': known are {', '.join(PLOTS)}")
    from twin.machine.circle.circle_plot import write_circle_plot
    from twin.machine.circle.circular_test import circular_test

    announce_compilation()
    result = circular_test(_machine(name), radius, feed, plane.upper())
    write_circle_plot(result, plot)
    if form == "json":
        _print_json(result.as_contract(str(plot)))
        return
    sys.stdout.write("\n".join([*_circle_lines(result), f"plot                 {plot}"]) + "\n")


def _machine(name: str) -> MachineConfig:
    return read_machine(machine_file(name))


def _require_format(form: str) -> None:
    if form not in FORMATS:
        raise UsageError(f"no format '{form}': known formats are {', '.join(FORMATS)}")


def _print_json(value: object) -> None:
    sys.stdout.write(f"{json.dumps(value, ensure_ascii=False)}\n")


def _fact_lines(facts: MachineFacts) -> list[str]:
    lines = [
        (
            f"{facts.name}: servo period {facts.servo_period_s * 1e3:g} ms, spindle nose "
            f"{facts.spindle_over_table_mm:.1f} mm over the table with all axes at zero"
        ),
        "linear axes in mm and kg, rotary ones in deg and kg m²",
        "",
        (
            f"{'axis':5}{'travel':>16}{'rapid/min':>11}{'accel/s²':>10}{'jerk/s³':>10}{'Kv':>7}"
            f"{'moved':>12}{'reflected':>12}{'Hz':>7}{'lag at ' + format(facts.feed, 'g'):>14}"
        ),
    ]
    for axis in facts.axes:
        travel = "endless" if axis.travel is None else f"{axis.travel[0]:g} to {axis.travel[1]:g}"
        lines.append(
            f"{axis.name:5}{travel:>16}{axis.velocity:>11g}{axis.acceleration:>10g}{axis.jerk:>10g}"
            f"{axis.kv:>7g}{axis.moved:>12.5g}{axis.reflected:>12.5g}"
            f"{axis.natural_frequency_hz:>7.1f}{axis.lag:>14.4f}"
        )
    return lines


def _circle_lines(result: "CircularTest") -> list[str]:
    largest, smallest = result.radial_deviation_um
    peaks = zip(result.quadrant_names, result.quadrant_peaks_um, strict=True)
    return [
        f"{result.machine}, circle {result.plane}, R {result.radius_mm:g} mm, F {result.feed:g} mm/min",
        f"circular deviation   {result.circular_deviation_um:.2f} µm",
        f"hysteresis           {result.hysteresis_um:.2f} µm",
        f"radial deviation     {largest:+.2f} / {smallest:+.2f} µm",
        f"mean radius error    {result.mean_radius_error_um:+.2f} µm",
        "quadrant peaks       " + ", ".join(f"{name} {peak:+.2f}" for name, peak in peaks) + " µm",
    ]
