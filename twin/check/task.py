"""What is sent to another process to be checked: a program or a variant, and how to check it.

What runs programs is loaded by the process that runs one, and not by the one that hands them out.
"""

from pathlib import Path

from twin.check.outcome import CheckOutcome
from twin.check.settings import CheckSettings
from twin.check.variation import Variant


def check_program(path: Path, settings: CheckSettings) -> CheckOutcome:
    """Run a job or a program and say how it came out; what is wrong with it becomes a finding."""
    return check_variant(Variant(path, ()), settings)


def check_variant(variant: Variant, settings: CheckSettings) -> CheckOutcome:
    """Run a job with some values of it or of its machine changed, and say how it came out."""
    from twin.check.program import run_variant

    return run_variant(variant, settings)
