"""The first Ctrl+C is the regular end, the second an interruption."""

import signal

import pytest

from twin.commands.interruption import let_interruption_stop

NUMBERS = (signal.SIGINT, signal.SIGTERM)


@pytest.mark.parametrize("number", NUMBERS)
def test_the_first_stops_and_the_second_interrupts(number: signal.Signals) -> None:
    def interrupt(number: int, _: object) -> None:
        raise KeyboardInterrupt(number)

    before = {each: signal.signal(each, interrupt) for each in NUMBERS}
    stops: list[None] = []
    try:
        with let_interruption_stop(lambda: stops.append(None)) as came:
            signal.raise_signal(number)
            assert came == [number]
            assert len(stops) == 1
            with pytest.raises(KeyboardInterrupt):
                signal.raise_signal(number)
        assert len(stops) == 1
    finally:
        for each, handler in before.items():
            signal.signal(each, handler)


def test_what_interrupted_before_does_so_again() -> None:
    before = {each: signal.getsignal(each) for each in NUMBERS}
    with let_interruption_stop(lambda: None) as came:
        assert all(signal.getsignal(each) != before[each] for each in NUMBERS)
    assert not came
    assert {each: signal.getsignal(each) for each in NUMBERS} == before
