"""The annotation server: who may reach it, what it stores, and what it says when it cannot."""

import functools
import json
import os
import signal
import socket
import subprocess
import sys
import threading
from http.client import HTTPConnection
from pathlib import Path

import numpy as np
import pytest
import trimesh

from stages.kit import Mesh
from stages.kit.files import write_mesh
from stages.kit.workspace import Workspace
from stages.meshes import normalise
from stages.weights.annotate import open_server, read_marks, write_marks
from stages.weights.annotate.__main__ import find_mesh
from tests.fuzz.damage import damaged

ROOT = Path(__file__).parents[2]
TIME = "2026-05-06T07:08:09.123Z"


@pytest.fixture(scope="module")
def cube():
    shape = trimesh.creation.box()
    return normalise(Mesh(shape.vertices, shape.faces))


@pytest.fixture
def server(cube, tmp_path):
    opened = open_server("cube", cube, tmp_path / "marks", "ann")
    thread = threading.Thread(target=opened.serve_forever, kwargs={"poll_interval": 0.02})
    thread.start()
    yield opened
    opened.shutdown()
    thread.join()
    opened.server_close()


def ask(server, path, method="GET", body=None, host=None, **headers):
    """(status, body) of one request."""
    port = server.server_port
    connection = HTTPConnection("127.0.0.1", port, timeout=5)
    connection.request(method, path, body, {"Host": host or f"127.0.0.1:{port}"} | headers)
    answer = connection.getresponse()
    content = answer.read()
    connection.close()
    return answer.status, json.loads(content) if answer.headers["Content-Type"] == "application/json" else content


def save(server, vertices, seen=(), **changes):
    sent = {
        "annotator": "ann",
        "mesh": ask(server, "/about")[1]["mesh"],
        "marks": [{"time": TIME, "vertex": vertex} for vertex in vertices],
        "seen": [{"time": TIME, "vertex": vertex} for vertex in seen],
    }
    return ask(server, "/marks", "PUT", json.dumps(sent | changes))


def test_only_this_machine_can_reach_it(server):
    assert server.server_address[0] == "127.0.0.1"


def test_a_page_from_elsewhere_can_neither_read_nor_write(server, tmp_path):
    for path in ("/", "/marks?annotator=ann", "/mesh"):
        assert ask(server, path, host="evil.example")[0] == 403
    assert ask(server, "/marks", "PUT", "{}", host="evil.example:80")[0] == 403
    assert not (tmp_path / "marks").exists()


@pytest.mark.parametrize("origin", ["http://evil.example", "https://127.0.0.1:{}", "http://localhost:{}", "null", ""])
def test_a_page_of_another_origin_can_neither_read_nor_write(server, tmp_path, origin):
    origin = origin.format(server.server_port)
    about = ask(server, "/about")[1]
    sent = {"annotator": "ann", "mesh": about["mesh"], "marks": [{"time": TIME, "vertex": 1}], "seen": []}
    for path, method in (("/", "GET"), ("/mesh", "GET"), ("/marks", "PUT"), ("/nothing", "GET")):
        assert ask(server, path, method, json.dumps(sent), Origin=origin)[0] == 403
    assert not (tmp_path / "marks").exists()
    own = f"http://127.0.0.1:{server.server_port}"
    assert ask(server, "/marks", "PUT", json.dumps(sent), Origin=own)[0] == 200


def test_no_other_page_may_frame_or_embed_it(server):
    connection = HTTPConnection("127.0.0.1", server.server_port, timeout=5)
    connection.request("GET", "/")
    headers = connection.getresponse().headers
    connection.close()
    assert "frame-ancestors 'none'" in headers["Content-Security-Policy"]
    assert headers["Cross-Origin-Resource-Policy"] == "same-origin" and "Access-Control-Allow-Origin" not in headers


def test_damaged_requests_leave_the_server_running(server, monkeypatch, tmp_path):
    failures = []
    monkeypatch.setattr(server, "handle_error", lambda *_: failures.append(sys.exc_info()[1]))
    monkeypatch.setattr("stages.weights.annotate.server.Handler.timeout", 0.2)
    body = json.dumps({"annotator": "ann", "mesh": "x", "marks": [{"time": TIME, "vertex": 1}], "seen": []})
    head = f"PUT /marks HTTP/1.1\r\nHost: 127.0.0.1:{server.server_port}\r\nContent-Length: "
    seeds = [f"{head}{len(body)}\r\n\r\n{body}".encode(), f"{head}200000\r\n\r\n{'[' * 200_000}".encode()]
    for number in range(30):
        with socket.create_connection(("127.0.0.1", server.server_port), timeout=5) as client:
            client.sendall(seeds[1] if number == 0 else damaged(seeds[:1], number))
            client.shutdown(socket.SHUT_WR)
            while client.recv(4096):
                pass
    assert ask(server, "/about")[0] == 200 and not failures and not (tmp_path / "marks").exists()


