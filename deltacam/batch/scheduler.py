"""Where the scheduler of a cluster is, how it and we know each other, and whether it answers."""

from __future__ import annotations

import re
import socket
import ssl
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Final

from deltacam.errors import DeltacamError
from deltacam.plain import plain

DEFAULT_PORT: Final = 8786
START: Final = f"start one with: dask scheduler --port {DEFAULT_PORT}"

_ADDRESS: Final = re.compile(r"(?:(tcp|tls)://)?(\[[0-9A-Fa-f:.]+\]|[^\s/:@\[\]]+):([0-9]{1,5})/?")
_THREE_FILES: Final = "give --tls-ca FILE, --tls-cert FILE and --tls-key FILE"
_PORTS: Final = range(1, 65536)
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
        context = ssl.SSLContext(ssl.PROTOCOL_TLS_CLIENT)
        context.check_hostname = False
        certificate, key = "a certificate", f"the key of {self.cert_file.name}, without a password"
        _load(
            self.cert_file, certificate, lambda: ssl.SSLContext(context.protocol).load_verify_locations(self.cert_file)
        )
        _load(self.key_file, key, lambda: context.load_cert_chain(self.cert_file, self.key_file, password=lambda: ""))
        _load(self.ca_file, certificate, lambda: context.load_verify_locations(self.ca_file))
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
        raise DeltacamError(
            f"TLS needs three files: {missing} is missing", hint="make them as docs/how-to/batch-on-a-cluster.md shows"
        )
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


def address_of(text: str, tls: Tls | None) -> Address:
    """The address that a text says: ``tcp://host:8786``, ``tls://host:8786``, or ``host:8786``, which means tcp.

    Raises:
        DeltacamError: it is none, or ``tls`` does not go with it.
    """
    found = _ADDRESS.fullmatch(text)
    if found is None or int(found[3]) not in _PORTS:
        shown = plain(text, longest=_SHOWN)
        raise DeltacamError(
            f"{shown!r} is not the address of a scheduler", hint=f"like tcp://host:{DEFAULT_PORT}, or tls://..."
        )
    scheme, host, port = found[1] or "tcp", found[2].strip("[]"), int(found[3])
    if scheme == "tls" and tls is None:
        raise DeltacamError(
            f"{text} needs three files for TLS", hint="add --tls-ca FILE --tls-cert FILE --tls-key FILE"
        )
    if scheme == "tcp" and tls is not None:
        raise DeltacamError(
            f"files for TLS are given, but {text} is not encrypted", hint=f"give its address as tls://{found[2]}:{port}"
        )
    return Address(host, port, tls)


def reach(address: Address, *, timeout: float) -> None:
    """Connect to a scheduler and hang up again; Dask itself would go on trying, and not say why it could not.

    Args:
        address: of the scheduler.
        timeout: s.

    Raises:
        DeltacamError: nothing answers there, or not in this way.
    """
    context = address.tls.context() if address.tls else None
    try:
        with socket.create_connection((address.host, address.port), timeout) as connection:
            if context is not None:
                context.wrap_socket(connection).close()
    except ssl.SSLCertVerificationError as problem:
        what = f"the certificate of the scheduler at {address} is not trusted: {problem.verify_message}"
        raise DeltacamError(what, hint="--tls-ca must be the authority that signed it") from problem
    except ssl.SSLError as problem:
        what = f"what listens at {address} does not take part in TLS as it should: {_reason(problem)}"
        raise DeltacamError(what, hint="is it a scheduler that was started with --tls-ca-file?") from problem
    except (OSError, UnicodeError) as problem:
        raise DeltacamError(f"no scheduler answers at {address}: {_reason(problem)}", hint=START) from problem


def speaks_tls(address: Address, *, timeout: float) -> bool:
    """Whether a port that we took for an open one wants TLS; asked once it has hung up on us."""
    context = ssl.SSLContext(ssl.PROTOCOL_TLS_CLIENT)
    context.check_hostname, context.verify_mode = False, ssl.CERT_NONE
    try:
        with socket.create_connection((address.host, address.port), timeout) as connection:
            context.wrap_socket(connection).close()
    except ssl.SSLError as problem:
        return "ALERT" in (problem.reason or "")  # it misses our certificate
    except OSError:
        return False
    return True


def _reason(problem: Exception) -> str:
    if isinstance(problem, TimeoutError):
        return "timed out"
    reason = getattr(problem, "strerror", None) or getattr(problem, "reason", None) or str(problem)
    return plain(str(reason), longest=_SHOWN).lower()


def _load(file: Path, kind: str, load: Callable[[], object]) -> None:
    where = plain(str(file), longest=_SHOWN)
    try:
        load()
    except ssl.SSLError as problem:
        raise DeltacamError(f"this is not {kind} (PEM)", where=where) from problem
    except OSError as problem:
        raise DeltacamError(f"this cannot be read: {_reason(problem)}", where=where) from problem
