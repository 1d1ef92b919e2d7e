"""A viser server that pages of this machine alone can use: bound to loopback, of known hosts and origins, bounded."""

import functools
import http
import io
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager, redirect_stdout
from pathlib import Path
from typing import Any

import viser
import websockets.asyncio.server as sockets
from viser import _messages as messages
from websockets.http11 import Request, Response

ALIVE = Path(__file__).with_name("alive.html")  # what the page says when the studio has ended
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
    """viser's server, bound to 127.0.0.1, which answers only requests of its own page and shares nothing."""

    def __init__(self, port: int, label: str) -> None:
        with guarded(), redirect_stdout(io.StringIO()):  # the command says where the page is
            super().__init__(host=HOST, port=port, label=label, verbose=False)

    def request_share_url(self, verbose: bool = True) -> None:
        """Refuses: viser would open a tunnel through which other machines reach this page."""


@contextmanager
def guarded() -> Iterator[None]:
    """Inside, a server of websockets that starts looks at the host and the origin of every request first."""
    serve = sockets.serve

    def checked(*arguments: Any, process_request: Callable[..., Any], **options: Any) -> Any:
        return serve(*arguments, process_request=functools.partial(answer, process_request), **options)

    with _patching:
        sockets.serve = checked
        try:
            yield
        finally:
            sockets.serve = serve


def answer(then: Callable[..., Any], connection: sockets.ServerConnection, request: Request) -> Response | None:
    """403 for a request that does not come from the page itself, else what `then` answers."""
    port = connection.local_address[1]
    if not is_own(request.headers.get_all("Host"), request.headers.get_all("Origin"), port):
        text = f"this page is at http://{HOST}:{port}/ only\n"
        response = connection.respond(http.HTTPStatus.FORBIDDEN, text)
    elif request.path == "/alive":
        response = connection.respond(http.HTTPStatus.OK, "")
    else:
        if "Accept-Encoding" in request.headers:
            del request.headers["Accept-Encoding"]  # so that the page can be added to
        response = then(connection, request)
        if request.path == "/" and response is not None and request.headers.get("Upgrade") is None:
            response.body = response.body.replace(b"<head>", b"<head>" + ALIVE.read_bytes(), 1)
            del response.headers["Content-Length"]  # or it would have two
            response.headers["Content-Length"] = str(len(response.body))
    if isinstance(response, Response):
        for name, value in HEADERS.items():
            response.headers[name] = value
    return response


def is_own(hosts: list[str], origins: list[str], port: int) -> bool:
    """Whether a request names this server as its host, and no other page as its origin.

    A page of another host name that resolves to this machine must not read or write (DNS rebinding), nor may one of
    another origin (cross-site request forgery).
    """
    known = {f"{HOST}:{port}", f"localhost:{port}"}
    return len(hosts) == 1 and hosts[0] in known and origins in ([], [f"http://{hosts[0]}"])


def bound_uploads(gui: viser.GuiApi, refuse: Callable[[str, int], None], limit: int = MAX_UPLOAD) -> None:
    """Lets no upload through whose parts hold more than `limit` bytes; refuse(name, bytes) says so to the person."""
    interface, start, part = gui._websock_interface, gui._handle_file_transfer_start, gui._handle_file_transfer_part
    room: dict[str, int] = {}

    def started(client: Any, message: messages.FileTransferStartUpload) -> None:
        if message.size_bytes > limit:
            done = messages.FileTransferPartAck(
                message.source_component_uuid, message.transfer_uuid, message.size_bytes, message.size_bytes
            )
            interface.queue_message(done)  # or the page shows its progress forever
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
