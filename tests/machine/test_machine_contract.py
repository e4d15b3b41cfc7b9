"""Every shipped machine keeps the contract of a model folder, and the check sees when one does not."""

import shutil

import pytest

from twin.commands.machine import print_check
from twin.errors import ExitCode
from twin.files.shipped import machine_file, machine_names, variant_names
from twin.machine.check import check_machine
from twin.machine.circle.circular_test import circular_test
from twin.machine.describe import describe, shipped_machines
from twin.machine.load import read_machine
from twin.units import MM, UM_PER_MM

POINTS = (
    "the folder is complete",
    "the README derives its numbers step by step",
    "the MJCF file is in order",
    "the model leaves nothing to be supplied",
    "gains and inertias in the MJCF file are those that follow",
    "the model compiles, and every joint is an axis",
    "the machine holds still at home",
    "the machine survives pseudo-random commands",
    "its axes are those of a mill",
)


@pytest.mark.parametrize("name", machine_names())
def test_shipped_machines_keep_the_contract(name):
    findings = check_machine(read_machine(machine_file(name)))
    assert tuple(finding.point for finding in findings) == POINTS
    assert [fault for finding in findings for fault in finding.faults] == []


def broken(tmp_path, file: str, old: str, new: str) -> dict[str, tuple[str, ...]]:
    folder = tmp_path / "mill4"
    shutil.copytree(machine_file("mill4").parent, folder)
    path = folder / file
    text = path.read_text()
    assert old in text
    path.write_text(text.replace(old, new))
    findings = check_machine(read_machine(folder / "machine.toml"))
    return {finding.point: finding.faults for finding in findings if finding.faults}


@pytest.mark.parametrize(
    ("file", "old", "new", "point", "fault"),
    [
        ("machine.toml", "kv = 7.5", "kv = 6.0", POINTS[4], "X: kp is written as"),
        ("machine.toml", 'name = "mill4"', 'name = "mill5"', POINTS[0], "mill5.xml is missing"),
        ("mill4.xml", '<key name="home"', '<key name="zero"', POINTS[2], "there is no keyframe 'home'"),
        ("mill4.xml", '<camera name="tool"', '<camera name="nose"', POINTS[3], "cameras tool are missing"),
        ("mill4.xml", 'group="2" mass="0"', 'group="2" mass="5"', POINTS[2], "geoms add to the masses"),
        ("mill4.xml", "</worldbody>", "</worldbody><custom/>", POINTS[2], "unknown section 'custom'"),
        ("mill4.xml", '<site name="spindle_nose"/>', '<site name="spindle_nose"/><site name="spindle_nose2"/>', POINTS[-1], "site 'spindle_nose2' is a second spindle"),
        ("mill4.xml", '<body name="base"', '<body name="spindle_2"/><body name="base"', POINTS[-1], "body 'spindle_2' is a second spindle"),
        ("README.md", "## Quality", "## Grade", POINTS[1], "no section 'Quality'"),
    ],
)  # fmt: skip
def test_a_broken_contract_is_seen(tmp_path, file, old, new, point, fault):
    faults = broken(tmp_path, file, old, new)
    assert any(fault in found for found in faults.get(point, ())), faults


def test_a_missing_file_is_named_and_no_failure_of_a_machine_that_does_not_ship(tmp_path, capsys):
    folder = tmp_path / "mill4"
    shutil.copytree(machine_file("mill4").parent, folder)
    (folder / "LICENSE").unlink()
    assert print_check(str(folder / "machine.toml")) == ExitCode.OK
    printed = capsys.readouterr().out
    assert "note   the folder is complete (asked of machines that ship)\n" in printed
    assert "         LICENSE is missing\n" in printed
    assert "FAULT" not in printed


def test_a_model_that_does_not_compile_is_a_finding_and_no_traceback(tmp_path):
    faults = broken(tmp_path, "mill4.xml", 'mass="485"', 'mass="-485"')
    assert "mass" in " ".join(faults[POINTS[5]])


def test_the_figures_of_mill4():
    facts = describe(read_machine(machine_file("mill4")), feed=3000.0)
    x = facts.axes[0]
    assert 4.7 <= x.kv <= 8.0
    assert len({(axis.kv, axis.natural_frequency_hz) for axis in facts.axes}) == 1
    assert x.lag == pytest.approx(50.0 / (x.kv * 1000 / 60))
    assert x.moved > x.reflected > 0
    assert facts.spindle_over_table_mm == pytest.approx(620.0)
    assert facts.as_contract()["name"] == "mill4"


def test_the_shipped_machines_come_with_their_variants():
    names = [machine.file.name for machine in shipped_machines()]
    assert names == sorted((*machine_names(), *variant_names()))
    assert "mill4/uncompensated" in names


def test_the_circle_of_the_uncompensated_mill_is_that_of_its_readme():
    """Peaks at most 2 F/kp, hysteresis at most what friction and spring lose together."""
    machine = read_machine(machine_file("mill4/uncompensated"))
    result = circular_test(machine, 50.0, 3000.0)
    readme = (machine.path.parent / "README.md").read_text(encoding="utf-8")
    figures = (result.circular_deviation_um, result.hysteresis_um, result.quadrant_peaks_um[0])
    assert "| mill4/uncompensated | {:.1f} µm | {:.1f} µm | {:.1f} µm |".format(*figures) in readme
    lost = 2 * 480.0 / 170e3 * UM_PER_MM
    assert lost < result.hysteresis_um < 2 * lost + 2 * 480.0 / 6.5e7 / MM * UM_PER_MM
