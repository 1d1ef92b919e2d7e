"""Mesh files of other people, from Debian packages: each is looked at and simplified, or refused in one line.

`make foreign` runs this, `make test` does not. It fetches 83 MB by `apt-get download`, each package once by its hash,
and computes for ten minutes.
"""

import os
import resource
import sys
import tarfile
import warnings
from contextlib import redirect_stderr
from pathlib import Path

import pytest

from haptic_glance.__main__ import run
from haptic_glance.base.fetch import debian_files, fetch_debian
from haptic_glance.gallery.demo import sample
from haptic_glance.mesh.files import FORMATS

pytestmark = pytest.mark.slow

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
SECONDS, MEMORY = 60, 2 * 2**20  # of one command: processor seconds, KiB; half are for the surface of 100,000 points


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
            resource.setrlimit(resource.RLIMIT_CPU, (SECONDS + 5, SECONDS + 5))
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
        f"{seconds:.0f} s": seconds > SECONDS,
        f"{memory >> 10} MiB": memory > MEMORY,
        "a traceback": "Traceback" in text,
        "a warning": "Warning" in text,
        f"a refusal without the file's name: {last}": status and path.name not in last,
    }
    return [fault for fault, holds in checks.items() if holds]


@pytest.fixture(scope="module", autouse=True)
def warm(tmp_path_factory):
    """Compiles, so that no file waits for it."""
    folder = tmp_path_factory.mktemp("warm")
    run("saliency", [str(sample()), "--out", str(folder / "look.ply")])
    run("simplify", [str(sample()), "--faces", "500", "--out", str(folder / "small.ply")])


@pytest.mark.parametrize("name", PACKAGES)
def test_every_file_is_looked_at_and_simplified_or_refused_in_one_line(name, tmp_path):
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
