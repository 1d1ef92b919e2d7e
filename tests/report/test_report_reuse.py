"""Parts of the report that are taken from the last run: only where nothing that they read has changed."""

import pytest

from haptic_glance.base.files import write_text
from stages.report import reuse, scene, touch
from stages.report.reuse import HERE, keep, key_of, taken_again
from stages.report.topics import build_all


def keys(small, root):
    return {topic.__name__.rpartition(".")[2]: key_of(topic, small.results(root)) for topic in (scene, touch)}


def test_equal_inputs_have_equal_keys(small, root):
    assert keys(small, root) == keys(small, root)


@pytest.mark.parametrize(
    ("file", "changed"),
    [
        ("touch/prose.md", {"touch"}),
        ("scene/counts.py", {"scene"}),
        ("tables.py", {"scene", "touch"}),
        ("topics.py", {"scene", "touch"}),
        ("page/site.css", {"scene", "touch"}),
        ("attention/prose.md", set()),
        ("hybrid/section_5_5.py", set()),
    ],
)
def test_code_and_prose_change_the_keys_of_the_topics_that_read_them(file, changed, small, root, monkeypatch):
    before, digest = keys(small, root), reuse.file_digest
    monkeypatch.setattr(reuse, "file_digest", lambda path: "changed" if path == HERE / file else digest(path))
    after = keys(small, root)
    assert (HERE / file).is_file() and {name for name in after if after[name] != before[name]} == changed


@pytest.mark.parametrize(
    "file",
    ["reports/measurements/test/lod.csv.gz", "data/test/meshes/ball.npz", "build/code/lod", "reports/bench/new.csv"],
)
def test_rows_data_and_the_code_of_other_stages_change_all_keys(file, small, root):
    before = keys(small, root)
    write_text(root / file, "other")
    after = keys(small, root)
    assert all(after[name] != before[name] for name in after)


def test_a_setting_changes_all_keys_and_the_code_of_the_report_itself_none(small, root):
    before = keys(small, root)
    write_text(root / "build/code/report", "other")
    assert keys(small, root) == before
    params = root / "params.yaml"
    params.write_text(params.read_text().replace("seed: 0", "seed: 1"))
    assert not {*keys(small, root).values()} & {*before.values()}


@pytest.fixture
def kept(results):
    part = build_all("tables", results, [touch])
    keep("tables-touch", "key", part, results)
    return part


def test_a_part_is_taken_again_with_its_files_alone(kept, results):
    part = taken_again("tables-touch", "key", results)
    assert [item.html for item in part.items] == [item.html for item in kept.items] and part.not_run == kept.not_run
    assert taken_again("tables-touch", "other", results) is None and taken_again("tables-scene", "key", results) is None
    write_text(kept.items[0].paths[0], "edited")
    assert taken_again("tables-touch", "key", results) is None


@pytest.mark.parametrize("content", [b"", b"\x80\x04", b"nothing"])
def test_a_damaged_part_is_built_again(content, kept, results):
    (path,) = (results.workspace.build / "report").iterdir()
    path.write_bytes(content)
    assert taken_again("tables-touch", "key", results) is None
