"""Which O-words of a program belong together, and what a line with one says."""

import re
from collections.abc import Iterator
from typing import NamedTuple

from twin.nc.control.constructs import Construct, Structure
from twin.nc.control.control import Control
from twin.nc.dialects.linuxcnc.memory import memory_of
from twin.nc.text.blocks import Statement
from twin.nc.text.comments import NO_COMMENT, comment_marks, without_comments
from twin.nc.text.library import Library
from twin.nc.text.source import Source
from twin.nc.text.syntax import Comment

FILE = "%FILE "
"""Begins the line in front of a subroutine's file."""
KEYWORDS = (
    "SUB", "ENDSUB", "CALL", "RETURN", "IF", "ELSEIF", "ELSE", "ENDIF", "WHILE", "ENDWHILE", "DO",
    "REPEAT", "ENDREPEAT", "BREAK", "CONTINUE",
)  # fmt: skip
_LABEL = r"<[^<>]*>|[0-9](?:[0-9 \t]*[0-9])?(?:[ \t]*\.(?:[0 \t]*0)?)?"
"""Regular expression of a label that is not computed; a number of its own may end in ``.0``."""
_LINE = re.compile(
    rf"[ \t]*/?[ \t]*(?:N[ \t]*[0-9.]+[ \t]*)?O[ \t]*({_LABEL})[ \t]*([A-Z]*)", re.IGNORECASE
)
_BEGIN = re.compile(r"[ \t]*/?[ \t]*(?:N[ \t]*[0-9.]+[ \t]*)?O", re.IGNORECASE)
_COMPUTED = re.compile(r"[ \t]*[#\[]")
_WORD = re.compile(rf"[ \t]*({_LABEL}|#[^\[ \t]*|\[[^\]]*\])[ \t]*([A-Z]*)[ \t]*", re.IGNORECASE)
COMMENTS = (Comment("(", ")", holds_opening=False), Comment(";"))
_MARKS = comment_marks(COMMENTS)
_ENDS = {
    **{f"END{keyword}": keyword for keyword in ("SUB", "IF", "WHILE", "REPEAT")},
    "WHILE": "DO",
}
_BRANCHES = {"ELSEIF": "IF", "ELSE": "IF"}
LOOPS = ("WHILE", "DO", "REPEAT")


class OWord(NamedTuple):
    """What a line with an O-word says.

    Attributes:
        label: As it is written, ``100`` or ``<name>``, without blanks.
        keyword: Upper case; empty for the beginning of a program that M98 calls.
        column: Where that stands, from 0.
    """

    label: str
    keyword: str
    text: str
    column: int

    @property
    def name(self) -> str:
        """O and label as a program writes them."""
        plain = self.label.isdigit() or self.label.startswith(("#", "["))
        return f"o{self.label}" if plain else f"o<{self.label}>"

    @property
    def shown(self) -> str:
        """The same with the keyword."""
        return f"{self.name} {self.keyword.lower()}".rstrip()


def name_of_label(label: str) -> str:
    """One spelling for all forms of a label."""
    label = re.sub(r"\s", "", label).lower()
    return label[1:-1] if label.startswith("<") else str(int(label.partition(".")[0]))


def named_o_word(line: str) -> tuple[str, str] | None:
    """Label and keyword, in upper case, of a line's O-word; None where it has none with a label of its own."""
    match = _LINE.match(line)
    return None if match is None else (name_of_label(match[1]), match[2].upper())


def o_word(statement: Statement) -> OWord | None:
    """Read a statement; None where it is none."""
    text, _ = without_comments(statement.text, _MARKS)
    match = _WORD.match(text)
    if match is None:
        return None
    label = match[1] if match[1][0] in "#[" else name_of_label(match[1])
    return OWord(label, match[2].upper(), text[match.end() :], statement.text_column + match.end())


def is_garbled(text: str) -> bool:
    """Whether a line holds an open comment, or begins as one with an O-word and is none."""
    said, wrong = without_comments(text, _MARKS)
    if wrong != NO_COMMENT:
        return True
    begin = _BEGIN.match(text)
    if begin is None or _COMPUTED.match(text, begin.end()):
        return False
    match = _LINE.match(text)
    if match is None:
        return True
    return match[2].upper() not in KEYWORDS if match[2] else said[match.end() :].strip() != ""


def structure(control: Control) -> Structure:
    """Which O-words of the program belong together; the first time its subroutines are found as well."""
    memory = memory_of(control)
    if memory.structure is not None:
        return memory.structure
    memory.structure = structure = Structure(_ENDS, _BRANCHES)
    for line, text in enumerate(control.program_counter.lines):
        if text.startswith(FILE):
            structure.close()
        if structure.is_open and is_garbled(text):
            memory.garbled.append(line)
        if "O" in text.upper() and (named := named_o_word(text)) is not None:
            name, keyword = named
            if keyword in ("SUB", ""):
                memory.subroutines.setdefault(name, []).append(line)
            structure.add(keyword, line, name)
    return structure


def lines_to_read(control: Control, construct: Construct) -> list[int]:
    """Lines, from 0, that the control reads where it passes over a definition.

    They are those within it and at its end whose O-word has its label, but for calls (``rs274``).
    """
    assert construct.end is not None
    lines = control.program_counter.lines
    inner = range(construct.begin + 1, construct.end + 1)
    named = ((line, named_o_word(lines[line])) for line in inner)
    return [
        line for line, word in named if word and word[0] == construct.name and word[1] != "CALL"
    ]


def scope(control: Control, line: int) -> str:
    """The subroutine that a line, from 0, lies in; labels of others are not its own."""
    around = structure(control).around(line)
    return next((f"{each.begin}#" for each in around if each.keyword == "SUB"), "#")


_PROGRAM = re.compile(r"\bM[ \t]*0*98[ \t]*P[ \t]*([0-9]+)", re.IGNORECASE)
_SOMEWHERE = re.compile(rb"CALL|M[ \t]*0*98", re.IGNORECASE)


def _calls(source: Source) -> Iterator[str]:
    if source.lines.any_holds(_SOMEWHERE):
        for line in source.lines:
            named = named_o_word(line)
            if named is not None and named[1] == "CALL":
                yield named[0].upper()
            elif (program := _PROGRAM.search(line)) is not None:
                yield str(int(program[1]))


LIBRARY = Library(_calls, FILE, (".ngc", ".nc"))
