"""The address of a scheduler, TLS with real certificates, and what is said where nothing answers."""

import http.server
import re
import shutil
import socket
import subprocess
import threading
import time
from collections.abc import Iterator
from functools import partial
from pathlib import Path

import pytest

from deltacam.batch.cluster import connection, elsewhere, scheduler
from deltacam.batch.cluster.scheduler import Tls
from deltacam.batch.parts import Limits, Part, Row
from deltacam.batch.run import run
from deltacam.errors import DeltacamError
from tests.batch.daskprocesses import ROOT, Processes


def can_certify() -> bool:
    """Whether there is an openssl that signs a certificate as it makes it."""
    if shutil.which("openssl") is None:
        return False
    said = subprocess.run(["openssl", "version"], check=True, capture_output=True, text=True).stdout
    return re.match(r"OpenSSL [3-9]", said) is not None


needs_openssl = pytest.mark.skipif(not can_certify(), reason="OpenSSL 3 makes certificates")


def certify(folder: Path) -> Tls:
    """An authority of its own, and a certificate that it signed, as the page makes them."""
    page = (ROOT / "docs" / "how-to" / "batch-on-a-cluster.md").read_text()
    (commands,) = re.findall(r"```sh\n(openssl .*?)```", page, flags=re.DOTALL)
    subprocess.run(["sh", "-e", "-c", commands], check=True, capture_output=True, cwd=folder)
    return Tls(folder / "ca.pem", folder / "saw.pem", folder / "saw.key")


@pytest.fixture(scope="module")
def tls(tmp_path_factory: pytest.TempPathFactory) -> Tls:
    return certify(tmp_path_factory.mktemp("ours"))


@pytest.fixture(scope="module")
def strangers(tmp_path_factory: pytest.TempPathFactory) -> Tls:
    """Of another authority."""
    return certify(tmp_path_factory.mktemp("strangers"))


@pytest.fixture(scope="module")
def processes(tls: Tls, tmp_path_factory: pytest.TempPathFactory) -> Iterator[Processes]:
    """A scheduler that wants TLS; it has no worker yet."""
    files = {"--tls-ca-file": tls.ca_file, "--tls-cert": tls.cert_file, "--tls-key": tls.key_file}
    options = [str(word) for option in files.items() for word in option]
    with Processes(tmp_path_factory.mktemp("cluster"), options) as started:
        yield started


def refusal(address: str, tls: Tls | None = None, *, timeout: float = 5.0) -> DeltacamError:
    with (
        pytest.raises(DeltacamError) as refused,
        connection.connect(address, tls=tls, timeout=timeout, patience=1.0),
    ):
        pass
    return refused.value


@pytest.mark.parametrize(
    ("text", "shown"),
    [
        ("host:8786", "tcp://host:8786"),
        ("tcp://10.0.0.7:1", "tcp://10.0.0.7:1"),
        ("tcp://[::1]:8786/", "tcp://[::1]:8786"),
    ],
)
def test_an_address_may_leave_out_that_it_is_tcp(text: str, shown: str) -> None:
    assert str(scheduler.address_of(text, None)) == shown


@pytest.mark.parametrize(
    "text",
    ["", "host", "host:", ":8786", "host:0", "host:65536", "http://host:8786", "tcp://a b:1", "tcp://host:1\n", "h:²"],
)
def test_what_is_no_address_is_refused_with_one_that_is(text: str) -> None:
    with pytest.raises(DeltacamError, match="is not the address of a scheduler") as refused:
        scheduler.address_of(text, None)
    assert "tcp://host:8786" in refused.value.hint
    assert "\n" not in refused.value.what


def test_tls_and_the_address_must_go_together(tmp_path: Path) -> None:
    file = tmp_path / "file"
    with pytest.raises(DeltacamError, match="tls://host:8786 needs TLS") as refused:
        scheduler.address_of("tls://host:8786", scheduler.tls_of(None, None, None))
    assert "--tls-ca FILE" in refused.value.hint
    with pytest.raises(DeltacamError, match="host:8786 is not encrypted") as refused:
        scheduler.address_of("host:8786", scheduler.tls_of(file, file, file))
    assert "tls://host:8786" in refused.value.hint
    with pytest.raises(DeltacamError, match="--tls-cert and --tls-key is missing"):
        scheduler.tls_of(file, None, None)


@needs_openssl
def test_a_file_that_is_not_what_it_should_be_is_named(tls: Tls, strangers: Tls, tmp_path: Path) -> None:
    wrong = tmp_path / "wrong.pem"
    wrong.write_text("this is no certificate\n")
    locked = tmp_path / "locked.key"
    lock = ("openssl", "rsa", "-aes256", "-passout", "pass:secret", "-in", tls.key_file, "-out", locked)
    subprocess.run(lock, check=True, capture_output=True)
    for files, where, what in (
        (Tls(tmp_path / "none", tls.cert_file, tls.key_file), tmp_path / "none", "cannot be read: no such file"),
        (Tls(wrong, tls.cert_file, tls.key_file), wrong, "not a certificate"),
        (Tls(tls.ca_file, wrong, tls.key_file), wrong, "not a certificate"),
        (Tls(tls.ca_file, tls.cert_file, wrong), wrong, "not the key of saw.pem"),
        (Tls(tls.ca_file, tls.cert_file, strangers.key_file), strangers.key_file, "not the key of saw.pem"),
        (Tls(tls.ca_file, tls.cert_file, locked), locked, "without a password"),
    ):
        refused = refusal("tls://127.0.0.1:1", files)
        assert refused.where == str(where)
        assert what in refused.what


