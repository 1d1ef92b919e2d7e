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


def settings_read(stage):
    """The sections whose schema the stage's `run` asks the workspace for."""
    path = ROOT / "stages" / stage / "__main__.py"
    module = importlib.import_module(f"stages.{stage}.__main__")
    calls = [node for node in ast.walk(ast.parse(path.read_text())) if isinstance(node, ast.Call)]
    requests = [call for call in calls if getattr(call.func, "attr", "") == "settings"]
    schemas = [getattr(module, ast.unparse(call.args[0]).partition(".")[0]) for call in requests]
    return {schema.__module__.split(".")[-1] for schema in schemas}


@pytest.mark.slow
@pytest.mark.parametrize("stage", ORDER)
def test_dvc_knows_the_code_the_data_and_the_settings_of_a_stage(stage):
    block, text = STAGES[stage], "".join(path.read_text() for path in (ROOT / "stages" / stage).rglob("*.py"))
    assert block["desc"] and block["cmd"].split(" $")[0] == f"python -m stages.{stage}"
    assert block["deps"][0] == f"build/code/{stage}" and (ROOT / "tests" / stage).is_dir()
    listed = {match[1] for dep in block["deps"] if (match := re.match(r"data/\$\{\w+\}/(\w+)$", dep))}
    inputs = re.search(r"StageRun\([^)]*inputs=\(([^)]*)\)", text)
    assert listed == (set(re.findall(r'"(\w+)"', inputs[1])) if inputs else set())
    if stage != "report":
        settings = {name.split(".")[1] for name in block["params"] if "." in name}
        assert settings_read(stage) == settings and "seed" in block["params"]
    written = [next(iter(out)) if isinstance(out, dict) else out for out in block["outs"] + block.get("metrics", [])]
    assert all(path.startswith(("${out}/", "data/${", "build/")) for path in written), "not the folder of the run"


@pytest.mark.slow
def test_every_stage_is_in_the_pipeline_and_every_setting_is_read():
    assert sorted(ORDER) == stage_names()
    texts = {path: path.read_text() for path in (ROOT / "stages").rglob("*.py")}
    for section in stage_names():
        file = ROOT / "stages" / section / "__init__.py"
        fields = re.findall(r"^    (\w+): [^\n]*$", texts[file][texts[file].index("class Params") :], re.M)
        assert fields == list(schema_of(section).__dataclass_fields__)
        others = "\n".join(text for path, text in texts.items() if path != file)
        for name in fields:
            assert re.search(rf"\.{name}\b|\"{name}\"", others), f"{section}.{name} is never read"


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

    def fresh():
        for remembered in (code._module, code._facts, code._kept, code.imported_files):
            remembered.cache_clear()

    def reached():
        fresh()
        return {path.relative_to(tmp_path).as_posix() for path in code.stage_files("a")}

    needed = set(files) - {"stages/__init__.py", "stages/b/__init__.py", "stages/b/unused.py"}
    assert reached() == needed
    before = code.file_digest(tmp_path / "stages/b/inner.py")
    code.keep_facts()
    with monkeypatch.context() as kept:
        kept.setattr(code, "_work_out", None)
        assert reached() == needed  # from what was kept
    (tmp_path / "stages/a/__main__.py").write_text("from stages.b import other\n")
    (tmp_path / "stages/b/inner.py").write_text("from .helper import help as work\n")
    assert reached() == {"stages/a/__init__.py", "stages/a/__main__.py", "stages/b/unused.py"}
    assert code.file_digest(tmp_path / "stages/b/inner.py") != before
    for damaged in ("[]", "{"):
        (tmp_path / code.KEPT).write_text(damaged)
        assert reached() == {"stages/a/__init__.py", "stages/a/__main__.py", "stages/b/unused.py"}
    fresh()
