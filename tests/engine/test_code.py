"""Digests of code: what a stage imports is found, words change nothing, and code.yaml is of today's code."""

import sys

import pytest
import yaml

from stages.code import digests_text
from stages.engine import code
from stages.engine.code import code_text, file_digest, files_behind, stage_files, stage_names
from stages.engine.settings import CODE

WORDS = '''
"""About."""
# why
def twice(x):
    """Doubles."""
    return 2 * x  # by two
'''
APART = ("haptic_glance/studio", "haptic_glance/gallery", "haptic_glance/cli", "stages/report")  # no stage needs them


def test_words_do_not_change_the_digest_of_code_and_work_does():
    same = WORDS.replace("Doubles", "Two times").replace("# why", "")
    assert code_text(WORDS) == code_text(same) != code_text(WORDS.replace("2 *", "3 *"))
    assert code_text('def f():\n    """Only words."""\n') == "def f():\n    pass"


def test_the_files_of_a_stage_are_those_that_it_imports():
    names = {path.relative_to(code.ROOT).as_posix() for path in stage_files("views")}
    assert {"stages/views/__main__.py", "stages/views/__init__.py", "stages/engine/run.py"} < names
    assert "haptic_glance/look/views/renderer.py" in names
    assert "haptic_glance/look/views/shaders/segmentation.frag" in names  # no Python, read beside it
    assert not {"stages/lod/__init__.py", "haptic_glance/touch/press.py"} & names
    with pytest.raises(ValueError, match="no stage vews"):
        stage_files("vews")


def test_the_studio_and_the_report_run_no_stage_again():
    for stage in set(stage_names()) - {"report"}:
        files = [path.relative_to(code.ROOT).as_posix() for path in stage_files(stage)]
        assert not [name for name in files if name.startswith(APART)], stage


def test_names_that_a_package_hands_on_and_late_imports_are_followed():
    mesh = code.ROOT / "haptic_glance/mesh"
    behind = files_behind([code.ROOT / "haptic_glance/disturb/mesh.py"])  # from haptic_glance.mesh import surface_of
    assert mesh / "clouds.py" in behind
    assert code.ROOT / "haptic_glance/deep/hybrid.py" in files_behind([code.ROOT / "haptic_glance/deep/__init__.py"])


def test_a_changed_file_changes_the_digest_of_its_stages_alone(monkeypatch):
    views, imprints = code._digest_of("views"), code._digest_of("imprints")
    touched = code.ROOT / "haptic_glance/touch/press.py"
    digest = {path: file_digest(path) for path in {*stage_files("views"), *stage_files("imprints")}}
    monkeypatch.setattr(code, "file_digest", lambda path: "other" if path == touched else digest[path])
    assert code._digest_of("views") == views and code._digest_of("imprints") != imprints


@pytest.mark.skipif(sys.version_info[:2] != (3, 11), reason="another Python writes some trees as another text")
def test_the_committed_digests_are_of_todays_code():
    text = (code.ROOT / CODE).read_text()
    assert list(yaml.safe_load(text)) == stage_names()
    assert text == digests_text(), "run `python -m stages.code`, or `dvc repro`, and commit code.yaml"
