import errno
import os
import threading
from pathlib import Path

import pytest

from twin.files.atomic import complete_or_absent, require_folder, require_writable, write_text


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


def test_a_link_stays_a_link(tmp_path: Path):
    (tmp_path / "elsewhere").mkdir()
    target, link = tmp_path / "elsewhere" / "result.json", tmp_path / "result.json"
    target.write_text("before")
    link.symlink_to(target)
    write_text(link, "after")
    assert link.is_symlink()
    assert target.read_text() == "after"


def test_a_pipe_is_written_to_and_stays_a_pipe(tmp_path: Path):
    pipe = tmp_path / "pipe"
    os.mkfifo(pipe)
    read: list[str] = []
    reader = threading.Thread(target=lambda: read.append(pipe.read_text()))
    reader.start()
    write_text(pipe, "through")
    reader.join()
    assert read == ["through"]
    assert pipe.is_fifo()


def test_a_device_is_not_replaced():
    before = Path("/dev/null").stat().st_ino
    write_text(Path("/dev/null"), "gone")
    assert Path("/dev/null").stat().st_ino == before
    with pytest.raises(OSError, match="the disk is full"):
        write_text(Path("/dev/full"), "text")


@pytest.mark.parametrize("name", ["-", "/dev/stdout"])
def test_the_standard_output_has_names(name: str, capfdbinary: pytest.CaptureFixture[bytes]):
    write_text(Path(name), "µm")
    assert capfdbinary.readouterr().out == "µm".encode()
    assert not Path("-").exists()


def test_outputs_are_tried_beforehand_and_leave_nothing(tmp_path: Path):
    require_writable(tmp_path / "new" / "result.json")
    require_folder(tmp_path / "reports")
    assert list((tmp_path / "new").iterdir()) == []
    (tmp_path / "file").touch()
    with pytest.raises(OSError, match=r"result\.json") as found:
        require_writable(tmp_path / "file" / "result.json")
    assert found.value.filename == str(tmp_path / "file" / "result.json")
    with pytest.raises(IsADirectoryError):
        require_writable(tmp_path)


def test_a_full_disk_is_told_with_the_path_that_was_asked_for(tmp_path: Path):
    target = tmp_path / "result.json"
    with pytest.raises(OSError, match="the disk is full") as told, complete_or_absent(target):
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))
    assert told.value.filename == str(target)
    with pytest.raises(FileNotFoundError) as told, complete_or_absent(target) as temporary:
        temporary.read_bytes()
    assert told.value.filename == str(target)
    with pytest.raises(FileNotFoundError) as told, complete_or_absent(target):
        (tmp_path / "other").read_bytes()
    assert told.value.filename == str(tmp_path / "other")
    assert list(tmp_path.iterdir()) == []
