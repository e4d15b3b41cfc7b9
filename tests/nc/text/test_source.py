"""Programs as bytes."""

import hashlib

import pytest

from twin.nc.text.source import source_from_pieces


@pytest.mark.parametrize(
    "data",
    [
        b"\0\0\0%\nG0 X1\n%\n",
        b"%\nG0 X1\n%\n\0\0",
        b"\0" * 9 + b"%\nG0 X1\n%\n" + b"\0" * 9,
        b"\x12\x7f%\nG0 X1\n%\n\x14",
    ],
)
def test_blank_tape_around_a_program_is_left_out(data: bytes) -> None:
    source = source_from_pieces([data], "part.nc")
    assert list(source.lines) == ["%", "G0 X1", "%"]
    assert source.sha256 == hashlib.sha256(data).hexdigest()


def test_blanks_within_a_program_stay() -> None:
    assert "\0" in source_from_pieces([b"G0 X1\n\0\0G0 X2\n"], "part.nc").text
    assert list(source_from_pieces([b"\0\0\0"], "part.nc").lines) == ["\0"]
