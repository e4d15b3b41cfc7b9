"""A Russian control with G102, the recalculation of periodic rotary axes.

The control's page says all about G102; the rest is the base of ISO 6983-1 and GOST 20999-83.
"""

import math
import re

from twin.nc.canonical import Corner
from twin.nc.control.codes import Codes, Words
from twin.nc.control.control import Control, Rules
from twin.nc.control.dialect import Decision, Dialect
from twin.nc.iso import base, shared_marks
from twin.nc.iso.declared import modal, replacement
from twin.nc.iso.drilling import fixed_cycles
from twin.nc.text.syntax import HEADING, Comment, Mark, Syntax

RESOLUTION = 9
"""Decimals of a degree that a start point is rounded to before the remainder is taken.

Decision: three G91 moves of 120° must count as 360, whatever binary fractions add up to.
"""


_FOREIGN_COMMAND = re.compile(
    rb"\((?:UAO|UOT|UIO|MIR|ROT|SCF|RPT|ERP|CLS|EPP|GTO|BNC|DLY|DIS|RQO|RQU|URT|ASS|DPT|UVC|UPR)"
    rb"(?:,[^()]*)?\)"
)
"""Commands of that family: a word of three letters in brackets, often with values behind it."""


def _periods(control: Control) -> dict[int, float]:
    """Periods of the axes whose start point is recalculated, by column [deg]."""
    assert isinstance(control.memory, dict)
    return control.memory


def warn_of_foreign_commands(control: Control) -> None:
    """Bracket comments that a neighbouring family of controls would run: (RPT,3), (UAO,1)."""
    lines = control.program_counter.lines
    if not lines.any_holds(_FOREIGN_COMMAND):
        return
    for number, line in enumerate(lines, 1):
        match = _FOREIGN_COMMAND.search(line.encode("ascii", "replace"))
        if match is not None:
            control.report.line = number
            message = f"{match[0].decode()} is a comment here and a command of the NC-200 family"
            hint = "if the program is meant for that control, nothing here runs it"
            control.report.warn("foreign-command", message, match.start(), len(match[0]), hint=hint)


def switch_recalculation(control: Control) -> None:
    """G102: ``C360`` switches the recalculation of C on with period 360, ``C0`` off."""
    words = control.take_axis_words()
    if not words:
        control.fail("g102-axis", "G102 needs a periodic axis", hint="write G102 C360 or G102 C0")
    periodic = sorted(control.settings.periodic)
    for index, word in words:
        if word.address not in control.settings.periodic:
            message = f"{word.address} is not declared as a periodic axis on this machine"
            hint = f"periodic axes: {', '.join(periodic) or 'none'}"
            control.fail("not-periodic", message, word, hint=hint)
        period = control.number(word)
        if period < 0.0:
            control.fail("g102-period", f"{word.text} is no period", word, "360, or 0 for off")
        if period == 0.0:
            _periods(control).pop(index, None)
        else:
            _periods(control)[index] = period


def recalculate_start(control: Control, rapid: bool) -> None:
    """Give every recalculated axis the remainder of its start point; the table stands still.

    The remainder keeps the sign of the start point (control page, example 7), as C's ``fmod`` does.
    Decision: in blocks of interpolation only, as the page says, unless the machine's
    ``recalculate_on_rapid`` is set; and in blocks without the axis too, since the page speaks of
    the block's start point.
    """
    periods = _periods(control)
    if not periods or (rapid and not control.settings.recalculate_on_rapid):
        return
    programmed = list(control.motion.programmed)
    for index, period in periods.items():
        old = round(programmed[index], RESOLUTION)
        if abs(old) >= period:
            programmed[index] = math.fmod(old, period)
    if programmed != control.motion.programmed:
        control.motion.set_position(programmed, "turns")


_CYRILLIC_WORD = re.compile("[А-Яа-яЁё]{2}")
_PROSE = re.compile(r"[ \t]*[А-Яа-яЁё]{4}")
_READABLE_WORD = re.compile(r"[ \t]*[A-Z][ \t]*[+-]?[0-9.]", re.IGNORECASE)


