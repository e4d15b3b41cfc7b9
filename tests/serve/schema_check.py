"""Documents of the agent against schemas of MTConnect 2.0: those in a folder, whoever wrote them."""

import xml.etree.ElementTree as ET
from pathlib import Path

import xmlschema

from twin.serve.documents import VERSION

KINDS = ("Devices", "Streams", "Assets", "Error")


TIME_SERIES = "TimeSeriesType"
"""How types of the official schemas end, of series of samples, in which ``xmlschema`` does not see that they
take over the mixed content of their base. The agent sends none."""


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
            f"{{urn:mtconnect.org:MTConnect{kind}:{VERSION}}}MTConnect{kind}": _read(path)
            for kind, path in paths.items()
        }

    def complaints(self, document: bytes) -> list[str]:
        """What is wrong with a document, as it was sent; empty: nothing."""
        root = ET.fromstring(document)  # noqa: S314 (own agent)
        schema = self._schemas.get(root.tag)
        if schema is None:
            return [f"{root.tag} is no document of MTConnect {VERSION}"]
        return [f"{error.path}: {error.reason}" for error in schema.iter_errors(root)]


def _read(path: Path) -> xmlschema.XMLSchema11:
    """Read a schema.

    Raises:
        xmlschema.XMLSchemaException: Something of it cannot be read that is no type of series of samples.
    """
    schema = xmlschema.XMLSchema11(str(path), allow="local", validation="lax")
    for error in schema.all_errors:
        if not str(getattr(error.validator, "local_name", "")).endswith(TIME_SERIES):
            raise error
    return schema
