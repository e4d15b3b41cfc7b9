import subprocess
import sys
from pathlib import Path

import pytest

from twin.errors import RenderError
from twin.render import doctor
from twin.render.drawing import gl
from twin.render.drawing.gl import Probe


@pytest.mark.seconds("processes try each kind of OpenGL")
def test_doctor_finds_opengl_and_encoder() -> None:
    facts = doctor.render_facts()
    assert facts.ready
    assert facts.backend in gl.BACKENDS
    assert facts.renderer
    assert facts.encoder == "libx264"
    assert facts.filament == gl.probe(gl.FILAMENT).renderer


def test_doctor_says_what_to_free(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    low = tmp_path / "meminfo"
    low.write_text("MemTotal: 8000000 kB\nMemAvailable: 100000 kB\n")
    monkeypatch.setattr(doctor, "_MEMORY_FILE", low)
    monkeypatch.setattr(doctor, "LEAST_DISK_MB", 1e12)
    memory, disk = doctor.render_facts().problems
    assert "102 MB of memory are free" in memory
    assert "draft quality" in memory
    assert "--out" in disk
    monkeypatch.setattr(doctor, "_MEMORY_FILE", tmp_path / "none")
    assert doctor.free_memory_mb() is None


def test_probe_of_a_backend_that_cannot_work_says_why() -> None:
    found = gl.probe("no_such_backend")
    assert found.error
    assert not found.renderer


def broken(backend: str) -> Probe:
    return Probe(backend, error=f"lib{backend}.so: cannot open shared object file")


def test_without_opengl_the_message_names_the_packages(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(gl, "probe", broken)
    monkeypatch.delenv("MUJOCO_GL", raising=False)
    with pytest.raises(RenderError, match=r"(?s)libegl.so.*libosmesa.so.*libegl1.*libosmesa6"):
        gl.choose_backend()
    facts = doctor.render_facts()
    assert not facts.ready
    assert "apt-get install" in facts.problems[0]


def test_osmesa_is_taken_where_egl_fails(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv("MUJOCO_GL", raising=False)
    monkeypatch.setattr(
        gl, "probe", lambda name: broken(name) if name == "egl" else Probe(name, renderer="soft")
    )
    assert gl.choose_backend().backend == "osmesa"


def test_the_user_may_name_the_backend(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(gl, "probe", lambda name: Probe(name, renderer=name))
    for name in gl.BACKENDS:
        monkeypatch.setenv("MUJOCO_GL", name)
        assert gl.choose_backend().backend == name


def test_missing_encoder_is_said(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(doctor, "H264_ENCODER", "no_such_encoder")
    assert "no_such_encoder" in doctor.render_facts().problems[0]


def test_osmesa_draws_the_same_scene(tmp_path: Path) -> None:
    if gl.probe("osmesa").error:
        pytest.skip("OSMesa is not installed here")
    code = (
        "import sys, pytest; "
        "sys.exit(pytest.main(['-q', '-p', 'no:cacheprovider', "
        f"'--basetemp={tmp_path / 'osmesa'}', "
        "'tests/render/scene/test_stage.py::test_tool_tip_is_where_the_recording_says']))"
    )
    done = subprocess.run(
        [sys.executable, "-c", code],
        env={"MUJOCO_GL": "osmesa", "PYTHONPATH": ":".join(sys.path), "PATH": "/usr/bin:/bin"},
        cwd=Path(__file__).parents[3],
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stdout
