"""Pages of the repository as pages of the site: where each lies there, and what its links become."""

import os
import re
from collections.abc import Mapping
from pathlib import Path, PurePosixPath

ROOT = Path(__file__).resolve().parents[2]

PAGES: Mapping[str, str] = {
    "twin/nc/README.md": "packages/nc.md",
    "twin/motion/README.md": "packages/motion.md",
    "twin/machine/README.md": "packages/machine.md",
    "twin/compare/README.md": "packages/compare.md",
    "twin/cutting/README.md": "packages/cutting.md",
    "twin/coupling/README.md": "packages/coupling.md",
    "twin/render/README.md": "packages/render.md",
    "twin/check/README.md": "packages/check.md",
    "twin/training/README.md": "packages/training.md",
    "twin/calibrate/README.md": "packages/calibrate.md",
    "twin/logs/README.md": "packages/logs.md",
    "twin/serve/README.md": "packages/serve.md",
    "twin/compilation/README.md": "packages/compilation.md",
    "twin/fmu/README.md": "packages/fmu.md",
    "twin/link/README.md": "packages/link.md",
    "twin/nc/dialects/gost.md": "reference/dialects/gost.md",
    "twin/nc/dialects/codesys.md": "reference/dialects/codesys.md",
    "twin/nc/dialects/fagor8070.md": "reference/dialects/fagor8070.md",
    "twin/nc/dialects/mefi.md": "reference/dialects/mefi.md",
    "twin/nc/dialects/grbl.md": "reference/dialects/grbl.md",
    "twin/nc/dialects/heidenhain.md": "reference/dialects/heidenhain.md",
    "twin/nc/dialects/sinumerik.md": "reference/dialects/sinumerik.md",
    "twin/nc/dialects/linuxcnc.md": "reference/dialects/linuxcnc.md",
    "twin/nc/dialects/fanuc.md": "reference/dialects/fanuc.md",
    "twin/nc/dialects/haas.md": "reference/dialects/haas.md",
    "models/mill4/README.md": "machines/mill4.md",
    "models/mill4_light/README.md": "machines/mill4_light.md",
    "models/mill3/README.md": "machines/mill3.md",
    "models/mill4a/README.md": "machines/mill4a.md",
    "models/mill5/README.md": "machines/mill5.md",
    "models/mill5h/README.md": "machines/mill5h.md",
    "CONTRIBUTING.md": "development/contributing.md",
    "scripts/README.md": "development/scripts.md",
    "CHANGELOG.md": "development/changelog.md",
}
"""Where pages of the repository lie on the site."""

PICTURES = "renders"
"""Folder of the pictures that ``scripts/gallery`` makes; it bears the same name on the site."""

_LINK = re.compile(r"(!?)\[((?:[^\[\]]|\[[^\]]*\])*)\]\(([^)\s]+)\)")
_PICTURE_KINDS = (".png", ".webp", ".svg")


def repository_pages() -> dict[str, str]:
    """The text of each page by its address on the site."""
    return {
        address: with_links((ROOT / source).read_text(encoding="utf-8"), source)
        for source, address in PAGES.items()
    }


def pictures() -> dict[str, Path]:
    """Every picture that a page may show, by its address on the site."""
    found = {f"{PICTURES}/{path.name}": path for path in sorted((ROOT / PICTURES).iterdir())}
    for source, address in PAGES.items():
        for path in sorted((ROOT / source).parent.glob("*.png")):
            found[str(PurePosixPath(address).parent / path.name)] = path
    return found


def with_links(text: str, source: str) -> str:
    """A page's text with its links as the site has them.

    Links to pages and pictures lead to them. What the site has no page for, such as a source file,
    keeps its words and loses its link. Code keeps what looks like a link in it.

    Args:
        source: The page's path in the repository.

    Raises:
        ValueError: A link leads to nothing.
    """
    parts = re.split(r"(^```.*?^```|`[^`\n]*`(?!\]))", text, flags=re.MULTILINE | re.DOTALL)
    return "".join(
        part if number % 2 else _LINK.sub(lambda link: _linked(link, source), part)
        for number, part in enumerate(parts)
    )


def _linked(link: re.Match[str], source: str) -> str:
    mark, words, target = link.groups()
    path, _, anchor = target.partition("#")
    if re.match(r"[a-z]+:", target) or not path:
        return link[0]
    named = os.path.normpath(PurePosixPath(source).parent / path)
    if not (ROOT / named).exists():
        raise ValueError(f"{source}: link to {target}, which does not exist")
    here = PurePosixPath(PAGES[source]).parent
    if named in PAGES:
        goal = PAGES[named]
    elif f"{named}/README.md" in PAGES:
        goal = PAGES[f"{named}/README.md"]
    elif named == "twin/nc/dialects":
        goal = "reference/dialects/gost.md"
    elif mark and path.endswith(_PICTURE_KINDS):
        goal = named if named.startswith(PICTURES) else str(here / PurePosixPath(named).name)
    else:
        return words
    return f"{mark}[{words}]({os.path.relpath(goal, here)}{'#' + anchor if anchor else ''})"
