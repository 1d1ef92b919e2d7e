"""Many small files in a few archives: read as if they lay there, and few archives change with one object."""

import functools
import zipfile

import pytest

from stages.kit import packs
from stages.kit.files import read_arrays, read_table, sha256, write_arrays, write_text
from stages.kit.guard import UndeclaredRead
from stages.kit.packs import files_below, is_there, object_files, opened, pack
from stages.kit.run import StageRun, object_names


@pytest.fixture(autouse=True)
def few(monkeypatch):
    monkeypatch.setattr(packs, "MOST", 3)


def filled(folder, names):
    for name in names:
        write_arrays(folder / f"{name}.npz", value=[ord(name)])
        write_arrays(folder / name / "front.npz", value=[ord(name)])
        write_text(folder / name / "curve.csv", f"item\n{name}")
    write_text(folder / "table.csv", "object\nall")
    return folder


def test_few_objects_stay_files_and_many_are_packed_with_the_tables_beside_them(tmp_path):
    pack(filled(tmp_path / "few", "a"))
    assert (tmp_path / "few/a.npz").is_file() and (tmp_path / "few/a/curve.csv").is_file()
    pack(filled(tmp_path / "many", "abcdefgh"))
    left = {path.name if path.suffix != packs.SUFFIX else packs.SUFFIX for path in (tmp_path / "many").iterdir()}
    assert left == {"table.csv", packs.SUFFIX}


def test_what_is_packed_is_read_as_if_it_lay_there(tmp_path):
    plain, packed = filled(tmp_path / "plain", "abcdefgh"), filled(tmp_path / "packed", "abcdefgh")
    pack(packed)
    for name in "abcdefgh":
        assert read_arrays(packed / f"{name}.npz")["value"] == read_arrays(packed / name / "front.npz")["value"]
        assert read_table(packed / name / "curve.csv")["item"][0] == name
    names = [path.relative_to(plain) for path in files_below(plain)]
    assert [path.relative_to(packed) for path in files_below(packed)] == names and len(names) == 25
    assert [sha256(packed / name) for name in names] == [sha256(plain / name) for name in names]
    assert object_files(packed) == object_files(plain) == list("abcdefgh")
    assert [path.name for path in files_below(packed / "c")] == ["curve.csv", "front.npz"]


def test_what_is_not_there_is_not_found(tmp_path):
    packed = filled(tmp_path / "packed", "abcdefgh")
    pack(packed)
    assert is_there(packed / "a.npz") and is_there(packed / "table.csv")
    assert not is_there(packed / "z.npz") and not is_there(packed / "a/back.npz") and files_below(packed / "z") == []
    with pytest.raises(FileNotFoundError, match="z.npz"):
        opened(packed / "z.npz")


def test_one_object_more_changes_one_archive_and_equal_files_give_equal_bytes(tmp_path):
    one, more = tmp_path / "one", tmp_path / "more"
    for folder, names in ((one, "abcdefgh"), (more, "hgfedcbai")):
        for name in names:
            write_arrays(folder / f"{name}.npz", value=[ord(name)])
        pack(folder)
    before, after = ({path.name: path.read_bytes() for path in folder.iterdir()} for folder in (one, more))
    assert [name for name in after if before.get(name) != after[name]] == [packs._archive_name("i.npz")]
    assert len(after) > 5


def test_an_archive_that_was_written_anew_is_read_anew(tmp_path):
    for value in (1, 2):
        for name in "abcd":
            write_arrays(tmp_path / f"{name}.npz", value=[value] * value)
        pack(tmp_path)
        assert list(read_arrays(tmp_path / "a.npz")["value"]) == [value] * value


def test_a_damaged_archive_is_named(tmp_path):
    pack(filled(tmp_path, "abcd"))
    path = tmp_path / packs._archive_name("a.npz")
    content = bytearray(path.read_bytes())
    content[60] ^= 255
    path.write_bytes(content)
    with pytest.raises(OSError, match=f"{path.name} is damaged"):
        opened(tmp_path / "a.npz")
    path.write_bytes(content[:50])
    with pytest.raises(OSError, match=f"{path.name} is damaged"):
        opened(tmp_path / "a.npz")


def test_unzip_opens_an_archive(tmp_path):
    pack(filled(tmp_path, "abcd"))
    with zipfile.ZipFile(tmp_path / packs._archive_name("a.npz")) as stored:
        assert stored.testzip() is None and "a.npz" in stored.namelist()


def double(name, folder, data, other=""):
    """Doubles the value of an object."""
    write_arrays(folder / f"{name}.npz", value=2 * read_arrays(data / f"meshes/{other or name}.npz")["value"])
    return [{"item": name, "metric": "m", "value": 1}]


def run_stage(workspace, **more):
    with StageRun(workspace, "views", inputs=("meshes",)) as run:
        work = functools.partial(double, data=workspace.data, **more)
        rows = run.each(work, run.objects, reads=["meshes/{}.npz"])
    return rows


def test_stages_read_and_write_packed_objects_and_remake_none(make_workspace, monkeypatch):
    workspace = make_workspace({"views": {}})
    meshes, views = workspace.data / "meshes", workspace.data / "views"
    for name in "abcde":
        write_arrays(meshes / f"{name}.npz", value=[ord(name)])
    monkeypatch.setattr(packs, "MOST", 5)
    run_stage(workspace)
    plain = {path.name: path.read_bytes() for path in views.iterdir()}
    monkeypatch.setattr(packs, "MOST", 3)
    pack(meshes)
    monkeypatch.setitem(globals(), "write_arrays", None)  # what would be called if an object was made again
    run_stage(workspace)
    assert object_names(workspace) == list("abcde") and {path.suffix for path in views.iterdir()} == {packs.SUFFIX}
    assert {path.name: opened(path).read() for path in files_below(views)} == plain


def test_objects_are_made_of_packed_files_and_reading_an_undeclared_one_is_an_error(make_workspace):
    workspace = make_workspace({"views": {}})
    pack(filled(workspace.data / "meshes", "abcd"))
    run_stage(workspace)
    assert read_arrays(workspace.data / "views/b.npz")["value"] == 2 * ord("b")
    with pytest.raises(UndeclaredRead, match="meshes/b.npz is read, but not declared"):
        run_stage(workspace, other="b")
