"""Folders that LinuxCNC's files can name, and others."""

from pathlib import Path

import pytest

from twin.errors import UsageError
from twin.link.linuxcnc import require_plain


@pytest.mark.parametrize(
    ("path", "sign"), [("/home/my parts/out", "a blank"), ("/a/b#c", "'#'"), ("/a/$b", "'\\$'")]
)
def test_a_folder_that_its_files_cannot_name_is_refused_with_the_sign(path: str, sign: str):
    with pytest.raises(UsageError, match=f"holds {sign}: give --out"):
        require_plain(Path(path))


def test_letters_digits_and_dashes_are_plain():
    require_plain(Path("/home/jan_2/Fräsen/out-1.2/linuxcnc"))
