"""The node sets of the companion specifications, put there by ``scripts/fetch_three.py``, not committed."""

from pathlib import Path

from asyncua.server.server import Server

from twin.errors import UsageError

FOLDER = Path(__file__).with_name("nodesets")
DI = "http://opcfoundation.org/UA/DI/"
MACHINERY = "http://opcfoundation.org/UA/Machinery/"
MACHINE_TOOL = "http://opcfoundation.org/UA/MachineTool/"
FILES = (
    "Opc.Ua.Di.NodeSet2.xml",
    "Opc.Ua.IA.NodeSet2.xml",
    "Opc.Ua.Machinery.NodeSet2.xml",
    "opc.ua.isa95-jobcontrol.nodeset2.xml",
    "Opc.Ua.Machinery.Jobs.Nodeset2.xml",
    "Opc.Ua.MachineTool.NodeSet2.xml",
)
"""Each stands on those before it; OPC 40501-1 comes last."""


def require_node_sets() -> None:
    """Refuse where one is missing.

    Raises:
        UsageError: It is.
    """
    for name in FILES:
        if not (FOLDER / name).is_file():
            raise UsageError(
                f"OPC UA's node sets are missing ({FOLDER / name}): run scripts/setup.sh, or python "
                "scripts/fetch_three.py"
            )


async def import_node_sets(server: Server) -> None:
    """Give a server the types of machine tools.

    Args:
        server: Before it is started.

    Raises:
        UsageError: The node sets are not there.
    """
    require_node_sets()
    for name in FILES:
        # Some nodes of DI are for design tools only and have no parent: they are left out.
        await server.import_xml(str(FOLDER / name), strict_mode=False)