def test_nothing_there_is_said_at_once() -> None:
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        port = free.getsockname()[1]
    refused = refusal(f"127.0.0.1:{port}")
    assert refused.what == f"no scheduler answers at tcp://127.0.0.1:{port}: connection refused"
    assert f"dask scheduler --host 127.0.0.1 --port {port}" in refused.hint
    assert "no scheduler answers at tcp://no.such.host.invalid:8786: " in refusal("no.such.host.invalid:8786").what


def test_something_else_there_is_said_in_time() -> None:
    with socket.create_server(("127.0.0.1", 0)) as silent:
        refused = refusal(f"127.0.0.1:{silent.getsockname()[1]}", timeout=0.4)
        assert "is not a Dask scheduler" in refused.what
    with http.server.ThreadingHTTPServer(("127.0.0.1", 0), http.server.SimpleHTTPRequestHandler) as web:
        threading.Thread(target=web.serve_forever).start()
        try:
            refused = refusal(f"127.0.0.1:{web.server_port}", timeout=0.4)
        finally:
            web.shutdown()
        assert "is not a Dask scheduler" in refused.what


@needs_openssl
def test_a_scheduler_with_tls_lets_in_only_who_belongs_to_it(processes: Processes, tls: Tls, strangers: Tls) -> None:
    address = processes.address
    assert address.startswith("tls://")
    refused = refusal(address.replace("tls", "tcp"))
    assert f"{address.replace('tls', 'tcp')} wants TLS" in refused.what
    assert "tls://" in refused.hint
    refused = refusal(address, Tls(strangers.ca_file, tls.cert_file, tls.key_file))
    assert "certificate of the scheduler" in refused.what
    assert "is not trusted" in refused.what
    refused = refusal(address, Tls(tls.ca_file, strangers.cert_file, strangers.key_file))
    assert "does not accept our certificate" in refused.what
    assert "--tls-cert" in refused.hint


@needs_openssl
def test_a_worker_is_told_from_its_scheduler(processes: Processes, tls: Tls) -> None:
    worker = processes.add_worker("--no-nanny")
    while not (found := re.findall(r"Start worker at: *(tls://\S+)", processes.words)):
        assert worker.poll() is None
        time.sleep(0.1)
    refused = refusal(found[-1], tls)
    processes.kill(worker)
    assert "it says that it is a Worker" in refused.what
    assert "Scheduler at:" in refused.hint


@needs_openssl
def test_a_batch_runs_over_tls_and_waits_for_a_worker_where_none_is_left(
    processes: Processes, tls: Tls, tmp_path: Path
) -> None:
    refused = refusal(processes.address, tls)  # a worker that was killed has gone at once
    assert "has no worker: waited 1 s" in refused.what
    assert f"dask worker {processes.address}" in refused.hint
    worker = processes.add_worker("--no-nanny")
    said: list[str] = []

    def say(words: str) -> None:
        said.append(words)
        if "no worker is left" in words:
            processes.add_worker("--no-nanny")

    parts = [Part(f"{number}.dxf", tmp_path / f"{number}.dxf", {}) for number in range(4)]
    for part in parts:
        part.path.write_text("no drawing")
    with connection.connect(processes.address, tls=tls, tell=say) as found:
        planner = partial(elsewhere.results, cluster=found, limits=Limits())
        batch = run(parts, tmp_path / "out", planner=planner, tell=lambda _row: processes.kill(worker))
    assert [row.outcome.status.value for row in batch.rows] == ["refused"] * 4
    assert said == ["no worker is left: waiting for one", "there are workers again"]


@needs_openssl
def test_what_listens_without_tls_is_told_from_a_scheduler_with_it(tls: Tls) -> None:
    with http.server.ThreadingHTTPServer(("127.0.0.1", 0), http.server.SimpleHTTPRequestHandler) as web:
        threading.Thread(target=web.serve_forever).start()
        try:
            refused = refusal(f"tls://127.0.0.1:{web.server_port}", tls)
        finally:
            web.shutdown()
    assert "does not speak TLS" in refused.what


def test_a_scheduler_that_is_lost_for_good_ends_the_batch_and_what_is_done_stays(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(connection, "_RECONNECTS", 0.0)
    parts = [Part(f"{number}.dxf", tmp_path / f"{number}.dxf", {}) for number in range(8)]
    for part in parts:
        part.path.write_text("no drawing")
    done: list[str] = []
    said: list[str] = []

    with Processes(tmp_path) as processes:
        processes.add_worker("--no-nanny")

        def tell(row: Row) -> None:
            done.append(row.part)
            processes.kill(processes.scheduler)

        with connection.connect(processes.address, timeout=5.0, tell=said.append) as found:
            planner = partial(elsewhere.results, cluster=found, limits=Limits())
            with pytest.raises(DeltacamError, match="the connection to the scheduler at tcp") as refused:
                run(parts, tmp_path / "out", planner=planner, tell=tell)
    assert "was lost: no scheduler answers" in refused.value.what
    assert "run it again" in refused.value.hint
    assert said == ["the connection to the scheduler is lost: trying again for 2 min"]
    assert 1 <= len(done) < len(parts)
    recorded = (tmp_path / "out" / ".deltacam-batch" / "record.jsonl").read_text()
    assert all(f'"{name}"' in recorded for name in done)
