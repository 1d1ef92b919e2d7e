"""Archives of others: nothing of them gets outside its folder, fills the memory, or is unpickled."""

import io
import stat
import tarfile
import zipfile
from pathlib import Path

import diskcache
import pytest

from haptic_glance.base.fetch import LARGEST, FetchError, debian_files, read_members, read_tar_members
from stages.engine.objects import FILES, ROWS, Objects
from stages.meshes.sources import GAZE, collection_files

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
    with diskcache.Cache(str(tmp_path / "cache")) as kept:
        kept.set("key", stream.getvalue())
    assert Objects(tmp_path / "cache").take("key", tmp_path / "a/b") is None
    assert "outside its folder" in capsys.readouterr().err and not list(tmp_path.glob("**/evil"))


class Trap:
    """Leaves a trace where it is unpickled."""

    def __init__(self, path):
        self.path = path

    def __reduce__(self):
        return Path.touch, (self.path,)


def test_a_kept_result_is_never_unpickled(tmp_path, capsys):
    with diskcache.Cache(str(tmp_path / "cache")) as kept:
        kept.set("key", Trap(tmp_path / "trace"))
    assert Objects(tmp_path / "cache").take("key", tmp_path / "out") is None
    assert "pickled" in capsys.readouterr().err and not (tmp_path / "trace").exists()
