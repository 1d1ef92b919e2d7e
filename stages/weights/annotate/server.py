"""Serves the annotation page of one mesh to this machine alone, and stores what is marked on it."""

import errno
import hashlib
import json
import os
from functools import partial
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from pathlib import Path
from urllib.parse import parse_qs, urlsplit

import numpy as np

from .marks import MarksChanged, check_annotator, check_on_mesh, read_marks, write_marks

HERE = Path(__file__).parent
HOST = "127.0.0.1"  # no other machine can reach the page
PAGES = {
    "/": ("page.html", "text/html"),
    "/page.js": ("page.js", "text/javascript"),
    "/view.js": ("view.js", "text/javascript"),
}
LARGEST = 4_000_000  # bytes of one save: some 50,000 points
POLICY = "default-src 'none'; script-src 'self'; style-src 'unsafe-inline'; connect-src 'self'; img-src data:"


class Marking:
    """One mesh, the file of its marks, and who is about to mark it (empty: the page asks)."""

    def __init__(self, name, mesh, folder, annotator=""):
        self.name, self.mesh = name, mesh
        self.annotator = check_annotator(annotator) if annotator else ""
        self.path = Path(folder) / f"{name}.csv"
        places, corners = mesh.vertices.astype("<f4"), mesh.faces.astype("<u4")
        self.arrays = places.tobytes() + corners.tobytes()
        self.digest = hashlib.sha256(self.arrays).hexdigest()[:16]
        self._stored()

    def describe(self):
        """What the page needs to know before it draws."""
        counts = {"vertices": len(self.mesh.vertices), "faces": len(self.mesh.faces)}
        names = {"name": self.name, "annotator": self.annotator, "file": str(self.path), "mesh": self.digest}
        return counts | names | {"warning": _unwritable(self.path)}

    def marks(self, annotator):
        """The annotator's saved points: dict annotator, marks (list of dict time, vertex)."""
        annotator, stored = check_annotator(annotator), self._stored()
        found = [] if stored is None else stored[stored.annotator == annotator]
        marks = [] if stored is None else [{"time": m.time, "vertex": m.vertex} for m in found.itertuples()]
        return {"annotator": annotator, "marks": marks}

    def save(self, sent):
        """Stores what the page sent: annotator, mesh (its digest), marks, and seen, the marks that it was last given.

        MarksChanged where another window stored others meanwhile; ValueError, OSError where nothing can be stored.
        """
        if sent.get("mesh") != self.digest:
            raise ValueError(f"the server now shows {self.name}, not the mesh of this page; start it on that one again")
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
        """The file's marks, None where there is no file; checked, since marks of another mesh must not be mixed in."""
        if not self.path.exists():
            return None
        stored = read_marks(self.path)
        check_on_mesh(stored, self.mesh, self.path)
        return stored


class Handler(BaseHTTPRequestHandler):
    """Answers the page; every error is a JSON object with the message for the person."""

    def __init__(self, marking, *arguments):
        self.marking = marking
        super().__init__(*arguments)

    def do_GET(self):
        address = urlsplit(self.path)
        if address.path in PAGES:
            file, kind = PAGES[address.path]
            self._answer(lambda: (HERE / file).read_bytes(), f"{kind}; charset=utf-8")
        elif address.path == "/mesh":
            self._answer(lambda: self.marking.arrays, "application/octet-stream")
        elif address.path == "/about":
            self._answer(self.marking.describe)
        elif address.path == "/marks":
            name = parse_qs(address.query).get("annotator", [""])[0]
            self._answer(lambda: self.marking.marks(name))
        else:
            self._send(404, {"error": f"nothing lies at {address.path}"})

    def do_PUT(self):
        if self.path == "/marks":
            self._answer(lambda: self.marking.save(self._body()))
        else:
            self._send(404, {"error": f"nothing can be stored at {self.path}"})

    def _body(self):
        length = int(self.headers.get("Content-Length") or 0)
        if not 0 < length <= LARGEST:
            raise ValueError(f"a save takes 1 to {LARGEST} bytes, not {length}")
        sent = json.loads(self.rfile.read(length))
        if not isinstance(sent, dict) or {"annotator", "mesh", "marks", "seen"} - set(sent):
            raise ValueError("a save needs annotator, mesh, marks and seen")
        return sent

    def _answer(self, work, kind="application/json"):
        # A page from elsewhere, whose name was made to point here, must not read or write (DNS rebinding).
        port = self.server.server_port
        if self.headers.get("Host") not in {f"{HOST}:{port}", f"localhost:{port}"}:
            return self._send(403, {"error": f"this page is at http://{HOST}:{port}/ only"})
        try:
            self._send(200, work(), kind)
        except MarksChanged as error:
            self._send(409, {"error": str(error)})
        except (ValueError, KeyError, TypeError) as error:
            self._send(400, {"error": str(error)})
        except OSError as error:
            path = self.marking.path
            self._send(500, {"error": _unwritable(path) or f"cannot use {path}: {error.strerror or error}"})

    def _send(self, code, content, kind="application/json"):
        body = content if isinstance(content, bytes) else json.dumps(content).encode()
        self.send_response(code)
        for key, value in (("Content-Type", kind), ("Content-Length", len(body)), ("Cache-Control", "no-store"),
                           ("Content-Security-Policy", POLICY), ("X-Content-Type-Options", "nosniff")):  # fmt: skip
            self.send_header(key, str(value))
        self.end_headers()
        self.wfile.write(body)

    def log_message(self, *_):
        """Silent: the terminal belongs to the address and to errors."""


def open_server(name, mesh, folder, annotator="", port=0):
    """A server, bound to 127.0.0.1 and not yet running, on which marks of the mesh go to FOLDER/NAME.csv.

    mesh: normalised. port 0 takes any free one (`server.server_port`). Raises ValueError where the port is taken, the
    annotator's name is unusable, the file is damaged or marks another mesh.
    """
    marking = Marking(name, mesh, folder, annotator)
    try:
        return ThreadingHTTPServer((HOST, port), partial(Handler, marking))
    except (OSError, OverflowError) as error:
        if getattr(error, "errno", None) == errno.EADDRINUSE:
            raise ValueError(f"port {port} is taken: choose another one by --port, or --port 0 for any") from None
        raise ValueError(f"port {port} cannot be opened ({error}): choose another one by --port") from None


def _unwritable(path):
    """Why nothing can be stored at a path; empty where it seems possible."""
    folder = next(parent for parent in path.absolute().parents if parent.exists())
    if not folder.is_dir():
        return f"{folder} is no folder: nothing can be saved to {path}"
    target = path if path.exists() else folder
    return "" if os.access(folder, os.W_OK) else f"{target} cannot be written: nothing can be saved"
