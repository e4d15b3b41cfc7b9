from pathlib import Path

import pytest

from twin.files.atomic import complete_or_absent, write_text


def test_a_file_appears_complete(tmp_path: Path):
    target = tmp_path / "new" / "result.json"
    write_text(target, "žluťoučký Ось")
    assert target.read_text(encoding="utf-8") == "žluťoučký Ось"
    assert list(target.parent.iterdir()) == [target]


def test_a_failure_leaves_what_was_there(tmp_path: Path):
    target = tmp_path / "video.mp4"
    target.write_text("old")

    def write_and_fail() -> None:
        with complete_or_absent(target) as temporary:
            assert temporary.suffix == ".mp4"
            temporary.write_text("half")
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        write_and_fail()
    assert target.read_text() == "old"
    assert list(tmp_path.iterdir()) == [target]
