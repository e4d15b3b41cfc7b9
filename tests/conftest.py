"""Run the command line inside the test's own process, as a shell would see it."""

import os
import sys

import pytest
from command_line import Finished, Twin
from hypothesis import HealthCheck, settings

from twin import cli
from twin.compilation.speed import VARIABLE

# What is compiled beside a run, and when it is ready, would differ from one run of the tests to the next.
os.environ.setdefault(VARIABLE, "wait")
# How long examples take to draw is the machine's load: a property fails by its examples alone.
settings.register_profile(
    "untimed", deadline=None, suppress_health_check=[HealthCheck.too_slow], print_blob=True
)
settings.load_profile("untimed")


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
