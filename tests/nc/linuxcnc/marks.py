"""The mark of tests that run LinuxCNC's own interpreter; ``oracle`` is used without pytest too."""

import pytest

from tests.nc.linuxcnc.oracle import RS274

NEEDS_RS274 = pytest.mark.skipif(
    RS274 is None, reason="LinuxCNC's rs274 is not installed (linuxcnc-uspace)"
)
