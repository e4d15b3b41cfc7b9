"""``twin serve --opcua``: the agent's observations in OPC UA, read-only."""

import asyncio
import ipaddress
import logging
import socket
import tempfile
from collections.abc import AsyncIterator, Callable, Mapping
from contextlib import asynccontextmanager
from pathlib import Path
from typing import Any, NamedTuple

import asyncua.ua
from asyncua.crypto.cert_gen import setup_self_signed_certificate
from asyncua.crypto.permission_rules import User, UserRole
from asyncua.crypto.truststore import TrustStore
from asyncua.crypto.validator import CertificateValidator, CertificateValidatorOptions
from asyncua.server import monitored_item_service
from asyncua.server.monitored_item_service import WhereClauseEvaluator
from asyncua.server.server import Server
from asyncua.server.user_managers import UserManager
from cryptography.x509.oid import ExtendedKeyUsageOID

from twin.errors import UsageError
from twin.machine.description.config import MachineConfig
from twin.serve.agent import Agent
from twin.serve.opcua.machine_tool import MachineTool, import_node_sets

ua: Any = asyncua.ua
_URI = "urn:mill-twin:server"
_PERIOD_S = 0.05
"""Between two looks at what the agent observed [s]."""
_MOST_CONNECTIONS = 100
_PATIENCE_S = 5.0
"""A connection that opens no session for so long is closed [s]."""


class Endpoint(NamedTuple):
    """Where a server listens.

    Attributes:
        trusted: Folder of the certificates of clients that may come from elsewhere; None: only this
            computer's clients, without certificates.
    """

    host: str
    port: int
    trusted: Path | None = None

    @property
    def is_local(self) -> bool:
        """Whether nobody but this computer's own programs reaches it."""
        if self.host == "localhost":
            return True
        try:
            return ipaddress.ip_address(self.host).is_loopback
        except ValueError:
            return False


class Content(NamedTuple):
    """What a server reports.

    Attributes:
        tools: Names of its tools by their numbers.
    """

    machine: MachineConfig
    program: str
    tools: Mapping[int, str]


class _Readers(UserManager):
    """Everybody may read, and nobody anything else, whatever name he gives."""

    def get_user(
        self, iserver: Any, username: Any = None, password: Any = None, certificate: Any = None
    ) -> User | None:
        del iserver, username, password, certificate
        return User(role=UserRole.User)


def check_place(place: Endpoint) -> None:
    """Refuse what would be open to anybody, or cannot be listened at.

    Raises:
        UsageError: The address is not this computer's own and no certificates are trusted, or the port
            is taken.
    """
    if not place.is_local and place.trusted is None:
        raise UsageError(
            f"OPC UA without certificates is for this computer's own clients: at {place.host} give "
            "--opcua-trust DIR, a folder with the certificates (.der) of those that may connect"
        )
    if place.trusted is not None and not place.trusted.is_dir():
        raise UsageError(f"{place.trusted}: is no folder of certificates")
    with socket.socket() as probe:
        probe.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        try:
            probe.bind((place.host, place.port))
        except OSError as error:
            raise UsageError(f"OPC UA at {place.host}:{place.port}: {error.strerror}") from error


@asynccontextmanager
async def opcua_server(place: Endpoint, content: Content) -> AsyncIterator[MachineTool]:
    """A server, until the block ends.

    Raises:
        UsageError: The node sets are missing.
    """
    logging.getLogger("asyncua").setLevel(logging.CRITICAL)
    server = Server(user_manager=_Readers())
    # Clients that come later ask for what does not turn (ConditionRefresh).
    server.iserver.bind_condition_methods = 1
    _filter_by_subtypes()
    await server.init()
    server.iserver.max_connections = _MOST_CONNECTIONS
    server.iserver.max_pending_activation_seconds = _PATIENCE_S
    server.allow_remote_admin(False)
    server.set_server_name("mill-twin")
    await server.set_application_uri(_URI)
    server.set_endpoint(f"opc.tcp://{place.host}:{place.port}")
    with tempfile.TemporaryDirectory() as folder:
        await _secure(server, place, Path(folder))
        await import_node_sets(server)
        tool = MachineTool(server, content.machine)
        await tool.build(content.program, content.tools)
        async with server:
            yield tool


async def _secure(server: Server, place: Endpoint, folder: Path) -> None:
    """A certificate of its own; away from this computer nothing but sign and encrypt."""
    key, certificate = folder / "key.pem", folder / "certificate.der"
    await setup_self_signed_certificate(
        key, certificate, _URI, socket.gethostname(), [ExtendedKeyUsageOID.SERVER_AUTH],
        {"commonName": "mill-twin"},
    )  # fmt: skip
    await server.load_certificate(certificate)
    await server.load_private_key(key)
    policies = [ua.SecurityPolicyType.Basic256Sha256_SignAndEncrypt]
    if place.is_local:
        policies.insert(0, ua.SecurityPolicyType.NoSecurity)
    server.set_security_policy(policies)
    server.set_identity_tokens([ua.AnonymousIdentityToken])
    if place.trusted is not None:
        store = TrustStore([place.trusted], [])
        await store.load()
        options = CertificateValidatorOptions.BASIC_VALIDATION | CertificateValidatorOptions.TRUSTED
        server.set_certificate_validator(CertificateValidator(options, store))


async def mirror(
    agent: Agent, place: Endpoint, content: Content, ready: Callable[[str], None] = lambda _: None
) -> None:
    """Publish what an agent observes, until this is cancelled.

    Args:
        ready: Called with the address once clients may connect.
    """
    items = [item.id for part in agent.device.walk() for item in part.items]
    async with opcua_server(place, content) as tool:
        ready(f"opc.tcp://{place.host}:{place.port}")
        newest = 0
        while True:
            found = [one for one in agent.buffer.current(items) if one.sequence > newest]
            for observation in found:
                await tool.update(observation)
            newest = max((one.sequence for one in found), default=newest)
            await asyncio.sleep(_PERIOD_S)


class _SubtypeEvaluator(WhereClauseEvaluator):
    """The library's evaluator, for which a type holds its subtypes.

    OPC UA 10000-4, 7.7.3 has ``OfType`` so; ``asyncua`` compares the event's own type alone, and clients that ask for all
    alarms by ``AlarmConditionType`` or ``AcknowledgeableConditionType`` would receive none.
    """

    def _eval_el(self, index: int, event: Any) -> Any:
        element: Any = self.elements[index]
        if element.FilterOperator != ua.FilterOperator.OfType:
            return super()._eval_el(index, event)
        wanted, kind = self._eval_op(element.FilterOperands[0], event), event.EventType
        while kind is not None and kind != wanted:
            kind = self._supertype(kind)
        return kind is not None

    def _supertype(self, kind: Any) -> Any:
        has_subtype = ua.NodeId(ua.ObjectIds.HasSubtype)
        return next(
            (
                reference.NodeId
                for reference in self._aspace[kind].references
                if reference.ReferenceTypeId == has_subtype and not reference.IsForward
            ),
            None,
        )


def _filter_by_subtypes() -> None:
    """Let servers of this process evaluate filters so."""
    monitored_item_service.WhereClauseEvaluator = _SubtypeEvaluator
