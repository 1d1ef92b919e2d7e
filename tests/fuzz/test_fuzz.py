"""Files and meshes that nobody expected get a right result, or one sentence that names them; never a crash or a hang.

Damaged files (`attack`), archives that reach outside their folder, meshes with every fault (hypothesis), and, where
FUZZ_SECONDS is 600 or more, 443 mesh files of other people.
"""

import io
import os
import resource
import stat
import subprocess
import sys
import tarfile
import warnings
import zipfile
from contextlib import redirect_stderr
from pathlib import Path

import numpy as np
import pytest
import trimesh
from hypothesis import given, settings
from hypothesis import strategies as st

from haptic_glance import metro, normalise, press, saliency
from haptic_glance.__main__ import run
from haptic_glance.base.fetch import LARGEST, FetchError, debian_files, fetch_debian, read_members, read_tar_members
from haptic_glance.base.files import open_picture
from haptic_glance.gallery.demo import sample
from haptic_glance.mesh import MeshError, clean, load
from haptic_glance.mesh.files import FORMATS
from haptic_glance.mesh.mesh import Mesh
from stages.engine.objects import FILES, ROWS, Objects
from stages.meshes.sources import GAZE, collection_files
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


ESCAPES = ["../evil", "a/../../evil", "/evil", "a/.."]


def zipped(path, name, mode=0o644):
    with zipfile.ZipFile(path, "w") as archive:
        member = zipfile.ZipInfo(name)
        member.external_attr = mode << 16
        archive.writestr(member, b"/etc/passwd")
    return path


def tarred(path, name, kind=tarfile.REGTYPE, size=0):
    member = tarfile.TarInfo(name)
    member.type, member.linkname, member.size = kind, "/etc/passwd", size
    path.write_bytes(member.tobuf() + bytes(10240))
    return path


def packed(path, inner):
    """A Debian package around a tar archive."""
    data = inner.read_bytes()
    header = b"data.tar".ljust(48) + str(len(data)).encode().ljust(10) + b"`\n"
    path.write_bytes(b"!<arch>\n" + header + data)
    return path


@pytest.mark.parametrize("name", ESCAPES)
def test_a_member_that_would_escape_is_refused(name, tmp_path):
    archive = zipped(tmp_path / "a.zip", name)
    for work in (lambda: list(read_members(archive, [name])), collection_files(archive, *GAZE)[name]):
        with pytest.raises(FetchError, match=r"a\.zip: member .* points outside the archive"):
            work()
    tar = tarred(tmp_path / "a.tar", name)
    for work in (
        lambda: list(read_tar_members(tar, [name])),
        lambda: list(debian_files(packed(tmp_path / "b.deb", tar))),
    ):
        with pytest.raises(FetchError, match=r"(a\.tar|b\.deb): member .* points outside the archive"):
            work()


def test_a_link_is_no_member(tmp_path):
    archive = zipped(tmp_path / "a.zip", "link", stat.S_IFLNK | 0o777)
    with pytest.raises(FetchError, match=r"a\.zip: member 'link' is a link"):
        list(read_members(archive, ["link"]))
    for kind in (tarfile.SYMTYPE, tarfile.LNKTYPE, tarfile.FIFOTYPE, tarfile.CHRTYPE):
        tar = tarred(tmp_path / "a.tar", "link", kind)
        with pytest.raises(FetchError, match=r"a\.tar: no member link"):
            list(read_tar_members(tar, ["link"]))
        assert not list(debian_files(packed(tmp_path / "b.deb", tar)))


