"""What a thread may ask of the processor."""

import os
import sys
import threading

import pytest

from twin import processor
from twin.processor import give_way, take_precedence

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
        give_way()
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
