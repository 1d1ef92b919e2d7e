"""Serves the annotation page of one mesh to this machine only, and stores the marks."""

import errno
import hashlib
import json
import os
from collections.abc import Mapping
from functools import partial
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path
from typing import Any
from urllib.parse import parse_qs, urlsplit

import numpy as np

from stages.kit import Mesh

from .marks import MarksChanged, check_annotator, check_on_mesh, read_marks, write_marks

HERE = Path(__file__).parent
HOST = "127.0.0.1"  # not accessible from other machines
PAGES = {
    "/": ("page.html", "text/html"),
    "/page.js": ("page.js", "text/javascript"),
    "/view.js": ("view.js", "text/javascript"),
}
MAX_BYTES = 4_000_000  # of one save: about 50,000 points
SECONDS = 30  # that a request may take to arrive
POLICY = (
    "default-src 'none'; script-src 'self'; style-src 'unsafe-inline'; connect-src 'self'; img-src data:;"
    " frame-ancestors 'none'"
)
HEADERS = {
    "Cache-Control": "no-store", "Content-Security-Policy": POLICY, "Cross-Origin-Resource-Policy": "same-origin",
    "X-Content-Type-Options": "nosniff",
}  # fmt: skip


class AnnotationSession:
    """One mesh, the file of its marks, and the annotator (empty: the page asks for the name)."""

    def __init__(self, name: str, mesh: Mesh, folder: str | Path, annotator: str = "") -> None:
        self.name, self.mesh = name, mesh
        self.annotator = check_annotator(annotator) if annotator else ""
        self.path = Path(folder) / f"{name}.csv"
        vertices, faces = mesh.vertices.astype("<f4"), mesh.faces.astype("<u4")
        self.arrays = vertices.tobytes() + faces.tobytes()
        self.digest = hashlib.sha256(self.arrays).hexdigest()[:16]
        self._stored()

    def describe(self) -> dict:
        """The metadata that the page needs before it draws."""
        counts = {"vertices": len(self.mesh.vertices), "faces": len(self.mesh.faces)}
        names = {"name": self.name, "annotator": self.annotator, "file": str(self.path), "mesh": self.digest}
        return counts | names | {"warning": _unwritable(self.path)}

    def marks(self, annotator: str) -> dict:
        """The saved points of an annotator: dict of annotator and marks (list of dicts of time and vertex)."""
        annotator, stored = check_annotator(annotator), self._stored()
        marks = (
            [] if stored is None else stored.loc[stored.annotator == annotator, ["time", "vertex"]].to_dict("records")
        )
        return {"annotator": annotator, "marks": marks}

    def save(self, sent: Mapping) -> dict:
        """Stores what the page sent: annotator, mesh (its digest), marks, and seen, the marks that it received last.

        Raises MarksChanged when another window has stored others since, ValueError or OSError when nothing can be
        stored.
        """
        if sent.get("mesh") != self.digest:
            raise ValueError(f"the server now shows {self.name}, not the mesh of this page: restart it with that mesh")
        vertices = [mark["vertex"] for mark in sent["marks"]]
        wrong = [vertex for vertex in vertices if type(vertex) is not int or not 0 <= vertex < len(self.mesh.vertices)]
        if wrong:
            raise ValueError(f"vertex {wrong[0]} is not on the mesh")
        self._stored()
        places = self.mesh.vertices[np.array(vertices, dtype=np.int64)]
        times = [mark["time"] for mark in sent["marks"]]
        rows = [
            {"time": time, "vertex": vertex, **dict(zip("xyz", place, strict=True))}
            for time, vertex, place in zip(times, vertices, places, strict=True)
        ]
        seen = [(mark["time"], mark["vertex"]) for mark in sent["seen"]]
        write_marks(self.path, sent["annotator"], rows, seen)
        return self.marks(sent["annotator"]) | {"file": str(self.path)}

    def _stored(self):
        """The marks of the file, checked to be of this mesh; None if there is no file."""
        if not self.path.exists():
            return None
        stored = read_marks(self.path)
        check_on_mesh(stored, self.mesh, self.path)
        return stored


