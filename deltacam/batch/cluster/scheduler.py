"""Where the scheduler of a cluster is, how it and we know each other, and whether it answers."""

from __future__ import annotations

import re
import socket
import ssl
from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from typing import Final, TypeVar

from deltacam.errors import DeltacamError
from deltacam.plain import plain

Loaded = TypeVar("Loaded")

DEFAULT_PORT: Final = 8786

_ADDRESS: Final = re.compile(r"(?:(tcp|tls)://)?(\[[0-9A-Fa-f:.]+\]|[^\s/:@\[\]]+):([0-9]{1,5})/?")
_THREE_FILES: Final = "give --tls-ca FILE, --tls-cert FILE and --tls-key FILE"
_PORTS: Final = range(1, 65536)
_GREETING: Final = b"pickle-protocol"
_AT_FIRST: Final = 2.0  # s
_LONGEST_GREETING: Final = 65536
_ALERT: Final = "ALERT"
"""What OpenSSL calls a refusal by the other side."""

_SHOWN: Final = 200  # characters


@dataclass(frozen=True, slots=True)
class Tls:
    """The files by which a cluster and its clients know each other, all of them PEM.

    Attributes:
        ca_file: the certificate of the authority that signed all others.
        cert_file: our certificate.
        key_file: the key of our certificate, without a password.
    """

    ca_file: Path
    cert_file: Path
    key_file: Path

    def context(self) -> ssl.SSLContext:
        """What checks the certificate of a scheduler, but not its name, as Dask does, and shows it ours.

        Raises:
            DeltacamError: a file cannot be read, or is something else.
        """
        certificate, key = "a certificate", f"the key of {self.cert_file.name}, without a password"
        context = _load(self.ca_file, certificate, lambda: ssl.create_default_context(cafile=self.ca_file))
        _load(self.cert_file, certificate, lambda: ssl.create_default_context(cafile=self.cert_file))
        _load(self.key_file, key, lambda: context.load_cert_chain(self.cert_file, self.key_file, password=lambda: ""))
        context.check_hostname = False
        return context


def tls_of(ca_file: Path | None, cert_file: Path | None, key_file: Path | None) -> Tls | None:
    """The files, or None where there are none.

    Raises:
        DeltacamError: only some are there.
    """
    if ca_file and cert_file and key_file:
        return Tls(ca_file, cert_file, key_file)
    if ca_file or cert_file or key_file:
        given = {"--tls-ca": ca_file, "--tls-cert": cert_file, "--tls-key": key_file}
        missing = " and ".join(name for name, file in given.items() if not file)
        raise DeltacamError(f"TLS needs three files: {missing} is missing", hint=_THREE_FILES)
    return None


@dataclass(frozen=True, slots=True)
class Address:
    """Where a scheduler listens.

    Attributes:
        host: a name or a number; IPv6 without brackets.
        port: 1 to 65535.
        tls: None where the connection is open to everybody on its way.
    """

    host: str
    port: int
    tls: Tls | None

    def __str__(self) -> str:
        host = f"[{self.host}]" if ":" in self.host else self.host
        return f"{'tls' if self.tls else 'tcp'}://{host}:{self.port}"

    @property
    def start(self) -> str:
        """How a scheduler is started there."""
        return f"start one there with: dask scheduler --host {self.host} --port {self.port}"


def address_of(text: str, tls: Tls | None) -> Address:
    """The address that a text says: ``tcp://host:8786``, ``tls://host:8786``, or ``host:8786``, which means tcp.

    Raises:
        DeltacamError: it is none, or ``tls`` does not go with it.
    """
    shown = plain(text, longest=_SHOWN)
    found = _ADDRESS.fullmatch(text)
    if found is None or int(found[3]) not in _PORTS:
        hint = f"like tcp://host:{DEFAULT_PORT}, or tls://host:{DEFAULT_PORT}"
        raise DeltacamError(f"{shown!r} is not the address of a scheduler", hint=hint)
    scheme, host, port = found[1] or "tcp", found[2].strip("[]"), int(found[3])
    if scheme == "tls" and tls is None:
        raise DeltacamError(f"{shown} needs TLS", hint=_THREE_FILES)
    if scheme == "tcp" and tls is not None:
        hint = f"is its address tls://{shown.removeprefix('tcp://')}?"
        raise DeltacamError(f"files for TLS are given, but {shown} is not encrypted", hint=hint)
    return Address(host, port, tls)


