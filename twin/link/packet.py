"""The packets that LinuxCNC and the twin exchange every servo period: one layout, declared once.

The component of LinuxCNC is compiled from C; its structures are written from the declarations here
(``c_declaration``), so that both sides cannot differ. All numbers are little-endian and lie at
multiples of their own size, without padding.
"""

import struct
from collections.abc import Sequence
from typing import NamedTuple

VERSION = 1
"""Of the layout: raise it with every change of it."""
MAGIC = 0x4E54574D
"""The letters MWTN: any other packet is dropped."""
JOINTS = 9
"""Places for joints in a packet; a machine has as many of them as it has axes."""
REASON_BYTES = 160

REQUEST_STATES = {"may_run": 1, "leaving": 2, "reset": 4}
"""Bits of a request's ``state``: no emergency stop of LinuxCNC; its last word; the operator's reset."""
ANSWER_STATES = {"may_run": 1}
"""Bits of an answer's ``state``: no alarm of the twin."""


class Field(NamedTuple):
    """One field of a packet.

    Attributes:
        kind: A letter of Python's ``struct``.
        length: How many; 1: no array.
    """

    name: str
    kind: str
    length: int = 1


_HEAD = (Field("magic", "I"), Field("version", "I"), Field("sequence", "Q"))
REQUEST = (
    *_HEAD,
    Field("state", "I"),
    Field("amplifiers", "I"),
    Field("line", "i"),
    Field("motion", "i"),
    Field("command", "d", JOINTS),
    Field("following_error", "d", JOINTS),
)
"""From LinuxCNC: whether it may run, which amplifiers are on (a bit each), ``motion.program-line``,
``motion.motion-type``, the commanded positions of the joints, and what LinuxCNC itself made of the
last answer: their following errors of the period before [mm or deg]."""
ANSWER = (
    *_HEAD,
    Field("state", "I"),
    Field("faults", "I"),
    Field("reason_number", "I"),
    Field("reserved", "I"),
    Field("feedback", "d", JOINTS),
    Field("reason", "s", REASON_BYTES),
)
"""From the twin: whether it may run, which amplifiers are at fault (a bit each), where the joints are
[mm or deg], and why it stopped; the number of a reason rises with each one."""

_C_TYPES = {"I": "uint32_t", "i": "int32_t", "Q": "uint64_t", "d": "double", "s": "char"}


def packed(fields: Sequence[Field]) -> struct.Struct:
    """The layout for Python."""
    return struct.Struct(
        "<" + "".join(f"{field.length if field.length > 1 else ''}{field.kind}" for field in fields)
    )


def c_declaration(name: str, fields: Sequence[Field]) -> str:
    """The layout for C, with an assertion that the compiler lays it out alike."""
    lines = [
        f"    {_C_TYPES[field.kind]} {field.name}{f'[{field.length}]' if field.length > 1 else ''};"
        for field in fields
    ]
    size = packed(fields).size
    return "\n".join(
        [
            f"struct {name} {{",
            *lines,
            "};",
            f'_Static_assert(sizeof(struct {name}) == {size}, "layout of {name}");',
        ]
    )


REQUEST_LAYOUT, ANSWER_LAYOUT = packed(REQUEST), packed(ANSWER)


class Request(NamedTuple):
    """What LinuxCNC asks in a servo period; see ``REQUEST``."""

    sequence: int
    state: int
    amplifiers: int
    line: int
    motion: int
    command: tuple[float, ...]
    following_error: tuple[float, ...]


def read_request(data: bytes | bytearray | memoryview) -> Request | None:
    """Read a request; None for what is none of this version."""
    if len(data) != REQUEST_LAYOUT.size:
        return None
    magic, version, sequence, state, amplifiers, line, kind, *rows = REQUEST_LAYOUT.unpack(data)
    if magic != MAGIC or version != VERSION:
        return None
    return Request(
        sequence, state, amplifiers, line, kind, tuple(rows[:JOINTS]), tuple(rows[JOINTS:])
    )


class Answer(NamedTuple):
    """What the twin answers; see ``ANSWER``."""

    state: int
    faults: int
    reason_number: int
    reason: bytes
    feedback: Sequence[float]


def write_answer(answer: Answer, sequence: int, into: bytearray) -> None:
    """Lay an answer out in a buffer of ``ANSWER_LAYOUT.size`` bytes."""
    ANSWER_LAYOUT.pack_into(
        into, 0, MAGIC, VERSION, sequence, answer.state, answer.faults, answer.reason_number, 0,
        *answer.feedback, answer.reason,
    )  # fmt: skip