class Handler(BaseHTTPRequestHandler):
    """Answers requests of the page; every error is a JSON object with a message for the user."""

    timeout = SECONDS  # read by the standard library

    def __init__(self, session: AnnotationSession, *arguments: Any) -> None:
        self.session = session
        super().__init__(*arguments)

    def parse_request(self) -> bool:
        """False, with an answer sent, for what is no request of this page."""
        return super().parse_request() and self._is_own()

    def _is_own(self):
        # A page of another host name that resolves to this machine must not read or write (DNS rebinding), nor may one
        # of another origin (cross-site request forgery).
        port = self.connection.getsockname()[1]
        host, origin = self.headers.get("Host"), self.headers.get("Origin")
        if host in {f"{HOST}:{port}", f"localhost:{port}"} and origin in (None, f"http://{host}"):
            return True
        self._send(403, {"error": f"this page is at http://{HOST}:{port}/ only"})
        return False

    def do_GET(self) -> None:
        address = urlsplit(self.path)
        if address.path in PAGES:
            file, kind = PAGES[address.path]
            self._answer(lambda: (HERE / file).read_bytes(), f"{kind}; charset=utf-8")
        elif address.path == "/mesh":
            self._answer(lambda: self.session.arrays, "application/octet-stream")
        elif address.path == "/about":
            self._answer(self.session.describe)
        elif address.path == "/marks":
            name = parse_qs(address.query).get("annotator", [""])[0]
            self._answer(lambda: self.session.marks(name))
        else:
            self._send(404, {"error": f"no page at {address.path}"})

    def do_PUT(self) -> None:
        if self.path == "/marks":
            self._answer(lambda: self.session.save(self._body()))
        else:
            self._send(404, {"error": f"cannot store anything at {self.path}"})

    def _body(self):
        length = int(self.headers.get("Content-Length") or 0)
        if not 0 < length <= MAX_BYTES:
            raise ValueError(f"a save must have 1 to {MAX_BYTES} bytes, not {length}")
        sent = json.loads(self.rfile.read(length))
        if not isinstance(sent, dict) or {"annotator", "mesh", "marks", "seen"} - set(sent):
            raise ValueError("a save needs annotator, mesh, marks and seen")
        return sent

    def _answer(self, work, kind="application/json"):
        try:
            self._send(200, work(), kind)
        except MarksChanged as error:
            self._send(409, {"error": str(error)})
        except TimeoutError:
            self.close_connection = True
        except (ValueError, LookupError, TypeError, AttributeError, RecursionError, OverflowError) as error:
            self._send(400, {"error": str(error)})
        except OSError as error:
            path = self.session.path
            self._send(500, {"error": _unwritable(path) or f"cannot use {path}: {error.strerror or error}"})

    def _send(self, code, content, kind="application/json"):
        body = content if isinstance(content, bytes) else json.dumps(content).encode()
        self.send_response(code)
        for key, value in ({"Content-Type": kind, "Content-Length": str(len(body))} | HEADERS).items():
            self.send_header(key, value)
        self.end_headers()
        self.wfile.write(body)

    def log_message(self, format: str, *args: Any) -> None:
        """Writes nothing: the terminal shows the address and errors only."""


def open_server(name: str, mesh: Mesh, folder: str | Path, annotator: str = "", port: int = 0) -> ThreadingHTTPServer:
    """A server, bound to 127.0.0.1 and not yet running, that stores marks of the mesh in FOLDER/NAME.csv.

    mesh: normalised. port 0 takes any free port (`server.server_port`). Raises ValueError if the port is taken, the
    name of the annotator is invalid, or the file is damaged or of another mesh.
    """
    session = AnnotationSession(name, mesh, folder, annotator)
    try:
        return ThreadingHTTPServer((HOST, port), partial(Handler, session))
    except (OSError, OverflowError) as error:
        if getattr(error, "errno", None) == errno.EADDRINUSE:
            raise ValueError(f"port {port} is taken: choose another one by --port, or any free one by 0") from None
        raise ValueError(f"port {port} cannot be opened ({error}): choose another one by --port") from None


def _unwritable(path):
    """The reason why a file cannot be stored at a path; empty if it seems possible."""
    folder = next(parent for parent in path.absolute().parents if parent.exists())
    if not folder.is_dir():
        return f"{folder} is not a folder: nothing can be saved to {path}"
    target = path if path.exists() else folder
    return "" if os.access(folder, os.W_OK) else f"{target} cannot be written: nothing can be saved"
