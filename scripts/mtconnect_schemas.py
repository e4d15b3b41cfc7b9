"""What ``twin serve`` sends, held against the schemas of MTConnect 2.0 in a folder.

``scripts/mtconnect_schemas FOLDER [ADDRESS]``: the folder holds ``MTConnectDevices_2.0.xsd``,
``MTConnectStreams_2.0.xsd``, ``MTConnectError_2.0.xsd`` and what these import (``xlink.xsd``), as the MTConnect
Institute publishes them. Without an address two jobs are served, of which one ends in an alarm.
"""

import sys
import tempfile
import time
import urllib.error
import urllib.request
from collections.abc import Iterator
from pathlib import Path

from agent_attacks import serving

from tests.serve.schema_check import Schemas

ROOT = Path(__file__).resolve().parents[1]
GOOD = ROOT / "programs" / "codesys" / "semicircle_by_radius.toml"
LEAVES_TRAVEL = (
    'program = "part.nc"\ndialect = "gost"\n[part_zero]\nX = 395.0\n',
    "G1 X20 F600\nM30\n",
)
"""A job whose program goes over the end of X."""
WATCHED_S = 15.0
"""Longer than a part and its alarm take."""
TARGETS = (
    "/probe", "/current", "/current?path=//Controller", "/sample?count=1000", "/sample?count=-100",
    "/sample?from=999999999", "/sample?count=x", "/lathe/current", "/assets",
)  # fmt: skip


def main() -> int:
    """Print what is wrong; 1 where something is."""
    if len(sys.argv) not in (2, 3):
        print(__doc__, file=sys.stderr)
        return 2
    try:
        schemas = Schemas(Path(sys.argv[1]))
    except FileNotFoundError as error:
        print(error, file=sys.stderr)
        return 2
    seen, wrong = 0, set[str]()
    for document in _documents(sys.argv[2:]):
        seen += 1
        wrong |= set(schemas.complaints(document))
    print("\n".join(sorted(wrong)))
    print(f"{seen} documents, {len(wrong)} complaints")
    return int(bool(wrong))


def _documents(address: list[str]) -> Iterator[bytes]:
    if address:
        yield from _told(address[0].rstrip("/"))
        return
    with tempfile.TemporaryDirectory() as name:
        job, program = (Path(name) / each for each in ("part.toml", "part.nc"))
        for path, text in zip((job, program), LEAVES_TRAVEL, strict=True):
            path.write_text(text, encoding="utf-8")
        for each in (GOOD, job):
            with serving(each) as served:
                yield from _told(f"http://{served.host}:{served.port}")


def _told(address: str) -> Iterator[bytes]:
    """Answers of an agent to everything that it can be asked, again and again for some time."""
    end = time.monotonic() + WATCHED_S
    while time.monotonic() < end:
        for target in TARGETS:
            try:
                with urllib.request.urlopen(address + target, timeout=20) as answer:  # noqa: S310 (own agent)
                    yield answer.read()
            except urllib.error.HTTPError as error:
                yield error.read()
        time.sleep(0.1)


if __name__ == "__main__":
    sys.exit(main())