def test_a_member_larger_than_memory_is_refused_before_it_is_read(tmp_path):
    path = zipped(tmp_path / "a.zip", "bomb")
    content = path.read_bytes()
    at = content.index(b"PK\1\2") + 24  # the stated size, in the central directory
    path.write_bytes(content[:at] + (LARGEST + 1).to_bytes(4, "little") + content[at + 4 :])
    tar = tarred(tmp_path / "a.tar", "bomb", size=LARGEST + 1)
    reads = (lambda: read_members(path, ["bomb"]), lambda: read_tar_members(tar, ["bomb"]),
             lambda: debian_files(packed(tmp_path / "b.deb", tar)))  # fmt: skip
    for read in reads:
        with pytest.raises(FetchError, match=r"(a\.zip|a\.tar|b\.deb): member 'bomb' states 1073741825 bytes"):
            list(read())


def test_a_kept_result_cannot_write_outside_its_folder(tmp_path, capsys):
    stream = io.BytesIO()
    with zipfile.ZipFile(stream, "w") as archive:
        archive.writestr(ROWS, "[]")
        archive.writestr(f"{FILES}../../evil", b"")
    Objects(tmp_path / "cache").keep("key", stream.getvalue())
    assert Objects(tmp_path / "cache").take("key", tmp_path / "a/b") is None
    assert "outside its folder" in capsys.readouterr().err and not list(tmp_path.glob("**/evil"))


CLOSED = {
    "ball": trimesh.creation.icosphere(subdivisions=2),
    "box": trimesh.creation.box().subdivide(),
    "torus": trimesh.creation.torus(1, 0.4, major_sections=16, minor_sections=8),
    "tetrahedron": trimesh.Trimesh([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]],
                                   [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]]),
}  # fmt: skip
FAULTS = ("holes", "degenerate faces", "duplicate faces", "duplicate vertices", "fin", "stray vertex", "turned faces")


@st.composite
def meshes(draw, faults=FAULTS):
    """A Mesh of up to 330 faces, of any size and place, slightly dented, with up to three of the faults."""
    shape = CLOSED[draw(st.sampled_from(sorted(CLOSED)))]
    random = np.random.default_rng(draw(st.integers(0, 2**16)))
    stretch = [draw(st.floats(0.3, 3)) for _ in range(3)]
    vertices = (shape.vertices + 0.02 * random.standard_normal(shape.vertices.shape)) * stretch
    vertices = (vertices + draw(st.floats(-10, 10))) * 10.0 ** draw(st.integers(-3, 3))
    faces = shape.faces
    for fault in draw(st.lists(st.sampled_from(faults), max_size=3, unique=True)) if faults else []:
        vertices, faces = _damage(fault, vertices, faces, random)
    return Mesh(vertices, faces)


