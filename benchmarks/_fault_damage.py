"""Damaged files, a clock that was set back, and a network that is cut, for benchmarks.faults."""

import functools
import hashlib
import http.server
import os
import sqlite3
import subprocess
import sys
import tempfile
import threading
import time
import zipfile
from pathlib import Path

from benchmarks._fault_workspace import DATA, ROOT, SET, STAGES, command, environment, forget
from benchmarks.faults import lost, said

PAST, FUTURE = 315532800, 4102444800  # 1980 and 2100, in seconds since 1970


def cases(whole):
    """All of them, one after the other."""
    yield from damaged_files(whole)
    yield from clock(whole)
    yield from damaged_cache(whole)
    yield from damaged_checkpoint()
    yield from cut_network()


def damaged_cache(whole):
    """Entries of the cache of objects, and its index, in several ways."""
    index = ROOT / "build/objects/cache.db"
    ways = {
        "every entry cut in half": _half,
        "every entry removed": Path.unlink,
        "the index is no database": _garbage,
        "pages in the middle of the index": _page,
        "the index is empty": _empty,
    }
    for way, spoil in ways.items():
        _prime()
        for path in [index] if "index" in way else list(index.parent.rglob("*.val")):
            spoil(path)
        forget("lod", cache=False)
        process = command("stages.lod", SET)
        yield "damaged", "build/objects", way, said(process), lost(whole)


def _prime():
    """Fills the cache of objects with what the stage lod makes, and folds the log of the index into it."""
    forget("lod")
    command("stages.lod", SET).check_returncode()
    with sqlite3.connect(ROOT / "build/objects/cache.db") as index:
        index.execute("PRAGMA wal_checkpoint(TRUNCATE)")
    index.close()


