import pytest

from twin.nc.dialects import DIALECTS
from twin.nc.dialects.pages import describe, overview, page_of


@pytest.mark.parametrize("name", DIALECTS)
def test_the_page_is_that_of_the_declaration(name: str) -> None:
    dialect = DIALECTS[name]
    assert page_of(dialect).read_text(encoding="utf-8") == describe(dialect)


@pytest.mark.parametrize("name", DIALECTS)
def test_every_code_and_decision_is_described(name: str) -> None:
    dialect, text = DIALECTS[name], describe(DIALECTS[name])
    for number in dialect.codes.g:
        assert f"\n| {dialect.code_name(number)} " in text
    for decision in dialect.decisions:
        assert decision.answer in text


@pytest.mark.parametrize("name", DIALECTS)
def test_every_word_that_acts_has_a_meaning(name: str) -> None:
    dialect = DIALECTS[name]
    assert dialect.words.axes | dialect.words.motion | set(dialect.words.actions) <= set(
        dialect.words.meanings
    )


@pytest.mark.parametrize("name", DIALECTS)
def test_codes_in_force_at_the_start_belong_to_different_groups(name: str) -> None:
    dialect = DIALECTS[name]
    groups = [dialect.codes.g[number].group for number in dialect.codes.start]
    assert len(set(groups)) == len(groups)


def test_overview_names_all() -> None:
    assert all(name in overview() for name in DIALECTS)
