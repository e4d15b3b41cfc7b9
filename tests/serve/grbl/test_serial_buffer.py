from hypothesis import given
from hypothesis import strategies as st

from twin.serve.grbl.serial_buffer import BUFFER_SIZE, SerialBuffer, cleaned


def test_realtime_commands_are_taken_out_wherever_they_stand() -> None:
    serial = SerialBuffer()
    assert serial.receive(b"G1 X?5!\x91\nG0") == [ord("?"), ord("!"), 0x91]
    assert serial.pop() == (b"G1 X5", False)
    assert serial.head is None
    assert serial.free == BUFFER_SIZE - 2


def test_a_reset_forgets_what_came_before_it() -> None:
    serial = SerialBuffer()
    assert serial.receive(b"G1 X5\nG\x18G0 X1\n") == [0x18]
    assert serial.pop() == (b"G0 X1", False)


def test_what_finds_no_room_is_lost_and_its_line_is_known_to_be_damaged() -> None:
    serial = SerialBuffer()
    serial.receive(b"G4 P1\n" + b"X" * 200 + b"\n")
    assert serial.lost == 6 + 200 + 1 - BUFFER_SIZE
    assert serial.pop() == (b"G4 P1", False)
    serial.receive(b"\n")
    line, damaged = serial.pop()
    assert damaged
    assert len(line) == BUFFER_SIZE - 6
    assert serial.free == BUFFER_SIZE


def test_lines_are_cleaned_as_grbl_does() -> None:
    assert cleaned(b"g1 x5 (to (the) side) /y2 ; and so on") == "G1X5SIDE)Y2"
    assert cleaned(b"  (only a comment") == ""


@given(st.lists(st.binary(max_size=90)))
def test_room_and_lines_always_agree(pieces: list[bytes]) -> None:
    serial = SerialBuffer()
    for piece in pieces:
        serial.receive(piece)
        assert 0 <= serial.free <= BUFFER_SIZE
        while serial.head is not None and len(piece) % 2:
            serial.pop()
    while serial.head is not None:
        serial.pop()
    serial.receive(b"\n")
    if serial.head is not None:
        serial.pop()
        assert serial.free == BUFFER_SIZE


def test_a_line_without_an_end_can_be_forgotten_and_gives_its_room_back():
    buffer = SerialBuffer()
    buffer.receive(b"G1 X1\nG1 X1")
    buffer.forget_open()
    buffer.receive(b"0 F100\n")
    assert [buffer.pop()[0], buffer.pop()[0]] == [b"G1 X1", b"0 F100"]
    assert buffer.free == BUFFER_SIZE
