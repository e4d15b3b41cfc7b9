"""Which line of a program a difference of blocks follows from."""

from twin.compare.changed_lines import changed_codes, changed_lines, differences_by_line
from twin.compare.verdict import Reason

PROGRAM = ["O1", "G0 Z5", "G83 X0 Z-10 Q2", "X10", "X20", "G80", "M30"]
STORED = PROGRAM


def test_empty_lines_change_nothing():
    assert changed_lines(STORED, PROGRAM) == []
    assert changed_lines(STORED, ["", "", *PROGRAM, ""]) == []
    assert changed_lines(STORED, ["", *PROGRAM[:3], "X11", *PROGRAM[4:]]) == [5]


def test_changed_new_and_lost_lines():
    assert changed_lines(STORED, [*PROGRAM[:2], "G83 X0 Z-12 Q2", *PROGRAM[3:]]) == [3]
    assert changed_lines(STORED, [*PROGRAM[:3], "X5", *PROGRAM[3:]]) == [4]
    assert changed_lines(STORED, [*PROGRAM[:5], PROGRAM[6]]) == [6]
    assert changed_lines(STORED, PROGRAM[:-1]) == [6]


def test_another_code_is_told_where_nothing_else_of_its_line_has_changed():
    stored = ["G43 H1", "G41 D1 X5", "#D1=3", "G40", "G41 D2 X5", "G5.1 Q1", "G1 X5", "G54.1 P1"]
    now = ["G43 H2", "", "G41 d2 X5", "#D2=3", "G40", "G41 X5", "G5.1 Q0", "G01 X5", "G54.1 P2"]
    assert list(changed_codes(stored, now)) == [
        (1, "H2, baseline H1"),
        (3, "D2, baseline D1"),
        (6, "no offset, baseline D2"),
        (7, "Q0, baseline Q1"),
        (9, "P2, baseline P1"),
    ]
    assert list(changed_codes(["G1 X5", "G41 D2 X5"], ["X5", "G41 D2 X6"])) == []


def test_what_a_word_of_a_cycle_changes_is_told_once_at_its_line():
    found = [
        Reason("baseline-path", f"ends at Z{z}", line, 0.0) for line in (3, 4, 5) for z in (1, 2)
    ]
    found += [Reason("baseline-feed", "feed 2", 5, 0.0)]
    (only,) = differences_by_line(found, [3])
    told = "ends at Z1; line 5 feed 2 (and 5 more of this change)"
    assert only == Reason("baseline-path", told, 3, 0.0)


def test_a_round_of_a_loop_before_its_changed_line_is_told_there():
    found = [Reason("baseline-path", f"ends at X{x}", 2, 0.0) for x in (1, 2, 3)]
    (only,) = differences_by_line(found, [4])
    assert only == Reason("baseline-path", "line 2 ends at X1 (and 2 more of this change)", 4, 0.0)


def test_without_a_changed_line_all_are_told():
    found = [Reason("baseline-path", "ends at X1", 2, 0.0), Reason("baseline-path", "lost", 3, 0.0)]
    assert list(differences_by_line(found, [])) == found


def test_what_a_line_changes_is_one_finding() -> None:
    reasons = [
        Reason("baseline-path", "ends at X1", 2, 0.0),
        Reason("baseline-feed", "feed 300, baseline 800", 4, 0.0),
        Reason("baseline-feed", "feed 100, baseline 200", 7, 0.0),
    ]
    assert list(differences_by_line(reasons, [2, 7])) == [
        Reason("baseline-path", "ends at X1; line 4 feed 300, baseline 800", 2, 0.0),
        reasons[2],
    ]
