"""What a thread may ask of the processor, and what is made ahead on another one."""

import os
import sys
import threading

import pytest

from twin import processor
from twin.processor import made_ahead, release_precedence, take_precedence

pytestmark = pytest.mark.skipif(sys.platform != "linux", reason="only Linux is asked")


def on_a_thread(action):
    """What an action returns on a thread of its own, whose scheduling ends with it."""
    found = []
    thread = threading.Thread(target=lambda: found.append(action()))
    thread.start()
    thread.join()
    return found[0]


def policy() -> int:
    return os.sched_getscheduler(0) & ~os.SCHED_RESET_ON_FORK


def test_who_is_granted_precedence_has_it_alone_and_gives_it_back(monkeypatch):
    monkeypatch.setattr(processor, "available_cores", lambda: 2)

    def asked():
        granted = take_precedence()
        mine, childs = policy(), on_a_thread(policy)
        release_precedence()
        return granted, mine, childs, policy()

    granted, mine, childs, after = on_a_thread(asked)
    assert mine == (os.SCHED_RR if granted else os.SCHED_OTHER)
    assert (childs, after) == (os.SCHED_OTHER, os.SCHED_OTHER)


def test_who_may_not_goes_on_as_before(monkeypatch):
    def refused(*_):
        raise PermissionError

    monkeypatch.setattr(processor, "available_cores", lambda: 2)
    monkeypatch.setattr(os, "sched_setscheduler", refused)
    assert take_precedence() is False


def test_a_single_core_is_left_to_everybody(monkeypatch):
    monkeypatch.setattr(processor, "available_cores", lambda: 1)
    monkeypatch.setattr(os, "sched_setscheduler", lambda *_: pytest.fail("it was asked for"))
    assert take_precedence() is False


@pytest.fixture(params=[1, 2])
def cores(request, monkeypatch):
    monkeypatch.setattr(processor, "available_cores", lambda: request.param)
    return request.param


def test_items_made_ahead_come_in_order(cores):
    def items():
        for number in range(5):
            yield number, threading.get_ident()

    made = list(made_ahead(items()))
    assert [number for number, _ in made] == [0, 1, 2, 3, 4]
    assert {thread == threading.get_ident() for _, thread in made} == {cores == 1}


@pytest.mark.usefixtures("cores")
def test_an_error_is_raised_behind_the_items_before_it():
    def items():
        yield 1
        raise ValueError("the second cannot be made")

    made = made_ahead(items())
    assert next(made) == 1
    with pytest.raises(ValueError, match="the second"):
        next(made)


def test_who_stops_early_leaves_no_thread_and_at_most_one_item_more(cores):
    made, before = [], threading.active_count()

    def items():
        for number in range(100):
            made.append(number)
            yield number

    for number in made_ahead(items()):
        if number == 3:
            break
    assert threading.active_count() == before
    assert len(made) == 3 + cores