def _half(path):
    path.write_bytes(path.read_bytes()[: path.stat().st_size // 2])


def _garbage(path):
    path.write_bytes(b"\x00garbage\xff" * 500)


def _empty(path):
    path.write_bytes(b"")


def _page(path):
    content = bytearray(path.read_bytes())
    content[4096:-4096] = b"\xff" * (len(content) - 8192)
    path.write_bytes(content)


def damaged_files(whole):
    """An archive of a mesh, dvc.lock, params.yaml and DVC's list of what runs: the error, then the remedy."""
    for path in (DATA / "meshes/ball.npz", ROOT / "params.yaml"):
        sound = path.read_bytes()
        _garbage(path)
        process = command("stages.views", SET)
        path.write_bytes(sound)
        forget("views", cache=False)
        again = command("stages.views", SET)
        where = path.relative_to(ROOT).as_posix()
        attempt = "`python -m stages.views`, then again with the sound file"
        yield "damaged", where, attempt, f"{said(process)}; then {said(again)}", lost(whole)
    for name in ("dvc.lock", "params.yaml", ".dvc/tmp/rwlock", f"data/{SET}/meshes/ball.npz"):
        path = ROOT / name
        sound = path.read_bytes() if path.exists() else b"{}"
        _garbage(path)
        process = command("stages.repro")
        if process.returncode:
            path.write_bytes(sound)
        again = command("stages.repro")
        attempt = "`python -m stages.repro`, then again" + (" with the sound file" if process.returncode else "")
        yield "damaged", name, attempt, f"{said(process)}; then {said(again)}", lost(whole)
    (ROOT / "dvc.lock").unlink()
    process = command("stages.repro")
    yield "damaged", "dvc.lock", "removed, then `python -m stages.repro`", said(process), lost(whole)


def damaged_checkpoint():
    """A training of three epochs, killed after two, whose checkpoint is cut in half."""
    import torch

    from haptic_glance.deep import training

    path = ROOT / "checkpoint.pt"

    def train(epochs):
        torch.manual_seed(0)
        model = torch.nn.Linear(4, 2)
        steps = torch.optim.SGD(model.parameters(), lr=0.1, momentum=0.9)
        for epoch in range(training.resume(path, {}, model=model, steps=steps), epochs):
            steps.zero_grad()
            model(torch.rand(8, 4)).square().sum().backward()
            steps.step()
            training.save(path, epoch + 1, {}, model=model, steps=steps)
        return model.state_dict()

    reference = train(3)
    for spoil, damage in ((_half, "cut in half"), (_garbage, "garbage")):
        path.unlink()
        train(2)
        spoil(path)
        weights = train(3)
        same = all(torch.equal(reference[key], weights[key]) for key in reference)
        happened = "ignored and said so; trained from the beginning, the same weights" if same else "other weights"
        yield "damaged", "training checkpoint", damage, happened, "nothing" if same else "the weights"


def clock(whole):
    """Times of files before and after those that are known, with the same content and with another one."""
    inputs = sorted((ROOT / "own").iterdir())
    made = [path for path in DATA.rglob("*") if path.is_file()]
    command("stages.repro").check_returncode()
    for name, paths, moment in (("inputs", inputs, PAST), ("outputs", made, PAST), ("outputs", made, FUTURE)):
        for path in paths:
            os.utime(path, (moment, moment))
        process = command("stages.repro")
        happened = f"ran {_ran(process)} stages; {said(process)}"
        year = time.gmtime(moment).tm_year
        yield "clock set back", name, f"same content, times of {year}; stages.repro", happened, lost(whole)
    yield from _other_content(inputs[0], whole)


def _ran(process):
    """How many stages told their result."""
    return len({line.partition(":")[0] for line in process.stdout.splitlines()} & set(STAGES))


def _other_content(path, whole):
    """Writes a file in place with as many other bytes: times before all that are known, and those that it had."""
    sound = path.read_bytes()
    other = sound[:-3] + sound[-4:-3] * 3  # the last corner of the last face
    for known in (False, True):
        before = path.stat().st_mtime_ns if known else (PAST - 86400) * 10**9
        path.write_bytes(other)
        os.utime(path, ns=(before, before))
        process = command("stages.repro")
        count = _ran(process)
        path.write_bytes(sound)
        command("stages.repro").check_returncode()
        attempt = (
            f"other content of the same size in place, {'the time it had' if known else 'times of 1979'}; back again"
        )
        loss = lost(whole) if count else "nothing, but DVC sees no change until the file is touched or replaced"
        yield "clock set back", "inputs", attempt, f"ran {count} stages on it; {said(process)}", loss


def cut_network():
    """A package index that closes the connection half-way, and then does not."""
    name, member = "faults_wheel-1.0-py3-none-any.whl", "faults_wheel-1.0.dist-info"
    with tempfile.TemporaryDirectory() as folder:
        wheel = Path(folder, name)
        with zipfile.ZipFile(wheel, "w") as stored:
            stored.writestr(f"{member}/METADATA", "Metadata-Version: 2.1\nName: faults-wheel\nVersion: 1.0\n")
            stored.writestr(f"{member}/WHEEL", "Wheel-Version: 1.0\nRoot-Is-Purelib: true\nTag: py3-none-any\n")
            stored.writestr(f"{member}/RECORD", "")
            stored.writestr("faults_wheel/data", os.urandom(2**20))
        content, digest = wheel.read_bytes(), hashlib.sha256(wheel.read_bytes()).hexdigest()
        handler = functools.partial(_Index, name, content, cut := [True])
        server = http.server.ThreadingHTTPServer(("127.0.0.1", 0), handler)
        threading.Thread(target=server.serve_forever, daemon=True).start()
        asks = "from haptic_glance.base.errors import errors_in_one_line as e; "
        asks += "from haptic_glance.base.fetch import fetch_package; "
        asks += f"e('fetch'); fetch_package('faults-wheel==1.0', {name!r}, {digest!r})"
        more = {
            "PIP_INDEX_URL": f"http://127.0.0.1:{server.server_port}/simple",
            "HAPTIC_GLANCE_CACHE": f"{folder}/kept",
        }
        more |= {"PIP_NO_CACHE_DIR": "1", "PIP_RETRIES": "1", "PIP_CONFIG_FILE": os.devnull, "NO_PROXY": "127.0.0.1"}
        for state in ("closes the connection half-way", "is sound again"):
            whole = [sys.executable, "-c", asks]
            process = subprocess.run(whole, env=environment() | more, capture_output=True, text=True, timeout=300)
            cached = sorted(path.name for path in Path(folder, "kept").iterdir())
            attempt = f"fetch_package from a local index that {state}"
            yield (
                "network cut",
                "haptic_glance.base.fetch",
                attempt,
                f"{said(process)}; in the cache: {cached}",
                "nothing",
            )
            cut.clear()
        server.shutdown()


class _Index(http.server.BaseHTTPRequestHandler):
    """A package index of one wheel; while `cut` holds something it sends half of it."""

    def __init__(self, name, content, cut, *rest):
        self.name, self.content, self.cut = name, content, cut
        super().__init__(*rest)

    def do_GET(self):  # noqa: N802  # the name that http.server asks for
        page = f'<a href="/{self.name}">{self.name}</a>'.encode()
        body = self.content if self.path.endswith(".whl") else page
        self.send_response(200)
        self.send_header("Content-Type", "application/octet-stream" if body is self.content else "text/html")
        self.send_header("Content-Length", str(len(body)))
        self.end_headers()
        self.wfile.write(body[: len(body) // 2] if body is self.content and self.cut else body)

    def log_message(self, *_):
        """Says nothing."""