def test_a_request_that_never_ends_is_given_up(server, monkeypatch):
    monkeypatch.setattr("stages.weights.annotate.server.Handler.timeout", 0.1)
    with socket.create_connection(("127.0.0.1", server.server_port), timeout=5) as client:
        head = f"PUT /marks HTTP/1.1\r\nHost: 127.0.0.1:{server.server_port}\r\nContent-Length: 100\r\n\r\n{{"
        client.sendall(head.encode())
        assert client.recv(4096) == b""


def test_the_page_names_no_other_machine(server):
    for path in ("/", "/page.js", "/view.js"):
        status, content = ask(server, path)
        assert status == 200 and b"//" not in content.replace(b"// ", b"").replace(b"  //", b"")


@pytest.mark.parametrize("path", ["/server.py", "/../server.py", "/etc/passwd", "/marks.csv"])
def test_nothing_else_is_served(server, path):
    assert ask(server, path)[0] == 404


def test_the_mesh_arrives_as_it_is(server, cube):
    content = ask(server, "/mesh")[1]
    count = len(cube.vertices)
    assert np.allclose(np.frombuffer(content, "<f4", 3 * count).reshape(-1, 3), cube.vertices)
    assert (np.frombuffer(content, "<u4", offset=12 * count).reshape(-1, 3) == cube.faces).all()


def test_saved_points_carry_the_places_of_their_vertices(server, cube, tmp_path):
    assert save(server, [5, 2])[0] == 200
    found = read_marks(tmp_path / "marks" / "cube.csv")
    assert list(found.vertex) == [5, 2] and list(found.time) == [TIME, TIME]
    assert np.allclose(found[["x", "y", "z"]], cube.vertices[[5, 2]], atol=5e-7)
    assert [mark["vertex"] for mark in ask(server, "/marks?annotator=ann")[1]["marks"]] == [5, 2]
    assert ask(server, "/marks?annotator=bob")[1]["marks"] == []


def test_another_persons_rows_that_appeared_meanwhile_stay(server, tmp_path):
    save(server, [5])
    bob = {"time": TIME, "vertex": 0, **dict(zip("xyz", np.full(3, -0.5 / 3**0.5), strict=True))}
    write_marks(tmp_path / "marks" / "cube.csv", "bob", [bob])
    assert save(server, [5, 6], seen=[5])[0] == 200
    found = read_marks(tmp_path / "marks" / "cube.csv")
    assert sorted(zip(found.annotator, found.vertex, strict=True)) == [("ann", 5), ("ann", 6), ("bob", 0)]


def test_own_rows_that_the_page_has_not_seen_are_a_conflict(server, tmp_path):
    save(server, [5])
    status, answer = save(server, [6])
    assert status == 409 and "changed since" in answer["error"]
    assert list(read_marks(tmp_path / "marks" / "cube.csv").vertex) == [5]


@pytest.mark.parametrize(
    "changes, reason",
    [
        ({"mesh": "another"}, "now shows cube"),
        ({"annotator": " "}, "name must have 1 to"),
        ({"marks": [{"time": TIME, "vertex": 8}]}, "vertex 8 is not on the mesh"),
        ({"marks": [{"time": TIME, "vertex": 1.5}]}, "vertex 1.5"),
        ({"marks": [{"time": "soon", "vertex": 1}]}, "not a time"),
        ({"marks": 5}, "not iterable"),
    ],
)
def test_what_cannot_be_stored_is_refused_with_the_reason(server, tmp_path, changes, reason):
    status, answer = save(server, [1], **changes)
    assert status == 400 and reason in answer["error"] and not (tmp_path / "marks").exists()


@pytest.mark.parametrize("body", ["", "no json", "[]", '{"annotator": "ann"}'])
def test_a_malformed_save_is_refused(server, tmp_path, body):
    assert ask(server, "/marks", "PUT", body)[0] == 400 and not (tmp_path / "marks").exists()