def _damage(fault, vertices, faces, random):
    some, last = random.choice(len(faces), max(len(faces) // 10, 1), replace=False), len(vertices)
    if fault == "holes":
        return vertices, np.delete(faces, some, axis=0)
    if fault == "degenerate faces":
        return vertices, np.r_[faces, faces[some][:, [0, 0, 1]]]
    if fault == "duplicate faces":
        return vertices, np.r_[faces, faces[some]]
    if fault == "duplicate vertices":  # of the faces that no longer share them
        faces = faces.copy()
        ids = faces[some].ravel()
        faces[some] = np.arange(last, last + len(ids)).reshape(-1, 3)
        return np.r_[vertices, vertices[ids]], faces
    if fault == "fin":  # an edge of three faces
        tip = vertices[faces[0, 0]] * 2 - vertices[faces].mean(axis=(0, 1))
        return np.r_[vertices, [tip]], np.r_[faces, [[*faces[0, :2], last]]]
    if fault == "stray vertex":
        return np.r_[vertices, vertices[:1] + 100 * np.ptp(vertices)], faces
    faces = faces.copy()
    faces[some] = faces[some][:, ::-1]
    return vertices, faces


def examples(count):
    return settings(max_examples=count, deadline=None, derandomize=True, database=None)


def usable(mesh):
    """The cleaned and normalised mesh, or None where clean says why not."""
    try:
        return normalise(clean(mesh)[0])
    except ValueError as error:
        assert str(error)
        return None


@examples(20)
@given(mesh=meshes())
@pytest.mark.slow
def test_a_normalised_mesh_fills_its_bounding_sphere(mesh):
    used = normalise(mesh).vertices[np.unique(mesh.faces)]
    assert np.linalg.norm(used, axis=1).max() == pytest.approx(0.5)
    assert used.min(axis=0) == pytest.approx(-used.max(axis=0))


@pytest.mark.slow
@examples(20)
@given(mesh=meshes())
def test_cleaning_keeps_vertices_and_leaves_no_degenerate_or_duplicate_face(mesh):
    cleaned, _ = clean(mesh)
    np.testing.assert_array_equal(cleaned.vertices, mesh.vertices)
    assert (np.diff(np.sort(cleaned.faces, axis=1), axis=1) > 0).all()
    assert len(np.unique(cleaned.faces, axis=0)) == len(cleaned.faces) <= len(mesh.faces)
    again, notes = clean(cleaned)
    np.testing.assert_array_equal(again.faces, cleaned.faces)
    assert not notes


@pytest.mark.slow
@examples(4)
@given(mesh=meshes())
def test_saliency_and_imprints_are_in_0_to_1_and_the_distance_of_a_mesh_to_itself_is_zero(mesh):
    mesh = usable(mesh)
    values = saliency(mesh)
    assert values.shape == (len(mesh.vertices),) and np.isfinite(values).all()
    assert 0 <= values.min() <= values.max() <= 1
    assert max(metro(mesh, mesh).values()) < 1e-7
    try:
        image = press(mesh, int(mesh.faces[0, 0]))
    except ValueError as error:
        assert str(error)
        return
    assert image.shape == (16, 16) and np.isfinite(image).all() and image.min() >= 0 and image.max() <= 1


NEEDED = 600  # seconds of FUZZ_SECONDS: it fetches 83 MB by `apt-get download` and computes for ten minutes

# A package's file; how many of its files have a suffix that `load` knows, and how many hold a mesh; its SHA-256.
PACKAGES = {
    "assimp": (
        "assimp-testmodels_5.2.5~ds0-1_all.deb", (125, 77),
        "526f326186000cd6f631ea806128548a7d3d391abd8149fddc5c4c8513e80b8a",
    ),
    "cura": (
        "cura_4.13.0-1_all.deb", (92, 92),
        "c6e638533a9f86d0781a82a1eeff14f6bddcca2e2bd25922b2be6da2199fb102",
    ),
    "geomview": (
        "geomview_1.9.5-4+b1_amd64.deb", (28, 22),
        "b80d2d4f1f8fc6e3a76ecfd97b379bdf693836dd264a42a85c627eacbb7893f2",
    ),
    "gltron": (
        "gltron_0.70final-12.4_amd64.deb", (5, 5),
        "2346dead4c2513edf354e173beef29bd930e497573b766b03d6e96fb32c9fb7e",
    ),
    "cgal": (
        "libcgal-demo_5.5.1-2_all.deb", (171, 165),
        "78b09b23d4d6d1bf15552a1060b419ab3fc09918486462faed197e5fc6ac3735",
    ),
    "netgen": (
        "netgen-doc_6.2.2006+really6.2.1905+dfsg-5.1_all.deb", (2, 2),
        "30ad87a3dd13e0bd0edbc0f71809934a1d1419380e455248c24e325e881000cc",
    ),
    "openscad": (
        "openscad-testing-data_2021.01-6_all.deb", (20, 15),
        "4a05b16116ca8da7cb10224809f66094a991d5b4d7de75c087d1d85120536857",
    ),
}  # fmt: skip
BESIDE = (".bin", ".mtl", ".png", ".jpg", ".jpeg", ".bmp", ".tga")  # what a glTF, an OBJ or a DAE names
COMMAND_SECONDS, COMMAND_MEMORY = 60, 2 * 2**20  # of one command: processor seconds, KiB


def unpacked(package, digest, folder):
    """The mesh files of a package, in a folder with what belongs to them; an archive in the package, too."""

    def keep(name, stream):
        if Path(name).suffix.lower() in (*FORMATS, *BESIDE):
            (folder / name).parent.mkdir(parents=True, exist_ok=True)
            (folder / name).write_bytes(stream.read())

    for name, stream in debian_files(fetch_debian(package, digest)):
        if name.endswith("/data.tar.gz"):
            with tarfile.open(fileobj=stream, mode="r|gz") as inner:
                for member in filter(tarfile.TarInfo.isfile, inner):
                    keep(member.name, inner.extractfile(member))
        else:
            keep(name, stream)
    return sorted(path for path in folder.rglob("*") if path.suffix.lower() in FORMATS)


def shown(message, category, *_):
    """Prints a warning in one line, as a command does; the word Warning marks a warning that is not for the user."""
    print(message if issubclass(category, UserWarning) else f"{category.__name__}: {message}")


def attempted(command, arguments, log):
    """(how the command ended, its processor seconds, its memory in KiB, its words), in a process of its own."""
    child = os.fork()  # kernels and imports are there already
    if child == 0:
        status = 1
        try:
            resource.setrlimit(resource.RLIMIT_CPU, (COMMAND_SECONDS + 5, COMMAND_SECONDS + 5))
            warnings.showwarning = shown  # pytest's own keeps warnings from the log
            with log.open("w", encoding="utf-8") as sys.stdout, redirect_stderr(sys.stdout):
                try:
                    status = run(command, arguments)
                except BaseException:
                    sys.excepthook(*sys.exc_info())
        finally:
            os._exit(status)
    _, status, used = os.wait4(child, 0)
    return status, used.ru_utime + used.ru_stime, used.ru_maxrss, log.read_text(encoding="utf-8")


def faults(path, status, seconds, memory, text):
    """Names the faults of a command on a file: a crash, a passed limit, a warning, a refusal without the name."""
    last = (text.strip().splitlines() or [""])[-1]
    checks = {
        f"ended by signal {status & 127}": status & 127,
        f"{seconds:.0f} s": seconds > COMMAND_SECONDS,
        f"{memory >> 10} MiB": memory > COMMAND_MEMORY,
        "a traceback": "Traceback" in text,
        "a warning": "Warning" in text,
        f"a refusal without the file's name: {last}": status and path.name not in last,
    }
    return [fault for fault, holds in checks.items() if holds]


@pytest.fixture(scope="module")
def warm(tmp_path_factory):
    """Compiles, so that no file waits for it."""
    folder = tmp_path_factory.mktemp("warm")
    run("saliency", [str(sample()), "--out", str(folder / "look.ply")])
    run("simplify", [str(sample()), "--faces", "500", "--out", str(folder / "small.ply")])


@pytest.mark.slow
@pytest.mark.skipif(float(os.environ.get("FUZZ_SECONDS", "0")) < NEEDED, reason=f"FUZZ_SECONDS is below {NEEDED}")
@pytest.mark.parametrize("name", PACKAGES)
def test_every_file_is_looked_at_and_simplified_or_refused_in_one_line(name, tmp_path, warm):
    package, (known, held), digest = PACKAGES[name]
    files = unpacked(package, digest, tmp_path / "files")
    count, met = 0, []
    for path in files:
        commands = {"saliency": ["--out", str(tmp_path / "look.ply")]}
        commands["simplify"] = ["--faces", "500", "--out", str(tmp_path / "small.ply")]
        for command, options in commands.items():
            outcome = attempted(command, [str(path), *options], tmp_path / "log")
            count += command == "saliency" and outcome[0] == 0
            met += [f"{command} {path.relative_to(tmp_path)}: {fault}" for fault in faults(path, *outcome)]
    assert not met, "\n".join(met)
    assert (len(files), count) == (known, held)
