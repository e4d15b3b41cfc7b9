"""One layout for both sides: Python's is held against C's own rules of alignment."""

import ctypes
import shutil
import subprocess

import pytest

from twin.link.packet import ANSWER, REQUEST, c_declaration, packed, read_request

KINDS = {
    "I": ctypes.c_uint32,
    "i": ctypes.c_int32,
    "Q": ctypes.c_uint64,
    "d": ctypes.c_double,
    "s": ctypes.c_char,
}


@pytest.mark.parametrize("fields", [REQUEST, ANSWER])
def test_every_field_lies_where_c_puts_it(fields):
    class Layout(ctypes.Structure):
        _fields_ = [
            (
                field.name,
                KINDS[field.kind] * field.length if field.length > 1 else KINDS[field.kind],
            )
            for field in fields
        ]

    assert ctypes.sizeof(Layout) == packed(fields).size
    for number, field in enumerate(fields):
        assert getattr(Layout, field.name).offset == packed(fields[:number]).size


@pytest.mark.skipif(shutil.which("cc") is None, reason="no C compiler")
@pytest.mark.parametrize(("name", "fields"), [("request", REQUEST), ("answer", ANSWER)])
def test_the_declaration_is_c(tmp_path, name, fields):
    source = tmp_path / "layout.c"
    source.write_text(f"#include <stdint.h>\n{c_declaration(name, fields)}\n")
    subprocess.run(["cc", "-std=c11", "-fsyntax-only", str(source)], check=True)


def test_strangers_packets_are_dropped():
    size = packed(REQUEST).size
    assert read_request(b"") is None
    assert read_request(bytes(size)) is None
    assert read_request(bytes(size - 1)) is None
    assert read_request(bytes(size + 1)) is None