def reach(address: Address, *, timeout: float) -> None:
    """Connect to a scheduler, hear that it is one, and hang up. Dask itself may wait forever, and does not say why.

    Args:
        address: of the scheduler.
        timeout: for every step, s.

    Raises:
        DeltacamError: nothing answers there, or not in this way.
    """
    context = address.tls.context() if address.tls else None
    try:
        with socket.create_connection((address.host, address.port), timeout) as connection:
            if context is None:
                heard = _hear_in_the_open(connection, address, timeout)
            else:
                with context.wrap_socket(connection) as encrypted:
                    heard = _hear(encrypted)
    except ssl.SSLError as problem:
        raise _distrust(address, problem) from problem
    except (OSError, UnicodeError) as problem:
        raise DeltacamError(f"no scheduler answers at {address}: {_reason(problem)}", hint=address.start) from problem
    if not heard:
        raise DeltacamError(f"what listens at {address} is not a Dask scheduler", hint=address.start)


def _hear_in_the_open(connection: socket.socket, address: Address, timeout: float) -> bool:
    """As `_hear`; who says nothing at first is asked whether it waits for TLS.

    Raises:
        DeltacamError: it does.
        OSError: it hangs up.
    """
    connection.settimeout(min(_AT_FIRST, timeout))
    if _hear(connection):
        return True
    if _wants_tls(address, timeout=timeout):
        hint = f"give its address as {str(address).replace('tcp', 'tls', 1)}, and {_THREE_FILES.removeprefix('give ')}"
        raise DeltacamError(f"the scheduler at {address} wants TLS", hint=hint)
    connection.settimeout(timeout)
    return _hear(connection)


def _hear(connection: socket.socket) -> bool:
    """Whether a connection begins as Dask's do: both sides say at once how they pickle."""
    heard = b""
    with suppress(TimeoutError):
        while _GREETING not in heard and len(heard) < _LONGEST_GREETING and (more := connection.recv(4096)):
            heard += more
    return _GREETING in heard


def _distrust(address: Address, problem: ssl.SSLError) -> DeltacamError:
    """Why TLS did not come about."""
    if isinstance(problem, ssl.SSLCertVerificationError):
        what = f"the certificate of the scheduler at {address} is not trusted: {problem.verify_message}"
        return DeltacamError(what, hint="--tls-ca must be the authority that signed it")
    if _ALERT in str(problem.reason):
        what = f"the scheduler at {address} does not accept our certificate: {_reason(problem)}"
        return DeltacamError(what, hint="--tls-cert must be signed by the authority of the scheduler")
    what = f"what listens at {address} does not speak TLS: {_reason(problem)}"
    return DeltacamError(what, hint=f"is its address {str(address).replace('tls', 'tcp', 1)}, without TLS?")


def _wants_tls(address: Address, *, timeout: float) -> bool:
    """Whether a port that says nothing by itself answers to TLS."""
    context = ssl.SSLContext(ssl.PROTOCOL_TLS_CLIENT)
    context.check_hostname, context.verify_mode = False, ssl.CERT_NONE
    try:
        with socket.create_connection((address.host, address.port), timeout) as connection:
            context.wrap_socket(connection).close()
    except ssl.SSLError as problem:
        return _ALERT in str(problem.reason)  # it misses our certificate
    except OSError:
        return False
    return True


def _reason(problem: Exception) -> str:
    if isinstance(problem, TimeoutError):
        return "timed out"
    reason = getattr(problem, "strerror", None) or getattr(problem, "reason", None) or str(problem)
    return plain(str(reason), longest=_SHOWN).lower()


def _load(file: Path, kind: str, load: Callable[[], Loaded]) -> Loaded:
    where = plain(str(file), longest=_SHOWN)
    try:
        return load()
    except ssl.SSLError as problem:
        raise DeltacamError(f"this is not {kind} (PEM)", where=where) from problem
    except OSError as problem:
        raise DeltacamError(f"this cannot be read: {_reason(problem)}", where=where) from problem
