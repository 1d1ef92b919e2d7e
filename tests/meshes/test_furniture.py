"""The source of furniture: taken out of a Debian package once, by an explicit list, with whom to credit."""

import hashlib
import io
import tarfile
import zipfile
from types import SimpleNamespace

import numpy as np
import pytest
import trimesh

from haptic_glance.base.fetch import FetchError, cache_folder, debian_files, fetch_debian
from stages.meshes import furniture
from stages.meshes.collect import prepare_mesh
from stages.meshes.sources import SOURCES

CUBE = trimesh.creation.box((2, 4, 6))
CATALOGUE = """# a comment
id=SweetHome3D#Models
id#1=Some Library#crate
name#1=Crate
model#1=/lib/crate/crate.obj
height#1=40.0
creator#1=A. Carpenter
id#2=Some Library#other
model#2=/lib/other/other.obj
height#2=1
creator#2=nobody
"""


def sh3f():
    stream = io.BytesIO()
    with zipfile.ZipFile(stream, "w") as archive:
        archive.writestr("PluginFurnitureCatalog.properties", CATALOGUE)
        archive.writestr("lib/crate/crate.obj", "mtllib paint.mtl\nusemtl a\n" + CUBE.export(file_type="obj"))
        archive.writestr("lib/crate/paint.mtl", "newmtl a\nKd 1 0 0\nmap_Kd gone.png\n")
        archive.writestr("lib/other/other.obj", "v 0 0 0\nv 1 0 0\nv 0 0 1\nf 1 3 2\n")
    return stream.getvalue()


def deb(files):
    """The bytes of a Debian package: an ar archive with a compressed data.tar of the files."""
    data = io.BytesIO()
    with tarfile.open(fileobj=data, mode="w:xz") as archive:
        for name, content in files.items():
            member = tarfile.TarInfo(f"./{name}")
            member.size = len(content)
            archive.addfile(member, io.BytesIO(content))
    packed = b"!<arch>\n"
    for name, content in (("debian-binary", b"2.0"), ("control.tar.xz", b"odd"), ("data.tar.xz", data.getvalue())):
        packed += f"{name:<16}{0:<12}{0:<6}{0:<6}{100644:<8}{len(content):<10}`\n".encode() + content
        packed += b"\n" * (len(content) % 2)
    return packed


@pytest.fixture
def package(tmp_path, monkeypatch):
    """A catalogue of two entries, one of them chosen, as a package in a cache of its own."""
    content = deb({"usr/share/doc/copyright": b"text", f"{furniture.FOLDER}/Scopia.sh3f": sh3f()})
    (tmp_path / furniture.PACKAGE).write_bytes(content)
    monkeypatch.setenv("HAPTIC_GLANCE_CACHE", str(tmp_path))
    monkeypatch.setattr(furniture, "HASH", hashlib.sha256(content).hexdigest())
    for module in (furniture, __import__("stages.meshes.sources", fromlist=["FURNITURE"])):
        monkeypatch.setattr(module, "FURNITURE", {"box": ("Scopia", "crate")})
    return tmp_path / furniture.PACKAGE


def items(*objects):
    return SOURCES["furniture"](SimpleNamespace(objects=list(objects)))


def test_the_chosen_entry_comes_out_of_the_package_with_its_maker_licence_and_unit(package):
    (item,) = items()
    assert (item.name, item.creator, item.licence, item.up) == ("box", "A. Carpenter", "CC-BY-3.0", "y")
    assert item.unit == "10 cm"  # the model is 4 high, the catalogue says 40 cm
    mesh, row = prepare_mesh(item)
    assert row["watertight"] and row["faces"] == 12 and row["size"] == 6
    np.testing.assert_allclose(np.ptp(mesh.vertices, axis=0) / np.ptp(mesh.vertices), [1, 2 / 6, 4 / 6])


def test_the_whole_catalogue_comes_out_with_licences_and_a_flat_model_has_no_unit(package):
    crate, other = SOURCES["catalogue"](SimpleNamespace(objects=[]))
    assert (crate.name, crate.file, crate.unit) == ("Scopia__crate", "Scopia/crate.obj", "10 cm")
    assert (other.name, other.unit, other.licence, other.creator) == ("Scopia__other", "unknown", "CC-BY-3.0", "nobody")
    assert crate.content() == items()[0].content() and b"v 1 0 0" in other.content()
    (chosen,) = SOURCES["catalogue"](SimpleNamespace(objects=["Scopia__other"]))
    assert chosen.name == "Scopia__other"


def test_materials_come_along_and_one_that_the_package_lacks_is_named(package):
    mesh, row = prepare_mesh(items()[0], colours="own")
    assert (mesh.colors == (255, 0, 0)).all() and "gone.png, which it names, is not there" in row["repairs"]
    crate, other = SOURCES["catalogue"](SimpleNamespace(objects=[]))
    assert crate.beside() == items()[0].beside() and other.beside() == {}


def test_the_package_is_needed_once_and_a_damaged_extract_is_made_anew(package):
    first = items()[0].content()
    extract = next(package.parent.glob("furniture-*.zip"))
    extract.write_bytes(extract.read_bytes()[:200])
    assert items()[0].content() == first
    package.write_bytes(package.read_bytes()[:-300])
    with pytest.raises(FetchError, match="damaged"):
        list(debian_files(package))
    package.unlink()
    assert items()[0].content() == first


def test_the_package_is_streamed_and_never_unpacked_to_disk(package):
    assert [name for name, _ in debian_files(package)] == ["usr/share/doc/copyright", f"{furniture.FOLDER}/Scopia.sh3f"]
    items()
    assert len(list(package.parent.iterdir())) == 2  # the package and the extract


def test_a_failed_download_names_what_apt_said_and_leaves_nothing(tmp_path, monkeypatch):
    (tmp_path / "bin").mkdir()
    apt = tmp_path / "bin/apt-get"
    apt.write_text("#!/bin/sh\necho rubbish > rubbish.deb\necho 'E: Unable to locate package' >&2\nexit 100\n")
    apt.chmod(0o755)
    monkeypatch.setenv("HAPTIC_GLANCE_CACHE", str(tmp_path / "cache"))
    monkeypatch.setenv("PATH", f"{apt.parent}:/usr/bin:/bin")
    with pytest.raises(FetchError, match="cannot fetch some=1.0: E: Unable to locate package. Get some_1.0_all.deb"):
        fetch_debian("some_1.0_all.deb", "00")
    assert not list((tmp_path / "cache").iterdir())


@pytest.mark.slow
@pytest.mark.skipif(not list(cache_folder().glob("furniture-*.zip")), reason="the furniture was never fetched here")
def test_the_real_pieces_are_upright_outward_and_of_the_promised_size():
    for item in items()[::4]:
        mesh, row = prepare_mesh(item)
        assert 1000 <= row["faces"] <= 60_000, item.name
        low, high = np.quantile(mesh.vertices[:, 2], [0, 1])
        assert np.ptp(mesh.vertices[mesh.vertices[:, 2] < low + 0.05 * (high - low)], axis=0)[:2].max() > 0.05
        assert (mesh.face_crosses * mesh.vertices[mesh.faces[:, 0]]).sum() > 0, f"{item.name}: faces inwards"
