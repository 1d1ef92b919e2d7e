"""DVC knows what every stage reads, and settings are used; `make lint` checks that imports run one way."""

import ast
import importlib
import re
from pathlib import Path

import pytest
import yaml

from stages.code import stage_names
from stages.engine import code
from stages.engine.settings import schema_of

ROOT = Path(__file__).parents[1]
PIPELINE = yaml.safe_load((ROOT / "dvc.yaml").read_text())["stages"]
ORDER = [stage for stage in PIPELINE if stage != "code"]
STAGES = {stage: PIPELINE[stage].get("do", PIPELINE[stage]) for stage in ORDER}
SECTIONS = stage_names()


def settings_read(stage):
    """The sections whose schema the stage's `run` asks the workspace for."""
    path = ROOT / "stages" / stage / "__main__.py"
    module = importlib.import_module(f"stages.{stage}.__main__")
    calls = [node for node in ast.walk(ast.parse(path.read_text())) if isinstance(node, ast.Call)]
    asked = [call for call in calls if getattr(call.func, "attr", "") == "settings"]
    schemas = [getattr(module, ast.unparse(call.args[0]).partition(".")[0]) for call in asked]
    return {schema.__module__.split(".")[-1] for schema in schemas}


def test_every_stage_is_in_the_pipeline():
    assert sorted(ORDER) == stage_names()


@pytest.mark.parametrize("stage", ORDER)
def test_dvc_knows_the_code_and_the_data_that_a_stage_reads(stage):
    deps = STAGES[stage]["deps"]
    assert deps[0] == f"build/code/{stage}"
    text = "".join(path.read_text() for path in (ROOT / "stages" / stage).rglob("*.py"))
    listed = {match[1] for dep in deps if (match := re.match(r"data/\$\{\w+\}/(\w+)$", dep))}
    inputs = re.search(r"StageRun\([^)]*inputs=\(([^)]*)\)", text)
    read = set(re.findall(r'"(\w+)"', inputs[1])) if inputs else set()
    assert read == listed


@pytest.mark.parametrize("stage", [stage for stage in ORDER if stage != "report"])
def test_dvc_knows_the_settings_that_a_stage_reads(stage):
    listed = {name.split(".")[1] for name in STAGES[stage]["params"] if "." in name}
    assert settings_read(stage) == listed and "seed" in STAGES[stage]["params"]


@pytest.mark.parametrize("stage", ORDER)
def test_a_stage_is_one_thing_in_five_places(stage):
    assert STAGES[stage]["desc"] and STAGES[stage]["cmd"].split(" $")[0] == f"python -m stages.{stage}"
    assert (ROOT / "tests" / stage).is_dir() and stage in SECTIONS


def test_dvc_yaml_reads_like_a_table_of_contents():
    assert len((ROOT / "dvc.yaml").read_text().splitlines()) <= 280


@pytest.mark.slow
@pytest.mark.parametrize("section", SECTIONS)
def test_every_setting_is_read(section):
    folder = ROOT / "stages" / section
    others = [path.read_text() for path in (ROOT / "stages").rglob("*.py") if path != folder / "__init__.py"]
    text = (folder / "__init__.py").read_text()
    fields = re.findall(r"^    (\w+): [^\n]*$", text[text.index("class Params") :], re.M)
    assert fields == list(schema_of(section).__dataclass_fields__)
    for name in fields:
        assert any(re.search(rf"\.{name}\b|\"{name}\"", text) for text in others), f"{section}.{name} is never read"


def test_the_code_of_a_stage_is_what_it_imports():
    files = {path.relative_to(ROOT).as_posix() for path in code.stage_files("views")}
    assert {
        "haptic_glance/look/views/renderer.py",
        "haptic_glance/look/views/shaders/segmentation.frag",
        "stages/engine/run.py",
    } <= files
    assert not any(name.startswith(("stages/lod/", "stages/report/")) for name in files)


@pytest.mark.parametrize(
    ("old", "new", "changes"),
    [
        ("; T3.2.6\n", "; as printed\n", False),
        ('"""Image rows', '"""Rows', False),
        ("DISTANCE = 10.0", "DISTANCE = 9.0", True),
    ],
)
def test_only_changed_work_changes_the_digest(tmp_path, old, new, changes):
    text = (ROOT / "haptic_glance/look/camera.py").read_text()
    assert old in text
    (tmp_path / "camera.py").write_text(text.replace(old, new))
    same = code.file_digest(tmp_path / "camera.py") == code.file_digest(ROOT / "haptic_glance/look/camera.py")
    assert same is not changes


def test_code_that_is_imported_late_or_handed_on_is_found(tmp_path, monkeypatch):
    files = {
        "stages/__init__.py": "",
        "stages/a/__init__.py": "class Params: ...\n",
        "stages/a/__main__.py": "from stages.b import work\ndef late():\n    from stages.c.deep import more\n",
        "stages/b/__init__.py": "from .inner import work\nfrom .unused import other\n",
        "stages/b/inner.py": "from .helper import help\n",
        "stages/b/helper.py": "", "stages/b/unused.py": "",
        "stages/c/__init__.py": "print('busy')\n",
        "stages/c/deep.py": "",
    }  # fmt: skip
    for name, text in files.items():
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / name).write_text(text)
    monkeypatch.setattr(code, "ROOT", tmp_path)
    code._module.cache_clear()
    found = {path.relative_to(tmp_path).as_posix() for path in code.stage_files("a")}
    code._module.cache_clear()
    assert found == set(files) - {
        "stages/__init__.py",
        "stages/b/__init__.py",
        "stages/b/unused.py",
    }