def excuse(line: str, previous: str) -> str | None:
    """Why a line that is no block may be left out.

    The control's document breaks long comments over two printed lines and shows omitted blocks by
    dots; programs copied from it hold both. Decision: a line of Cyrillic prose right after a line
    with a comment is that comment's tail, as long as it does not begin with a readable word; and
    a line that begins with a Cyrillic word of four letters or more, as no block does, is a heading.
    """
    if base.is_ellipsis(line):
        return "ellipsis"
    prose = _CYRILLIC_WORD.search(line) and not _READABLE_WORD.match(line)
    if prose and ("$" in previous or _PROSE.match(line)):
        return "comment-tail"
    return None


DECISIONS = (
    Decision(
        "Does the recalculation touch G0?",
        "No: interpolated blocks (G1, G2, G3) only; the machine's recalculate_on_rapid turns it on.",
        "The page says 'in the mode of interpolation'.",
        example="rapid_is_not_recalculated",
    ),
    Decision(
        "When does a start point count as a whole turn?",
        "It is rounded to 1e-9 degree before the remainder is taken.",
        "Three incremental moves of 120 degrees must count as 360.",
        example="three_thirds_are_a_turn",
    ),
    Decision(
        "What if G102 names an axis that is not periodic?",
        "A program error that names the axis and the machine's periodic axes.",
        "The page reserves G102 for axes that are configured as periodic.",
        example="axis_not_periodic",
    ),
    Decision(
        "What does the coordinate become after G102 C0?",
        "The relabelled coordinate stays.",
        "Switching off ends the recalculation; it does not undo it.",
        example="label_stays",
    ),
    Decision(
        "How does a path pass its corners?",
        "Exactly; G9 and G61 stop, G64 returns to the exact path.",
        "Nothing in the page allows the tool to leave the programmed path.",
        example="exact_path",
    ),
    Decision(
        "What is a line of prose?",
        "Behind a line with a comment its tail, left out with a warning, unless it begins with a "
        "readable word; so are lines of dots, and lines that begin with a Cyrillic word of four "
        "letters or more.",
        "The control's document breaks long comments, shows omitted blocks by dots and has headings.",
        example="comment_tail",
    ),
    Decision(
        "What does F count?",
        "mm/min along the path of X, Y, Z; deg/min where only rotary axes move.",
        "1200 degrees per minute is the only sensible reading of the page's G1 C359.999 F1200.",
        example="feed_of_rotary_axes",
    ),
    *base.DECISIONS,
)

GOST = Dialect(
    name="gost",
    title="Russian control with G102 (ISO 6983-1, GOST 20999-83)",
    code_page="cp1251",
    syntax=Syntax(comments=(Comment("$"), Comment("(", ")"), HEADING), excused=excuse),
    codes=Codes(
        groups=base.GROUPS,
        g={
            **base.CODES,
            **fixed_cycles.RETURN,
            9: modal(
                "exact stop in this block",
                non_modal=True,
                basis="decision",
                corner=Corner.EXACT_STOP,
            ),
            61: modal("exact stop mode", "corner", basis="decision", corner=Corner.EXACT_STOP),
            64: modal("exact path mode", "corner", basis="decision", corner=Corner.EXACT_PATH),
            102: replacement(
                "recalculation of a periodic axis: C360 on, C0 off",
                switch_recalculation,
                basis="control page",
            ),
        },
        replacements=base.REPLACEMENTS,
        start=(*base.START, 64, 98),
        m=base.M_CODES,
    ),
    words=Words(
        actions=base.WORDS,
        meanings=base.WORD_MEANINGS,
    ),
    rules=Rules(
        memory=dict,
        before_motion=recalculate_start,
        prepare=warn_of_foreign_commands,
        acts_on_lines=lambda control: bool(_periods(control)),
    ),
    units="mm, degrees; F in mm/min, for rotary axes alone in deg/min",
    decisions=DECISIONS,
    marks=(
        Mark(r"\bG102[ \t]*[ABC][ \t]*360(?![.\d])", "G102 C360"),
        shared_marks.G102,
        Mark(r"^[^$;\"]*(?:\$\w+\$[^$;\"]*)*\$(?=\s|$|[А-Яа-я])", "$ before a comment"),
    ),
)
