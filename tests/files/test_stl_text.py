"""A solid that is written is the solid that trimesh reads, and writes to the same triangles."""

import io

import numpy as np
import trimesh

from twin.files.stl import stl_text


def test_what_is_written_is_what_trimesh_writes():
    solid = trimesh.creation.icosphere(subdivisions=2, radius=12.5)
    solid.apply_translation([3.0, -40.0, 0.1])
    text = stl_text(np.asarray(solid.triangles))
    exported = solid.export(file_type="stl")
    assert isinstance(exported, bytes)
    assert text[80:84] == exported[80:84]
    record = np.dtype([("floats", "<f4", 12), ("attributes", "<u2")])
    ours, theirs = (np.frombuffer(each[84:], record)["floats"] for each in (text, exported))
    assert np.array_equal(ours[:, 3:], theirs[:, 3:])
    assert np.allclose(ours[:, :3], theirs[:, :3], atol=1e-5)
    again = trimesh.load_mesh(io.BytesIO(text), file_type="stl")
    assert again.is_watertight


def test_nothing_is_an_empty_file_and_a_flat_triangle_has_no_normal():
    assert stl_text(np.zeros((0, 3, 3)))[80:] == bytes(4)
    flat = np.frombuffer(stl_text(np.ones((1, 3, 3)))[84:96], "<f4")
    assert np.array_equal(flat, np.zeros(3))
