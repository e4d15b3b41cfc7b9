import re

import numpy as np
import pytest

from tests.machine.machine_fixtures import circle
from twin.errors import UsageError
from twin.files.shipped import machine_file
from twin.machine.load import read_machine
from twin.machine.model.model import MachineModel, build_spec
from twin.machine.simulation.simulate import simulate


def write(folder, text: str, name: str = "machine.toml"):
    path = folder / name
    path.write_text(text)
    return path


def test_a_variant_changes_what_it_says_and_nothing_else(tmp_path):
    path = write(
        tmp_path, 'base = "mill4"\nname = "soft"\n[axes.Y]\nkv = 3.0\ntravel = [-10.0, 20.0]\n'
    )
    variant, base = read_machine(path), read_machine(machine_file("mill4"))
    assert variant.file.name == "soft"
    assert (variant.axis("Y").kv, variant.axis("Y").travel) == (3.0, (-10.0, 20.0))
    assert variant.axis("Y").model_copy(update={"kv": 7.5, "travel": (-300.0, 300.0)}) == base.axis(
        "Y"
    )
    assert variant.axis("X") == base.axis("X")
    assert variant.file.path == base.file.path
    assert variant.model_path.samefile(base.model_path)
    build_spec(variant).compile()


def test_variants_stand_on_variants(tmp_path):
    write(tmp_path, 'base = "mill4_light"\n[axes.X]\nkv = 2.0\n', "one.toml")
    path = write(tmp_path, 'base = "one.toml"\n[axes.X]\nbacklash = 0.0\n', "two.toml")
    axis = read_machine(path).axis("X")
    assert (axis.kv, axis.backlash, axis.stiffness) == (2.0, 0.0, 300.0)


def test_a_fourth_axis_under_another_letter_and_a_fifth(tmp_path):
    """Axes are data: any letters, as many as the model has joints."""
    text = machine_file("mill4").read_text()
    folder = machine_file("mill4").parent
    model = (
        (folder / "mill4.xml").read_text().replace('meshdir="assets"', f'meshdir="{folder}/assets"')
    )
    model = model.replace('name="C"', 'name="B"').replace('joint="C"', 'joint="B"')
    write(tmp_path, model, "mill4.xml")
    text = text.replace("scene.xml", "mill4.xml").replace("[axes.C]", "[axes.B]")
    text = text.replace('joint = "C"', 'joint = "B"').replace('axis = "C"', 'axis = "B"')
    machine = read_machine(write(tmp_path, text))
    assert machine.axes.names == ("X", "Y", "Z", "B")
    assert build_spec(machine).compile().nu == 12


def test_a_joint_that_counts_the_other_way_is_turned_round_by_its_direction(tmp_path):
    """X of the model reversed, and told so: the same motion, the same forces."""
    folder = machine_file("mill4").parent
    model = (
        (folder / "mill4.xml").read_text().replace('meshdir="assets"', f'meshdir="{folder}/assets"')
    )
    write(tmp_path, model.replace('axis="-1 0 0"', 'axis="1 0 0"'), "mill4.xml")
    text = machine_file("mill4").read_text().replace("scene.xml", "mill4.xml")
    turned = read_machine(
        write(tmp_path, text.replace('joint = "X"', 'joint = "X"\ndirection = -1'))
    )
    points = circle(20.0, 3000.0, 1.0)
    shipped = read_machine(machine_file("mill4"))
    (same,) = simulate(shipped, MachineModel(shipped), [points])
    (other,) = simulate(turned, MachineModel(turned), [points])
    assert np.array_equal(same.joint_position, other.joint_position)
    assert np.array_equal(same.drive_force, other.drive_force)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ('base = "mill9"\n', "no machine 'mill9': shipped machines are mill3, mill4, mill4_light"),
        ("base = 4\n", "'base' must be a machine's name or a path"),
        ('base = "machine.toml"\n', "leads in a circle"),
        ('base = "mill4"\n[axes.X]\nspeed = 3\n', "unknown key 'axes.X.speed'"),
        ('base = "mill4"\naxes = 3\n', "axes"),
        ('base = "mill4"\nmodel = 7\n', "model"),
        ('base = "mill4"\nmodel = "none.xml"\n', "model 'none.xml' does not exist"),
        (
            'base = "mill4"\n[axes.X.lugre]\nstiffness = 1.0\n',
            "lugre refines dry_friction, which is 0",
        ),
        ('base = "mill4"\n[axes.X]\nlimit_switches = [3.0, 1.0]\n', "must rise"),
        ('base = "mill4"\n[axes.X]\nkv = -1.0\n', "axes.X.kv"),
        ('base = "mill4"\n[axes.X]\nkv = inf\n', "axes.X.kv"),
        ('base = "mill4"\n[axes.Y]\njoint = "X"\n', "joint 'X' is named twice"),
        ('base = "mill4"\n[table]\naxis = "X"\n', "table.axis 'X' is not rotary"),
        (
            'base = "mill4"\n' + 2 * '[[fixtures]]\nname = "jaw"\nsize = [1, 1, 1]\n',
            "fixture 'jaw' is named twice",
        ),
        ('base = "mill4"\n[axes.X]\nmotor_inertia = 0.1\nlead = 0.0\n', "axes.X.lead"),
    ],
)
def test_wrong_machine_files_are_refused_with_what_is_wrong(tmp_path, text, message):
    with pytest.raises(UsageError, match=re.escape(message)):
        read_machine(write(tmp_path, text))


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (
            '[[fixtures]]\nname = "faceplate"\nsize = [1, 1, 1]\n',
            "has the name of a part of the machine",
        ),
        ("[axes.Z]\nstiffness = 1e9\n", "axes.Z.stiffness = 1e+09 swings faster"),
        (
            "[axes.X]\ndry_friction = 9.0\n[axes.X.lugre]\nstiffness = 1e8\n",
            "axes.X.lugre.stiffness = 1e+08 swings faster",
        ),
        ("[axes.X]\nkv = 1000.0\n", "axes.X: with kv = 1000 the motor reacts faster"),
    ],
)
def test_machines_that_cannot_be_simulated_are_refused_with_what_can(tmp_path, text, message):
    machine = read_machine(write(tmp_path, f'base = "mill4"\n{text}'))
    with pytest.raises(UsageError, match=re.escape(message)):
        build_spec(machine)
