"""What ``twin serve`` sends, against the schemas of MTConnect 2.0 as the MTConnect Institute publishes them.

``TWIN_TEST_MTCONNECT`` names the folder of ``MTConnectDevices_2.0.xsd``, ``MTConnectStreams_2.0.xsd``,
``MTConnectAssets_2.0.xsd`` and ``MTConnectError_2.0.xsd``; they lie in the institute's repository ``mtconnect/schema``.
"""

import os
import time
import urllib.error
import urllib.request
from collections.abc import Iterator
from pathlib import Path

import pytest

from tests.serve.agent_attacks import serving
from tests.serve.schema_check import Schemas
from twin.files.shipped import resource_root

pytestmark = [
    pytest.mark.oracle,
    pytest.mark.by_hand(
        "TWIN_TEST_MTCONNECT names the folder of the schemas, which no package brings"
    ),
    pytest.mark.seconds("a machine is watched while it makes a part"),
]
GOOD = resource_root("programs") / "codesys" / "semicircle_by_radius.toml"
WATCHED_S = 15.0
"""Longer than a part and its alarm take."""
TARGETS = (
    "/probe", "/current", "/current?path=//Controller", "/sample?count=1000", "/sample?count=-100",
    "/sample?from=999999999", "/sample?count=x", "/lathe/current", "/assets",
)  # fmt: skip


def answers(address: str) -> Iterator[bytes]:
    """Of an agent, to everything that it can be asked, again and again for some time."""
    end = time.monotonic() + WATCHED_S
    while time.monotonic() < end:
        for target in TARGETS:
            try:
                with urllib.request.urlopen(address + target, timeout=20) as answer:  # noqa: S310 (own agent)
                    yield answer.read()
            except urllib.error.HTTPError as error:
                yield error.read()
        time.sleep(1.0)


PART = 'program = "part.nc"\ndialect = "gost"\nmachine = "{}"\n[part_zero]\nX = {}\n'
JOBS = {"an alarm": ("mill4", 395.0), "five axes": ("mill5h", 0.0), "three axes": ("mill3", 0.0)}


@pytest.mark.parametrize("name", ["a part", *JOBS])
def test_every_answer_is_valid(tmp_path: Path, name: str) -> None:
    schemas = Schemas(Path(os.environ["TWIN_TEST_MTCONNECT"]))
    job = GOOD
    if name in JOBS:
        job = tmp_path / "part.toml"
        job.write_text(PART.format(*JOBS[name]))
        turns = " B15 C30" if name == "five axes" else ""
        (tmp_path / "part.nc").write_text(f"G1 X20{turns} F600\nM30\n")
    with serving(job) as served:
        found = list(answers(f"http://{served.host}:{served.port}"))
    assert len(found) >= len(TARGETS)
    assert {complaint for each in found for complaint in schemas.complaints(each)} == set()
