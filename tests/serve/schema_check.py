"""Documents of the agent against schemas of MTConnect 2.0: those in a folder, whoever wrote them."""

import xml.etree.ElementTree as ET
from pathlib import Path

import xmlschema

from twin.serve.documents import VERSION

KINDS = ("Devices", "Streams", "Assets", "Error")


class Schemas:
    """The schemas of a folder, ``MTConnectStreams_2.0.xsd`` and its like, in XSD 1.1."""

    def __init__(self, folder: Path) -> None:
        """Read them.

        Raises:
            FileNotFoundError: One is missing.
            xmlschema.XMLSchemaException: One cannot be read.
        """
        paths = {kind: folder / f"MTConnect{kind}_{VERSION}.xsd" for kind in KINDS}
        missing = [path.name for path in paths.values() if not path.is_file()]
        if missing:
            raise FileNotFoundError(f"{folder} does not hold {', '.join(missing)}")
        self._schemas = {
            f"{{urn:mtconnect.org:MTConnect{kind}:{VERSION}}}MTConnect{kind}": xmlschema.XMLSchema11(
                str(path), allow="local"
            )
            for kind, path in paths.items()
        }

    def complaints(self, document: bytes) -> list[str]:
        """What is wrong with a document, as it was sent; empty: nothing."""
        root = ET.fromstring(document)  # noqa: S314 (own agent)
        schema = self._schemas.get(root.tag)
        if schema is None:
            return [f"{root.tag} is no document of MTConnect {VERSION}"]
        return [f"{error.path}: {error.reason}" for error in schema.iter_errors(root)]
