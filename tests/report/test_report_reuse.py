"""Parts of the report that are taken from the last run: only where nothing that they read has changed."""

from functools import partial

import pytest

from haptic_glance.base.files import write_text
from stages.report import reuse, scene, touch
from stages.report.reuse import HERE, built, keep, key_of, taken_again
from stages.report.topics import build_all, files_of

pytestmark = pytest.mark.slow


def keys(small, root, kind="tables"):
    results = small.results(root)
    return {topic.__name__.rpartition(".")[2]: key_of(files_of(topic, kind), results) for topic in (scene, touch)}


@pytest.fixture(scope="module")
def unchanged(small, tmp_path_factory):
    """(the root of a small run that no test changes, the keys of its tables)."""
    root = small.root(tmp_path_factory.mktemp("unchanged"))
    return root, keys(small, root)


@pytest.mark.parametrize(
    ("file", "changed"),
    [
        ("touch/prose.md", {"touch"}),
        ("scene/counts.py", {"scene"}),
        ("tables.py", {"scene", "touch"}),
        ("topics.py", {"scene", "touch"}),
        ("page/site.css", {"scene", "touch"}),
        ("attention/prose.md", set()),
        ("touch/findings.md", set()),
        ("hybrid/__init__.py", set()),
    ],
)
def test_code_and_prose_change_the_keys_of_the_topics_that_read_them(file, changed, small, unchanged, monkeypatch):
    (root, before), digest = unchanged, reuse.file_digest
    monkeypatch.setattr(reuse, "file_digest", lambda path: "changed" if path == HERE / file else digest(path))
    after = keys(small, root)
    assert (HERE / file).is_file() and {name for name in after if after[name] != before[name]} == changed


@pytest.mark.parametrize("file", ["reports/measurements/other/lod.csv.gz", "data/test/meshes/new.npz", "build/code/new",
                                  "reports/bench/new.csv", "params.yaml"])  # fmt: skip
def test_a_setting_or_a_new_file_of_rows_data_or_code_changes_all_keys(file, small, root):
    before, path = keys(small, root), root / file
    write_text(path, path.read_text().replace("seed: 0", "seed: 1") if path.exists() else "other")
    assert not {*keys(small, root).values()} & {*before.values()}


@pytest.fixture
def kept(results):
    part, read = built(partial(build_all, "tables", topics=[touch]), results)
    keep("tables-touch", "key", part, read, results)
    return part


def test_a_part_is_taken_again_with_its_files_alone(kept, results):
    part = taken_again("tables-touch", "key", results)
    assert [item.html for item in part.items] == [item.html for item in kept.items] and part.not_run == kept.not_run
    assert taken_again("tables-touch", "other", results) is None and taken_again("tables-scene", "key", results) is None
    write_text(kept.items[0].paths[0], "edited")
    assert taken_again("tables-touch", "key", results) is None


@pytest.mark.parametrize(("stage", "again"), [("classification", False), ("lod", True)])
def test_a_part_is_built_again_where_rows_that_it_opened_have_changed(stage, again, kept, results):
    path = results.reports / f"measurements/test/{stage}.csv.gz"
    path.write_bytes(path.read_bytes() + b" ")
    assert (taken_again("tables-touch", "key", results) is not None) == again


def test_rows_that_were_read_before_count_as_read(small, root):
    results = small.results(root)
    results.rows("lod", "test")
    _, read = built(lambda results: results.rows("lod", "test"), results)
    assert [path.name for path in read] == ["lod.csv.gz"]


@pytest.mark.parametrize("content", [b"", b"\x80\x04", b"nothing"])
def test_a_damaged_part_is_built_again(content, kept, results):
    (path,) = (results.workspace.build / "report").iterdir()
    path.write_bytes(content)
    assert taken_again("tables-touch", "key", results) is None
