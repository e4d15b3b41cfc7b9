"""``twin train`` as a stranger meets it."""

import contextlib
import http.client
import json
import re
import signal
import subprocess
import sys
import urllib.parse
from pathlib import Path

import pytest
from typer.testing import CliRunner

from twin.cli import app
from twin.errors import TwinError
from twin.training.scene.scene_file import scene_names

PATIENCE_S = 120.0


def test_the_list_names_every_scene_in_the_language_asked_for() -> None:
    done = CliRunner().invoke(app, ["train", "--list"])
    assert done.exit_code == 0, done.output
    lines = done.stdout.splitlines()
    assert [line.split()[0] for line in lines] == list(scene_names())
    assert "Three quarters of a circle" in done.stdout
    russian = CliRunner().invoke(app, ["train", "--list", "--language", "ru"])
    assert "Где деталь?" in russian.stdout


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["nope"], "no scene 'nope': shipped scenes are codesys_arc_or_line"),
        (["--language", "de"], "the panel speaks en, ru, it, cs"),
        pytest.param(
            ["--host", "192.0.2.1"], "give --certificate and --key", marks=pytest.mark.three_js
        ),
        pytest.param(["--host", "::"], "give --certificate and --key", marks=pytest.mark.three_js),
        pytest.param(
            ["--certificate", "nowhere.pem"],
            "no certificate with its key",
            marks=pytest.mark.three_js,
        ),
        pytest.param(
            ["--key", "nowhere.pem"], "belongs to a --certificate", marks=pytest.mark.three_js
        ),
        (["--port", "99999"], ""),
        (["--out", __file__], "that is a file"),
        (["--out", f"{__file__}/results"], f"{__file__} is a file"),
        (["--seats", "2", "--out", f"{__file__}/class"], f"{__file__} is a file"),
        (["--class", "nowhere.csv"], "nowhere.csv: No such file"),
        (["--seats", "61"], "a class has 1 to 60 seats"),
        (["--class", "nowhere.csv", "--seats", "2"], "give --class ROSTER.csv, or --seats"),
    ],
)
def test_what_cannot_be_opened_is_refused(arguments: list[str], message: str) -> None:
    done = CliRunner().invoke(app, ["train", *arguments])
    refusal = done.exception
    if isinstance(refusal, TwinError):
        assert int(refusal.exit_code) == 2
        assert message in str(refusal)
    else:
        assert done.exit_code == 2
        assert not message


@pytest.mark.three_js
@pytest.mark.parametrize(
    ("number", "visited"),
    [
        pytest.param(signal.SIGINT, True, marks=pytest.mark.seconds("the room is opened")),
        pytest.param(signal.SIGINT, False, marks=pytest.mark.processes),
        pytest.param(signal.SIGTERM, False, marks=pytest.mark.processes),
    ],
)
def test_the_room_opens_on_loopback_and_an_asked_end_keeps_the_sheet(
    tmp_path: Path, number: signal.Signals, visited: bool
) -> None:
    command = [sys.executable, "-m", "twin", "train", "mefi_lead", "--out", str(tmp_path)]
    with (
        subprocess.Popen(
            command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
        ) as twin,
        contextlib.ExitStack() as at_the_end,
    ):
        # Else a failed assertion would wait for a room that nobody closes.
        at_the_end.callback(twin.kill)
        assert twin.stdout is not None
        first = twin.stdout.readline()
        found = re.fullmatch(r"mefi_lead: open (\S+) in a browser; Ctrl\+C ends\n", first)
        assert found, first
        address = urllib.parse.urlsplit(found[1])
        assert (address.hostname, address.path, address.query) == ("127.0.0.1", "/operator/", "")
        for role in ("trainer", "watcher"):
            other = urllib.parse.urlsplit(twin.stdout.readline().split(": ")[1].strip())
            assert other.path == f"/{role}/"
            assert other.fragment != address.fragment
        if visited:
            page = http.client.HTTPConnection("127.0.0.1", address.port or 0, timeout=PATIENCE_S)
            page.request("GET", address.path)
            assert page.getresponse().status == 200
            page.close()
        twin.send_signal(number)
        rest, errors = twin.communicate(timeout=PATIENCE_S)
    assert twin.returncode == 0, errors
    assert not errors
    assert "mefi_lead: 0 of 10 points; sheet in" in rest
    folder = next(tmp_path.glob("mefi_lead_*"))
    assert json.loads((folder / "score.json").read_text(encoding="utf-8"))["handed_in"] is False
    assert {file.name for file in folder.iterdir()} == {"score.json", "score.html", "log.jsonl"}