def test_a_folder_that_cannot_be_written_is_named(server, tmp_path):
    (tmp_path / "marks").write_text("a file where the folder should be")
    assert "nothing can be saved" in ask(server, "/about")[1]["warning"]
    status, answer = save(server, [1])
    assert status == 500 and str(tmp_path / "marks") in answer["error"]


def test_a_damaged_file_is_named_and_stays(server, tmp_path):
    save(server, [5])
    path = tmp_path / "marks" / "cube.csv"
    path.write_text(path.read_text() + "ann,half a li")
    before = path.read_bytes()
    for status, answer in (save(server, [5, 6], seen=[5]), ask(server, "/marks?annotator=ann")):
        assert status == 400 and "cube.csv, line 3" in answer["error"]
    assert path.read_bytes() == before


def test_marks_of_another_mesh_are_not_mixed_in(server, cube, tmp_path):
    save(server, [5])
    with pytest.raises(ValueError, match="is of another mesh"):
        open_server("cube", Mesh(cube.vertices[::-1], cube.faces), tmp_path / "marks")


def test_a_taken_port_is_said_so(server, cube, tmp_path):
    with pytest.raises(ValueError, match=f"port {server.server_port} is taken: .*--port"):
        open_server("cube", cube, tmp_path, port=server.server_port)
    with pytest.raises(ValueError, match="port 70000 cannot be opened"):
        open_server("cube", cube, tmp_path, port=70000)


def test_meshes_are_found_by_file_and_by_name(cube, tmp_path):
    workspace = Workspace(tmp_path, "toys")
    with pytest.raises(ValueError, match="none; `dvc repro meshes@toys` fills .*data/toys/meshes"):
        find_mesh("cube", workspace)
    write_mesh(tmp_path / "data/toys/meshes/cube.npz", cube)
    write_mesh(tmp_path / "data/toys/meshes/box.npz", cube)
    assert find_mesh("cube", workspace)[0] == "cube"
    with pytest.raises(ValueError, match="'cup' is neither a mesh file nor an object; objects: box, cube"):
        find_mesh("cup", workspace)
    trimesh.creation.box(extents=[2, 4, 4]).export(tmp_path / "brick.off")
    name, mesh = find_mesh(str(tmp_path / "brick.off"), workspace)
    assert name == "brick" and np.allclose(np.linalg.norm(mesh.vertices, axis=1), 0.5)
    trimesh.creation.box(extents=[1, 4, 2]).export(tmp_path / "tower.glb")
    for file, up, side in (("tower.glb", None, 2), ("tower.glb", "z", 1), ("brick.off", "x", 1)):
        shown = find_mesh(str(tmp_path / file), workspace, up)[1]
        assert shown.up == "z" and np.ptp(shown.vertices, axis=0)[side] == np.ptp(shown.vertices, axis=0).max()
    with pytest.raises(ValueError, match="'cube' is upright"):
        find_mesh("cube", workspace, "y")
    (tmp_path / "torn.off").write_text("OFF\n9 9 9\n")
    with pytest.raises(ValueError, match=r"torn\.off: truncated"):
        find_mesh(str(tmp_path / "torn.off"), workspace)


@pytest.mark.slow
def test_the_command_serves_until_it_is_interrupted(tmp_path):
    trimesh.creation.box().export(tmp_path / "brick.off")
    command = [sys.executable, "-m", "stages.weights.annotate", "toys", str(tmp_path / "brick.off")]
    command += ["--folder", str(tmp_path)]
    bare = {key: value for key, value in os.environ.items() if key not in ("DISPLAY", "WAYLAND_DISPLAY", "BROWSER")}
    options = {"cwd": ROOT, "env": bare, "text": True, "stdout": subprocess.PIPE, "stderr": subprocess.PIPE}
    heard = functools.partial(signal.signal, signal.SIGINT, signal.SIG_DFL)  # what runs in the background ignores it
    options["preexec_fn"] = heard
    running = subprocess.Popen([*command, "--port", "0"], **options)
    try:
        line = running.stdout.readline()
        port = int(line.split("http://127.0.0.1:")[1].split("/")[0])
        with socket.create_connection(("127.0.0.1", port), timeout=5):
            pass
        running.send_signal(signal.SIGINT)
        assert running.wait(timeout=10) == 0
        assert running.stderr.read() == "brick: z up, a guess, since OFF does not say (another axis: --up)\n"
    finally:
        running.kill()
        running.communicate()
