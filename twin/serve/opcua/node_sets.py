"""The node sets of the companion specifications, put there by ``scripts/fetch_three.py``, not committed."""

from pathlib import Path

from asyncua.server.server import Server

from twin.errors import UsageError

FOLDER = Path(__file__).with_name("nodesets")
DI = "http://opcfoundation.org/UA/DI/"
MACHINERY = "http://opcfoundation.org/UA/Machinery/"
MACHINE_TOOL = "http://opcfoundation.org/UA/MachineTool/"
_VERSION = FOLDER / "VERSION"
"""Written when all are there."""


def require_node_sets() -> None:
    """Refuse where they are missing.

    Raises:
        UsageError: They are.
    """
    if not _VERSION.is_file():
        raise UsageError(
            f"OPC UA's node sets are missing ({FOLDER}): run python scripts/fetch_three.py"
        )


async def import_node_sets(server: Server) -> None:
    """Give a server the types of machine tools.

    Args:
        server: Before it is started.

    Raises:
        UsageError: The node sets are not there.
    """
    require_node_sets()
    # By their numbers: each builds on those before it.
    for file in sorted(FOLDER.glob("*.xml")):
        # Some nodes of DI are for design tools only and have no parent: they are left out.
        await server.import_xml(str(file), strict_mode=False)
