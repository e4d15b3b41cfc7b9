"""Whoever writes a scene opens nothing outside its folder."""

import pytest

from twin.errors import ConfigError
from twin.files.shipped import resource_root
from twin.training.scene.scene_file import read_scene

SCENE = """
schema = 1
title = { en = "t" }
story = { en = "s" }
[job]
program = "p.nc"
dialect = "fagor8070"
machine = "MACHINE"
STOCK
[[tasks]]
text = { en = "x" }
finished = true
"""
VARIANT = 'base = "BASE"\nname = "own"\n'
MODEL = '<mujoco><compiler meshdir="meshes"/>ASSET<worldbody/></mujoco>'


@pytest.fixture
def place(tmp_path):
    """A scene's folder; ``secret`` lies beside it."""
    folder = tmp_path / "scene"
    folder.mkdir()
    (folder / "p.nc").write_text("M30\n")
    (tmp_path / "secret.toml").write_text(VARIANT.replace("BASE", "mill4"))
    (tmp_path / "secret.xml").write_text(MODEL.replace("ASSET", ""))
    (tmp_path / "secret.stl").write_text("solid secret\nendsolid secret\n")
    return folder


def scene(folder, machine="mill4", stock=""):
    path = folder / "scene.toml"
    path.write_text(SCENE.replace("MACHINE", machine).replace("STOCK", stock))
    return path


def refused(path):
    with pytest.raises(ConfigError, match="leads out of the scene's folder"):
        read_scene(path)


def test_a_machine_of_the_folder_on_a_shipped_one_may_be_used(place):
    (place / "one.toml").write_text(VARIANT.replace("BASE", "mill4"))
    (place / "two.toml").write_text(VARIANT.replace("BASE", "one.toml"))
    read_scene(scene(place, "two.toml"))


@pytest.mark.parametrize("base", ["../secret.toml", "{outside}/secret.toml", "link.toml", "up"])
def test_no_base_leads_out(place, base):
    (place / "link.toml").symlink_to("../secret.toml")
    (place / "up").symlink_to("..")
    (place.parent / "machine.toml").write_text(VARIANT.replace("BASE", "mill4"))
    text = VARIANT.replace("BASE", base.format(outside=place.parent))
    (place / "one.toml").write_text(text)
    (place / "two.toml").write_text(VARIANT.replace("BASE", "one.toml"))
    refused(scene(place, "one.toml"))
    refused(scene(place, "two.toml"))


@pytest.mark.parametrize("model", ["../secret.xml", "{outside}/secret.xml", "link.xml"])
def test_no_model_leads_out(place, model):
    (place / "link.xml").symlink_to("../secret.xml")
    named = f'model = "{model.format(outside=place.parent)}"\n'
    (place / "one.toml").write_text(VARIANT.replace("BASE", "mill4") + named)
    refused(scene(place, "one.toml"))


@pytest.mark.parametrize(
    "asset",
    [
        '<include file="../secret.xml"/>',
        '<include file="{outside}/secret.xml"/>',
        '<include file="&#46;./secret.xml"/>',
        '<!-- --><include file="link.xml"/>',
        '<include file="inner.xml"/>',
        '<asset><mesh name="m" file="../../secret.stl"/></asset>',
        '<asset><mesh name="m" file="link.stl"/></asset>',
        '<asset><mesh name="m" file="inside/secret.stl"/></asset>',
        '<asset><texture name="t" type="cube" fileright="/etc/hostname"/></asset>',
        '<asset><hfield name="h" file="..\\\\secret.stl"/></asset>',
        '<asset><model name="m" file="../secret.xml"/></asset>',
        '<compiler assetdir="/etc"/>',
        '<compiler meshdir="inside"/>',
    ],
)
def test_no_include_and_no_mesh_leads_out(place, asset):
    (place / "meshes").mkdir()
    (place / "meshes" / "link.stl").symlink_to("../../secret.stl")
    (place / "link.xml").symlink_to("../secret.xml")
    (place / "inside").symlink_to("..")
    (place / "inner.xml").write_text('<mujocoinclude><include file="link.xml"/></mujocoinclude>')
    text = MODEL.replace("ASSET", asset.format(outside=place.parent))
    (place / "own.xml").write_text(text)
    (place / "one.toml").write_text(VARIANT.replace("BASE", "mill4") + 'model = "own.xml"\n')
    refused(scene(place, "one.toml"))


def test_no_stock_and_no_called_file_leads_out(place):
    (place / "part.stl").symlink_to("../secret.stl")
    refused(scene(place, stock='[job.stock]\nshape = "stl"\nfile = "part.stl"'))
    (place / "part.stl").unlink()
    (place / "unused.nc").symlink_to("/etc/passwd")
    (place / "called.nc").symlink_to("../secret.stl")
    read_scene(scene(place))
    (place / "p.nc").write_text("#CALL inner\nM30\n")
    (place / "inner.nc").write_text("G1 X1 F100\n#CALL called\nM17\n")
    with pytest.raises(ConfigError, match=r"inner\.nc: line 2 calls .*called\.nc' leads out"):
        read_scene(scene(place))
    path = scene(place)
    path.write_text(path.read_text().replace('dialect = "fagor8070"\n', ""))
    refused(path)


def test_what_is_no_model_and_what_never_ends_is_refused(place):
    (place / "own.xml").write_text("not XML")
    (place / "one.toml").write_text(VARIANT.replace("BASE", "mill4") + 'model = "own.xml"\n')
    with pytest.raises(ConfigError, match="is not an MJCF model"):
        read_scene(scene(place, "one.toml"))
    (place / "own.xml").write_text('<mujoco><include file="own.xml"/></mujoco>')
    with pytest.raises(ConfigError, match="more than 100 files"):
        read_scene(scene(place, "one.toml"))
    (place / "one.toml").write_text(VARIANT.replace("BASE", "one.toml"))
    with pytest.raises(ConfigError, match="more than 100 files"):
        read_scene(scene(place, "one.toml"))


def test_a_copy_of_a_shipped_machine_may_be_used(place):
    shipped = resource_root("models") / "mill4"
    for path in shipped.rglob("*"):
        target = place / "own" / path.relative_to(shipped)
        if path.is_file() and path.suffix in (".xml", ".toml", ".stl", ".obj", ".png"):
            target.parent.mkdir(parents=True, exist_ok=True)
            target.write_bytes(path.read_bytes())
    read_scene(scene(place, "own"))
