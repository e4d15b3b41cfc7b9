"""How many examples a property is tried with."""

from hypothesis import settings


def examples(count: int) -> int:
    """A count of examples, or an eighth of it where the profile ``short`` was chosen, as ``scripts/test`` does."""
    return max(5, count // 8) if settings.get_current_profile_name() == "short" else count
