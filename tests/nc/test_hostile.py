"""Files that nobody means well with: a diagnostic, within a second, whatever they hold."""

import random
import time
import tracemalloc

import pytest

from tests.nc import fuzz
from tests.nc.running import SETTINGS, bad
from twin.nc.dialects import DIALECTS, dialect_named
from twin.nc.interpreter import Interpretation
from twin.nc.text.diagnostics.diagnostics import ProgramError
from twin.nc.text.source import read_source, source_from_pieces

MEBIBYTE = 2**20

HOSTILE = {
    "ten megabytes on one line": b"G1 X1 " * (10 * MEBIBYTE // 6),
    "a word of ten megabytes": b"G1 X" + b"9" * 10 * MEBIBYTE,
    "ten megabytes of NUL": b"\0" * 10 * MEBIBYTE,
    "NUL in a block": b"G0 X1\nG0 X\0002\n",
    "an infinite number": b"G1 X" + b"9" * 400,
    "no text at all": bytes(range(256)) * 100,
    "UTF-16": "G1 X5 F100\n".encode("utf-16"),
    "brackets": b"G1 X" + b"[" * 60_000,
    "signs": b"G1 X" + b"-" * 60_000,
    "a name": b"G1 X" + b"ABC" * 20_000,
    "a variable": b"G1 X$" + b"ABC" * 20_000 + b"$",
    "a statement": b"#" + b"ABC" * 20_000,
    "a long sum": b"G1 X" + b"1+" * 30_000 + b"1",
    "not a number": b"G1 Xnan F100",
    "a digit of another script": "G1 X٣ F100".encode(),
}


@pytest.mark.parametrize("dialect", DIALECTS)
@pytest.mark.parametrize("name", HOSTILE)
def test_a_diagnostic_within_a_second(name: str, dialect: str) -> None:
    source = source_from_pieces([HOSTILE[name]], "hostile.nc", dialect_named(dialect))
    begin = time.perf_counter()
    with pytest.raises(ProgramError) as raised:
        list(Interpretation(source, dialect_named(dialect), SETTINGS).chunks())
    assert time.perf_counter() - begin < 1.0
    assert len(str(raised.value)) < 2000


def test_a_line_beyond_any_block_is_refused_before_it_is_read() -> None:
    assert bad("G1 X1 " * 20_000, "gost").code == "line-too-long"


@pytest.mark.parametrize(
    ("dialect", "text"),
    [
        ("mefi", "N1 G0 X1 G73 L1 Q9999999"),
        ("codesys", "N1 G0 X1\nN2 X2\nN3 G20 L1 K1"),
        ("fagor8070", "N1 $GOTO N1"),
        ("fagor8070", "$WHILE 1\nG0 X1\n$ENDWHILE"),
        ("fagor8070", "N1 G0 X1\nX2\nN2\n#RPT[N1,N2,99999999]\nM30"),
        ("fagor8070", "G91 G0 X1 NR9999999"),
    ],
)
def test_endless_programs_end(dialect: str, text: str) -> None:
    assert bad(text, dialect, step_limit=5_000).code == "endless-program"


@pytest.mark.parametrize(
    ("dialect", "text"),
    [
        ("fagor8070", "%L A\nLL A\nM17\n%M\nLL A\nM30"),
        ("codesys", "A{}\nSUBPROGRAM A{}\nA{}\nEND_SUBPROGRAM"),
    ],
)
def test_recursion_ends(dialect: str, text: str) -> None:
    assert bad(text, dialect).code == "call-depth"


def test_memory_does_not_grow_with_the_program() -> None:
    dialect = dialect_named("gost")

    def peak(blocks: int) -> int:
        text = b"G1 F100\n" + b"X1 Y2\nX3 Y4\n" * (blocks // 2)
        interpretation = Interpretation(source_from_pieces([text], "p", dialect), dialect, SETTINGS)
        tracemalloc.start()
        for _ in interpretation.chunks():
            pass
        peak = tracemalloc.get_traced_memory()[1]
        tracemalloc.stop()
        return peak

    peak(20_000)  # The first one loads the compiled tier.
    assert peak(40_000) < 1.2 * peak(10_000)


@pytest.mark.parametrize(
    ("dialect", "page", "text"),
    [("gost", "cp1251", "G0 X1 $ подход"), ("mefi", "cp1250", 'G00 X1 "příklad')],
)
def test_legacy_code_pages(tmp_path, dialect: str, page: str, text: str) -> None:
    path = tmp_path / "old.nc"
    path.write_bytes(text.encode(page))
    assert list(read_source(path, dialect_named(dialect)).lines) == [text]
    assert list(read_source(path).lines) != [text]


@pytest.mark.parametrize("seed", range(4))
def test_nonsense_gives_moves_or_a_diagnostic(seed: int) -> None:
    fuzz.main(500, seed)


def test_mutation_changes_programs() -> None:
    random_ = random.Random(3)  # noqa: S311 (nonsense needs no cryptography)
    data = b"G0 X1\nG1 Y2 F100\n"
    assert sum(fuzz.mutated(random_, data) != data for _ in range(100)) > 90
