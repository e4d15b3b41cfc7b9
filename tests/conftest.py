"""Run the command line inside the test's own process, as a shell would see it."""

import os
import sys

import pytest
from command_line import Finished, Twin

from twin import cli
from twin.compilation.speed import VARIABLE

# What is compiled beside a run, and when it is ready, would differ from one run of the tests to the next.
os.environ.setdefault(VARIABLE, "wait")


@pytest.fixture
def twin(capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch) -> Twin:
    """Call the command with arguments; a traceback would fail the test by itself."""

    def call(*arguments: object) -> Finished:
        monkeypatch.setattr(sys, "argv", ["twin", *map(str, arguments)])
        with pytest.raises(SystemExit) as left:
            cli.main()
        captured = capsys.readouterr()
        return Finished(int(left.value.code or 0), captured.out, captured.err)

    return call
