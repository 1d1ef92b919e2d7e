"""Who can use the studio's server: pages of this machine that the server itself has sent, and no one else."""

import functools
import re
import signal
import socket
import subprocess
import sys
import time
from contextlib import contextmanager
from http.client import HTTPConnection

import pytest
import viser
from viser import _messages as messages
from websockets.exceptions import InvalidStatus
from websockets.sync.client import connect

from haptic_glance.studio.app import Studio
from haptic_glance.studio.guard import COOKIE, MAX_UPLOAD, bound_uploads, is_own
from haptic_glance.studio.session import Settings

TOKENS = {}  # {port: the token of the studio there}


@pytest.fixture(scope="module")
def port():
    studio = Studio(Settings())
    TOKENS[studio.server.get_port()] = studio.server.token
    yield studio.server.get_port()
    studio.stop()


def cookie(port):
    return {"Cookie": f"{COOKIE}{port}={TOKENS[port]}"}


def ask(port, path="/", known=True, **headers):
    connection = HTTPConnection("127.0.0.1", port, timeout=60)
    connection.request("GET", path, headers=headers | (cookie(port) if known else {}))
    answer = connection.getresponse()
    return answer, answer.read()


@contextmanager
def dialled(port, **options):
    address = f"ws://127.0.0.1:{port}/"
    protocols = [f"viser-v{viser.__version__}"]
    options = {"additional_headers": cookie(port)} | options
    with connect(address, subprotocols=protocols, open_timeout=60, max_size=None, **options) as line:
        yield line


def test_the_page_is_served_and_names_no_other_machine(port):
    answer, body = ask(port)
    assert answer.status == 200 and b"<html" in body[:500].lower()
    assert body.count(b"<title>Haptic Glance") == 1 and answer.headers.get_all("Content-Length") == [str(len(body))]
    for name, value in {"X-Frame-Options": "DENY", "X-Content-Type-Options": "nosniff"}.items():
        assert answer.headers[name] == value
    assert b'src="http' not in body and b'href="http' not in body


def test_another_account_of_this_machine_needs_the_token(port):
    for path in ("/", "/?token=", "/?token=guessed", "/index.html"):
        answer, body = ask(port, path, known=False)
        assert answer.status == 403 and b"open the address that the studio has printed" in body
        assert "Set-Cookie" not in answer.headers
    for headers in ({}, {"Cookie": f"{COOKIE}{port}=guessed"}):
        with pytest.raises(InvalidStatus, match="403"), dialled(port, additional_headers=headers):
            pass
    answer, body = ask(port, f"/?token={TOKENS[port]}", known=False)
    assert answer.status == 200 and b"<html" in body[:500].lower()
    assert answer.headers["Set-Cookie"].startswith(cookie(port)["Cookie"] + "; HttpOnly; SameSite=Strict")


@pytest.mark.slow
def test_garbage_from_a_client_leaves_no_trace(tmp_path):
    command = [sys.executable, "-m", "haptic_glance", "studio", "--port", "0", "--no-browser"]
    heard = functools.partial(signal.signal, signal.SIGINT, signal.SIG_DFL)  # a process in the background ignores it
    options = {"stdout": subprocess.PIPE, "stderr": (tmp_path / "said").open("w"), "text": True, "preexec_fn": heard}
    with subprocess.Popen(command, **options) as studio:
        try:
            port, token = re.search(r":(\d+)/\?token=(\S+)", studio.stdout.readline()).groups()
            TOKENS[int(port)] = token
            for garbage in (b"\x16\x03\x01 no request", b"GET", b"POST / HTTP/1.1\r\n\r\n", b"\r\n" * 50):
                with socket.create_connection(("127.0.0.1", int(port)), timeout=60) as line:
                    line.sendall(garbage)
            for garbage in (b"\xff\xfe not msgpack", "text", b"\x81\xa4type\xa7Unknown", b"\xc1" * 100):
                with dialled(int(port)) as line:
                    line.send(garbage)
                    time.sleep(0.1)
            answer, _ = ask(int(port))
            studio.send_signal(signal.SIGINT)
            studio.wait(600)  # it may be compiling kernels, beside other tests
        finally:
            studio.kill()  # or a studio that does not end keeps the test waiting for ever
    assert answer.status == 200 and (tmp_path / "said").read_text() == ""


def test_only_this_machine_can_reach_it(port):
    with socket.socket() as line:
        line.settimeout(2)
        with pytest.raises(OSError):  # the studio is bound to 127.0.0.1, not to every address of this machine
            line.connect(("127.0.0.2", port))


