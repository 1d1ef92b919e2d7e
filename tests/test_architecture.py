"""DVC knows what every stage reads, and settings are used; `make lint` checks that imports run one way."""

import ast
import importlib
import re
from dataclasses import fields
from pathlib import Path

import pytest
import yaml

from stages import pipeline
from stages.engine.code import stage_names
from stages.pipeline import schema_of

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
    assert block["params"][0] == {"code.yaml": [stage]} and (ROOT / "tests" / stage).is_dir()
    listed = {match[1] for dep in block["deps"] if (match := re.match(r"data/\$\{\w+\}/(\w+)$", dep))}
    inputs = re.search(r"StageRun\([^)]*inputs=\(([^)]*)\)", text)
    assert listed == (set(re.findall(r'"(\w+)"', inputs[1])) if inputs else set())
    if stage != "report":
        settings = {name.split(".")[1] for name in block["params"][1:] if "." in name}
        assert settings_read(stage) == settings and "seed" in block["params"]
    written = [next(iter(out)) if isinstance(out, dict) else out for out in block["outs"] + block.get("metrics", [])]
    assert all(path.startswith(("${out}/", "data/${", "build/")) for path in written), "not the folder of the run"


def test_stages_have_settings_with_a_meaning_and_the_order_of_dvc():
    assert [*pipeline.STAGES] == ORDER and sorted(ORDER) == stage_names()
    for name in ORDER:
        assert all(field.metadata["meaning"] for field in fields(schema_of(name))), name
