"""A damaged file is read, or refused in one sentence that names it: no other error, crash, hang, or too much memory."""

import os
import resource
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from haptic_glance.base.files import open_picture
from haptic_glance.mesh import MeshError, load
from tests.fuzz.attack import MEMORY, fault_of, limits
from tests.fuzz.readers import READERS, Reader

ROOT = Path(__file__).parents[2]
BUDGET = float(os.environ.get("FUZZ_SECONDS", "60"))  # of the processor, for all readers together


@pytest.mark.slow
def test_damaged_files_are_read_or_refused(tmp_path):
    command = [sys.executable, "-m", "tests.fuzz.attack", str(tmp_path), str(BUDGET), *READERS]
    process = subprocess.run(command, cwd=ROOT, capture_output=True, text=True)
    assert process.returncode == 0, f"ended with {process.returncode}: {process.stderr[-2000:]}"
    assert not process.stdout
    assert [line.rpartition(" ")[0] for line in process.stderr.splitlines() if line[-1].isdigit()] == [*READERS]


@pytest.mark.filterwarnings("ignore")
@pytest.mark.parametrize("name", ["stl", "ply", "off", "glb", "zip", "picture", "marks"])
def test_the_files_that_are_damaged_were_sound(name, tmp_path):
    reader = READERS[name]
    for content in reader.seeds(tmp_path):
        path = tmp_path / reader.file
        path.write_bytes(content)
        reader.read(path)


def hang(path):
    while True:
        pass


BREAKS = {
    "not done": hang,
    "KeyError": lambda path: {}["x"],
    "does not name": lambda path: int("x"),
    "MemoryError": lambda path: np.ones(2 * MEMORY, dtype=np.uint8),
}


@pytest.mark.parametrize("fault", BREAKS)
def test_what_breaks_the_rule_is_found(fault, tmp_path, monkeypatch):
    monkeypatch.setattr("tests.fuzz.attack.SECONDS", 0.1 if fault == "not done" else 60)
    before = resource.getrlimit(resource.RLIMIT_AS)
    assert fault in fault_of(Reader("a.txt", lambda folder: [], BREAKS[fault]), tmp_path, b"")
    assert resource.getrlimit(resource.RLIMIT_AS) == before


def huge(name, content):
    """A sound file whose header states 4,294,967,295 vertices or faces."""
    most = b"4294967295"
    if name == "stl":
        return content[:80] + b"\xff" * 4 + content[84:]
    old = {"ply": b"element vertex 42", "off": b"42 80", "glb": b'"count":42', "obj": b"\nf 1"}[name]
    assert old in content
    changed = content.replace(old, old.replace(b"42", most).replace(b"f 1", b"f " + most), 1)
    if name == "glb":  # the lengths of the file and of its JSON part are right
        tree = int.from_bytes(content[12:16], "little") + len(changed) - len(content)
        changed = changed[:8] + len(changed).to_bytes(4, "little") + tree.to_bytes(4, "little") + changed[16:]
    return changed


@pytest.mark.parametrize("name", ["stl", "ply", "off", "glb", "obj"])
def test_four_billion_in_a_header_are_refused_before_memory_is_taken(name, tmp_path, monkeypatch):
    reader = READERS[name]
    content = huge(name, reader.seeds(tmp_path)[0])
    monkeypatch.setattr("tests.fuzz.attack.MEMORY", 2**26)
    monkeypatch.setattr("trimesh.load", lambda *_, **__: pytest.fail("a parser was asked"))
    path = tmp_path / reader.file
    path.write_bytes(content)
    with pytest.raises(MeshError, match=r"truncated|do not exist"), limits():
        load(path)


def test_a_picture_that_states_too_many_pixels_is_refused(tmp_path):
    content = bytearray(READERS["picture"].seeds(tmp_path)[2])
    content[18:26] = (6_000).to_bytes(4, "little") * 2
    with pytest.raises(ValueError, match=r"big\.bmp is not a readable picture.*6000 x 6000"):
        open_picture(bytes(content), "big.bmp")
