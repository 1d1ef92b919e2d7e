"""A viser server for one person of this machine: bound to loopback, of known hosts and origins, with a token."""

import functools
import http
import http.cookies
import io
import logging
import secrets
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager, redirect_stdout
from pathlib import Path
from typing import Any
from urllib.parse import parse_qs

import viser
import websockets.asyncio.server as sockets
from viser import _messages as messages
from websockets.http11 import Request, Response

ALIVE = Path(__file__).with_name("alive.html")  # what the page says when the studio has ended
COOKIE = "haptic-glance-"  # and the port: browsers share cookies between ports
HOST = "127.0.0.1"  # not accessible from other machines
MAX_UPLOAD = 300 * 2**20  # bytes of one file
# The page is one file, which compiles the Markdown of its panels.
POLICY = (
    "default-src 'self' 'unsafe-inline' 'unsafe-eval' data: blob:; connect-src 'self' data: blob:; form-action 'none';"
    " base-uri 'none'; frame-ancestors 'none'"
)
HEADERS = {
    "Content-Security-Policy": POLICY,
    "Cache-Control": "no-store", "Cross-Origin-Resource-Policy": "same-origin", "X-Content-Type-Options": "nosniff",
    "X-Frame-Options": "DENY", "Referrer-Policy": "no-referrer",
}  # fmt: skip
_patching = threading.Lock()


class LocalServer(viser.ViserServer):
    """viser's server, bound to 127.0.0.1, which answers only requests of its own page and shares nothing.

    token: what the address must hold, as Jupyter's does: other accounts of this machine reach the port, too.
    """

    def __init__(self, port: int, label: str) -> None:
        self.token = secrets.token_urlsafe(16)
        logging.getLogger("websockets.server").setLevel(logging.CRITICAL)  # what is no request leaves no traceback
        with guarded(self.token), redirect_stdout(io.StringIO()):  # the command says where the page is
            super().__init__(host=HOST, port=port, label=label, verbose=False)

    def request_share_url(self, verbose: bool = True) -> None:
        """Refuses: viser would open a tunnel through which other machines reach this page."""


@contextmanager
def guarded(token: str) -> Iterator[None]:
    """Inside, a server of websockets that starts looks at the host, the origin and the token of every request first."""
    serve = sockets.serve

    def checked(*arguments: Any, process_request: Callable[..., Any], **options: Any) -> Any:
        return serve(*arguments, process_request=functools.partial(answer, process_request, token), **options)

    with _patching:
        sockets.serve = checked
        try:
            yield
        finally:
            sockets.serve = serve


def answer(
    then: Callable[..., Any], token: str, connection: sockets.ServerConnection, request: Request
) -> Response | None:
    """403 for a request that does not come from the page itself, or without the token, else what `then` answers.

    The token comes in the address of the page, which then keeps it as a cookie.
    """
    port = connection.local_address[1]
    if not is_own(request.headers.get_all("Host"), request.headers.get_all("Origin"), port):
        text = f"this page is at http://{HOST}:{port}/ only\n"
        response = connection.respond(http.HTTPStatus.FORBIDDEN, text)
    elif request.path == "/alive":
        response = connection.respond(http.HTTPStatus.OK, "")
    elif not knows(request, token, port):
        text = "this page needs the token of its address: open the address that the studio has printed\n"
        response = connection.respond(http.HTTPStatus.FORBIDDEN, text)
    else:
        if "Accept-Encoding" in request.headers:
            del request.headers["Accept-Encoding"]  # so that the page can be added to
        path, _, query = request.path.partition("?")
        request.path = path if query.startswith("token=") else request.path
        response = then(connection, request)
        if path == "/" and isinstance(response, Response):
            response.headers["Set-Cookie"] = f"{COOKIE}{port}={token}; HttpOnly; SameSite=Strict; Path=/"
        if path == "/" and response is not None and request.headers.get("Upgrade") is None:
            response.body = response.body.replace(b"<head>", b"<head>" + ALIVE.read_bytes(), 1)
            del response.headers["Content-Length"]  # or it would have two
            response.headers["Content-Length"] = str(len(response.body))
    if isinstance(response, Response):
        for name, value in HEADERS.items():
            response.headers[name] = value
    return response


def knows(request: Request, token: str, port: int) -> bool:
    """Whether a request has the token, in its address or as the cookie that the page was given."""
    tokens = parse_qs(request.path.partition("?")[2]).get("token", [])
    cookies = http.cookies.SimpleCookie("; ".join(request.headers.get_all("Cookie")))
    if cookie := cookies.get(f"{COOKIE}{port}"):
        tokens.append(cookie.value)
    return any(secrets.compare_digest(candidate.encode(), token.encode()) for candidate in tokens)


def is_own(hosts: list[str], origins: list[str], port: int) -> bool:
    """Whether a request names this server as its host, and no other page as its origin.

    A page of another host name that resolves to this machine must not read or write (DNS rebinding), nor may one of
    another origin (cross-site request forgery).
    """
    addresses = {f"{HOST}:{port}", f"localhost:{port}"}
    return len(hosts) == 1 and hosts[0] in addresses and origins in ([], [f"http://{hosts[0]}"])


def bound_uploads(gui: viser.GuiApi, refuse: Callable[[str, int], None], limit: int = MAX_UPLOAD) -> None:
    """Lets no upload through whose parts hold more than `limit` bytes; refuse(name, bytes) says so to the person."""
    interface, start, part = gui._websock_interface, gui._handle_file_transfer_start, gui._handle_file_transfer_part
    room: dict[str, int] = {}

    def started(client: Any, message: messages.FileTransferStartUpload) -> None:
        if message.size_bytes > limit:
            receipt = messages.FileTransferPartAck(
                message.source_component_uuid, message.transfer_uuid, message.size_bytes, message.size_bytes
            )
            interface.queue_message(receipt)  # or the page shows its progress forever
            refuse(message.filename, message.size_bytes)
            return
        room[message.transfer_uuid] = message.size_bytes
        start(client, message)

    def arrived(client: Any, message: messages.FileTransferPart) -> None:
        room[message.transfer_uuid] = room.get(message.transfer_uuid, 0) - len(message.content)
        if room[message.transfer_uuid] >= 0:
            part(client, message)
        if room[message.transfer_uuid] <= 0:
            gui._current_file_upload_states.pop(message.transfer_uuid, None)
            room.pop(message.transfer_uuid)

    interface.unregister_handler(messages.FileTransferStartUpload, start)
    interface.unregister_handler(messages.FileTransferPart, part)
    interface.register_handler(messages.FileTransferStartUpload, started)
    interface.register_handler(messages.FileTransferPart, arrived)
