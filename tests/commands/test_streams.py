"""A reader who goes away, and an output that knows no µ."""

import os
import subprocess
import sys
from pathlib import Path

import pytest


def twin(*arguments: str, **surroundings: str) -> "subprocess.Popen[bytes]":
    return subprocess.Popen(
        [sys.executable, "-m", "twin", *arguments],
        env=os.environ | surroundings, stdout=subprocess.PIPE, stderr=subprocess.PIPE,
    )  # fmt: skip


@pytest.fixture
def long_program(tmp_path: Path) -> str:
    lines = [f"N{n} G1 X{n % 100} Y{n % 7} F1000" for n in range(1, 450)]
    path = tmp_path / "long.nc"
    path.write_text("\n".join(lines))
    return str(path)


def test_a_closed_pipe_ends_the_command_without_a_complaint(long_program: str):
    process = twin("interpret", long_program, "--dialect", "gost", "--format", "jsonl")
    assert process.stdout is not None
    assert process.stdout.readline().startswith(b'{"type"')
    process.stdout.close()
    assert process.stderr is not None
    assert b"Traceback" not in process.stderr.read()
    process.stderr.close()
    assert process.wait() == 141


@pytest.mark.seconds("a process of the command runs a program")
@pytest.mark.skipif(not Path("/dev/full").exists(), reason="there is no device that is always full")
def test_a_full_disk_behind_the_output_is_told_and_loses_no_file(tmp_path: Path):
    (tmp_path / "part.nc").write_text("N10 G00 X1\n", encoding="utf-8")
    command = ["check", "part.nc", "--dialect", "mefi", "--junit", "twin.xml"]
    with Path("/dev/full").open("w") as full:
        done = subprocess.run(
            [sys.executable, "-m", "twin", *command], cwd=tmp_path, stdout=full,
            stderr=subprocess.PIPE, text=True, check=False,
            env=os.environ | {"PYTHONPATH": str(Path(__file__).parents[2])},
        )  # fmt: skip
    assert done.returncode == 2
    assert "the standard output: the disk is full" in done.stderr
    assert "Traceback" not in done.stderr
    assert (tmp_path / "twin.xml").read_text("utf-8").count("<testcase") == 1


def test_a_narrow_encoding_shows_what_it_can():
    process = twin("explain", "no-feed", PYTHONIOENCODING="ascii")
    out, err = process.communicate()
    assert process.returncode == 0, err
    assert out.decode("ascii")
    code = (
        "from twin.command_line.streams import prepare_streams; prepare_streams(); "
        "print('5 µm – 3° 20 mm² Ω')"
    )
    done = subprocess.run(
        [sys.executable, "-c", code],
        env=os.environ | {"PYTHONIOENCODING": "ascii"}, capture_output=True, check=True,
    )  # fmt: skip
    assert done.stdout == b"5 um - 3deg 20 mm2 \\u03a9\n"
