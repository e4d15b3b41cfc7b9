"""What Studio serves and draws with, with our own additions: fonts, and two scripts for its page.

Studio looks for both folders in its own settings. Each gets a folder of links to Studio's files in
which some are our own.
"""

import contextlib
import os
from collections.abc import Iterator
from importlib import resources
from pathlib import Path

import matplotlib as mpl
from mujoco.studio import web_viewer
from mujoco.studio.web import web_server

_FONTS = {
    "AtkinsonHyperlegibleMono-Regular.ttf": "DejaVuSansMono.ttf",
    "AtkinsonHyperlegibleNext[wght].ttf": "DejaVuSans.ttf",
}
"""Studio's fonts, which have no Cyrillic, and what stands in for them."""

_PAGE = "index.html"
_SCRIPTS = ("drawing.js", "studio_input.js", "press.js")
"""What the page runs before Studio's own code."""
_HEAD = "<head>"


@contextlib.contextmanager
def own_files(folder: Path) -> Iterator[None]:
    """Let Studio serve our files beside its own.

    Args:
        folder: An empty folder of our own.
    """
    assets, page = folder / "assets", folder / "page"
    assets.mkdir()
    page.mkdir()
    _fill_assets(assets)
    _fill_page(page)
    settings = {"MUJOCO_STUDIO_ASSETS_DIR": str(assets), "MUJOCO_WEB_VIEWER_DIST": str(page)}
    before = {name: os.environ.get(name) for name in settings}
    os.environ.update(settings)
    try:
        yield
    finally:
        for name, value in before.items():
            if value is None:
                del os.environ[name]
            else:
                os.environ[name] = value


def _fill_assets(folder: Path) -> None:
    """Studio's assets, with fonts that know Cyrillic and Czech."""
    fonts = Path(mpl.get_data_path()) / "fonts" / "ttf"
    for file in (Path(web_viewer.__file__).parent / "assets").iterdir():
        (folder / file.name).symlink_to(fonts / _FONTS[file.name] if file.name in _FONTS else file)


def _fill_page(folder: Path) -> None:
    """Studio's page, with our scripts at the beginning of its head."""
    own = resources.files("twin.training") / "web"
    for name in _SCRIPTS:
        (folder / name).write_text((own / name).read_text(encoding="utf-8"), encoding="utf-8")
    for file in (Path(web_server.__file__).parent / "dist").iterdir():
        if file.name != _PAGE:
            (folder / file.name).symlink_to(file)
            continue
        head, tail = file.read_text(encoding="utf-8").split(_HEAD, 1)
        scripts = "".join(f'<script src="{name}"></script>' for name in _SCRIPTS)
        (folder / _PAGE).write_text(head + _HEAD + scripts + tail, encoding="utf-8")
