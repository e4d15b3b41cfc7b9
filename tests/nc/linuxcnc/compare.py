"""``scripts/fuzz rs274 10000 7``: so many random programs, from that seed on, through twin and ``rs274``."""

import collections
import sys
import time

from tests.nc.linuxcnc.oracle import RS274, by_twin, compared
from tests.nc.linuxcnc.random_programs import contour, program
from tests.nc.linuxcnc.wide_programs import wide, wide_contour

SHOWN = 60
KINDS = (contour, program, wide, wide_contour, program, wide, program, wide, program, wide)
"""Which programs follow each other."""


def main(count: int = 1000, seed: int = 0) -> int:
    """Compare; the exit status."""
    if RS274 is None:
        print("rs274 is not installed (Debian: linuxcnc-uspace)")
        return 2
    begin, differ = time.monotonic(), 0
    said: collections.Counter[str] = collections.Counter()
    decided: collections.Counter[str] = collections.Counter()
    for number in range(seed, seed + count):
        text = KINDS[number % len(KINDS)](number)
        found, decisions = compared(text)
        decided.update(decisions)
        if not found:
            said["refused by both" if by_twin(text).error else "run by both"] += 1
        else:
            differ += 1
            if differ <= SHOWN:
                print(f"--- seed {number}\n{text}{found}\n")
    seconds = time.monotonic() - begin
    print(f"{count} programs in {seconds:.0f} s: {dict(said)}, {differ} differ")
    print(f"by decision: {dict(decided)}")
    return 1 if differ else 0


if __name__ == "__main__":
    sys.exit(main(*map(int, sys.argv[1:])))