@pytest.mark.parametrize("host", ["evil.example:{}", "127.0.0.1", "127.0.0.1:{}.evil.example"])
def test_a_page_of_another_name_for_this_machine_is_refused(port, host):
    answer, body = ask(port, Host=host.format(port))
    assert answer.status == 403 and b"this page is at" in body


@pytest.mark.parametrize("origin", ["http://evil.example", "https://127.0.0.1:{}", "null"])
def test_a_page_of_another_origin_is_refused(port, origin):
    answer, _ = ask(port, Origin=origin.format(port))
    assert answer.status == 403
    with pytest.raises(InvalidStatus, match="403"), dialled(port, origin=origin.format(port)):
        pass


def test_the_socket_takes_the_page_alone(port):
    with dialled(port, origin=f"http://127.0.0.1:{port}") as line:
        assert line.recv(timeout=60)
    # A browser under another name for this machine sends that name as both host and origin.
    with socket.create_connection(("127.0.0.1", port), timeout=60) as line:
        name = f"evil.example:{port}"
        line.sendall(
            f"GET / HTTP/1.1\r\nHost: {name}\r\nOrigin: http://{name}\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
            f"Sec-WebSocket-Key: AAAAAAAAAAAAAAAAAAAAAA==\r\nSec-WebSocket-Version: 13\r\n"
            f"Sec-WebSocket-Protocol: viser-v{viser.__version__}\r\n\r\n".encode()
        )
        assert line.recv(100).startswith(b"HTTP/1.1 403")


def test_nothing_else_is_served(port):
    for path in ("/../guard.py", "/%2e%2e/__init__.py", "/etc/passwd"):
        assert ask(port, path)[0].status == 404


def test_two_hosts_in_one_request_are_refused():
    assert is_own(["127.0.0.1:80"], [], 80) and is_own(["localhost:80"], ["http://localhost:80"], 80)
    assert not is_own(["127.0.0.1:80", "evil.example"], [], 80) and not is_own([], [], 80)
    assert not is_own(["127.0.0.1:80"], ["http://127.0.0.1:80", "http://evil.example"], 80)


def test_no_tunnel_to_other_machines_is_opened(monkeypatch):
    opened = []
    monkeypatch.setattr("viser._viser.ViserTunnel", lambda *args: opened.append(args))
    studio = Studio(Settings())
    try:
        for handler in studio.server._websock_server._incoming_handlers[messages.ShareUrlRequest]:
            handler(0, messages.ShareUrlRequest())
        studio.server._thread_executor.shutdown(wait=True)
    finally:
        studio.stop()
    assert opened == []


class Gui:
    """What bound_uploads wraps: it counts what reaches viser."""

    def __init__(self):
        self._websock_interface, self._current_file_upload_states = self, {}
        self.handlers, self.sent, self.reached = {}, [], []
        self.register_handler(messages.FileTransferStartUpload, self._handle_file_transfer_start)
        self.register_handler(messages.FileTransferPart, self._handle_file_transfer_part)

    def _handle_file_transfer_start(self, client, message):
        self.reached.append(message.transfer_uuid)
        self._current_file_upload_states[message.transfer_uuid] = {}

    def _handle_file_transfer_part(self, client, message):
        self.reached.append(len(message.content))

    def register_handler(self, kind, handler):
        self.handlers.setdefault(kind, []).append(handler)

    def unregister_handler(self, kind, handler):
        self.handlers[kind].remove(handler)

    def queue_message(self, message):
        self.sent.append(message)

    def receive(self, message):
        for handler in self.handlers[type(message)]:
            handler(0, message)


def upload(gui, name, size, *parts):
    gui.receive(messages.FileTransferStartUpload("button", name, f"{name}.stl", "", len(parts), size))
    for number, part in enumerate(parts):
        gui.receive(messages.FileTransferPart("button", name, number, part))


def test_an_upload_that_is_too_large_is_refused_before_it_is_kept():
    gui, refused = Gui(), []
    bound_uploads(gui, lambda name, size: refused.append((name, size)), limit=10)
    upload(gui, "large", 11, b"x" * 6, b"x" * 5)
    assert refused == [("large.stl", 11)] and gui.reached == [] and gui.sent[0].transferred_bytes == 11
    upload(gui, "fits", 10, b"x" * 6, b"x" * 4)
    assert gui.reached == ["fits", 6, 4]


def test_an_upload_that_is_larger_than_it_says_is_dropped():
    gui = Gui()
    bound_uploads(gui, lambda *_: None, limit=10)
    upload(gui, "liar", 8, b"x" * 6, b"x" * 600)
    assert gui.reached == ["liar", 6] and gui._current_file_upload_states == {}
    assert MAX_UPLOAD == 300 * 1024**2
