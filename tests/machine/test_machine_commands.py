import json
from pathlib import Path

import pytest

from twin.commands.machine import print_check, print_circle, print_machine, print_machines
from twin.errors import ExitCode, UsageError

MODELS = Path(__file__).resolve().parents[2] / "models"
VARIANTS = ("mill4/as_built", "mill4/uncompensated")


def test_the_list_names_every_machine_with_its_axes(capsys):
    print_machines("text")
    lines = capsys.readouterr().out.splitlines()
    told = {line.split()[0]: [word for word in line.split() if len(word) == 1] for line in lines}
    assert set(told) == {*(path.parent.name for path in MODELS.glob("*/machine.toml")), *VARIANTS}
    assert all(told[each] == list("XYZC") for each in ("mill4", *VARIANTS, "mill4_light"))
    assert told["mill3"] == list("XYZ")
    assert told["mill4a"] == list("XYZA")
    assert told["mill5"] == list("XYZAC")
    assert told["mill5h"] == list("XYZBC")
    print_machines("json")
    listed = {each["name"]: each["axes"] for each in json.loads(capsys.readouterr().out)}
    assert listed == told


def test_show_prints_the_lag_at_the_feed(capsys):
    print_machine("mill4", feed=3000.0, form="text")
    out = capsys.readouterr().out
    assert "1041.2" in out
    assert "0.4000" in out
    assert "endless" in out
    print_machine("mill4", feed=3000.0, form="json")
    facts = json.loads(capsys.readouterr().out)
    assert facts["axes"][0]["lag"] == pytest.approx(0.4)


def test_check_tells_point_by_point(capsys):
    assert print_check("mill4_light") == ExitCode.OK
    assert capsys.readouterr().out.count("ok ") == 9


def test_circle_writes_its_plot_and_prints_its_figures(capsys, tmp_path):
    plot = tmp_path / "circle.svg"
    print_circle("mill4", radius=20.0, feed=3000.0, plane="xy", form="json", plot=plot)
    told = json.loads(capsys.readouterr().out)
    assert told["plot"] == str(plot)
    assert told["mean_radius_error_um"] == pytest.approx(-4.0, abs=0.01)
    assert plot.stat().st_size > 10_000
    print_circle(
        "mill4", radius=20.0, feed=3000.0, plane="ZX", form="text", plot=tmp_path / "c.png"
    )
    assert "circular deviation   0.00 µm" in capsys.readouterr().out


def test_wrong_arguments_are_refused(tmp_path):
    with pytest.raises(UsageError, match="known formats are text, json"):
        print_machines("xml")
    with pytest.raises(UsageError, match="feed must be positive"):
        print_machine("mill4", feed=-1.0, form="text")
    with pytest.raises(
        UsageError,
        match=r"shipped machines are mill3, mill4, mill4_light, .*, mill4/as_built, mill4/uncompensated",
    ):
        print_check("mill9")
    with pytest.raises(UsageError, match=r"no plot of kind '\.txt'"):
        print_circle("mill4", radius=20, feed=100, plane="XY", form="text", plot=tmp_path / "a.txt")
    assert list(tmp_path.iterdir()) == []
