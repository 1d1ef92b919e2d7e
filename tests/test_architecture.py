"""The house's rules: imports run one way, DVC knows what every stage reads, settings are documented and used."""

import ast
import re
from pathlib import Path

import pytest
import yaml

ROOT = Path(__file__).parents[1]
PIPELINE = yaml.safe_load((ROOT / "dvc.yaml").read_text())["stages"]
ORDER = list(PIPELINE)
TRACKED = {"reference"}  # in git: nobody's output
SECTIONS = sorted(path.parent.name for path in ROOT.glob("stages/*/schema.py"))


def imported(package):
    """The stage packages (and kit) that the files of a package import, itself left out."""
    found = set()
    for path in (ROOT / "stages" / package).rglob("*.py"):
        for node in ast.walk(ast.parse(path.read_text())):
            names = []
            if isinstance(node, ast.Import):
                names = [alias.name for alias in node.names]
            elif isinstance(node, ast.ImportFrom) and node.level == 0:
                names = [node.module, *(f"{node.module}.{alias.name}" for alias in node.names)]
            found |= {match[1] for name in names if (match := re.match(r"stages\.(\w+)", name))}
    return {name for name in found if (ROOT / "stages" / name).is_dir()} - {package}


def closure(package):
    """All packages whose code a package runs."""
    reached, ahead = set(), {package}
    while ahead:
        name = ahead.pop()
        reached.add(name)
        ahead |= imported(name) - reached
    return reached


def test_kit_imports_no_stage():
    assert imported("kit") == set()


def test_networks_import_the_kit_alone():
    assert imported("networks") == {"kit"}


@pytest.mark.parametrize("stage", ORDER)
def test_a_stage_imports_only_to_its_left(stage):
    assert imported(stage) - {"kit", "networks"} <= set(ORDER[: ORDER.index(stage)])


@pytest.mark.parametrize("stage", ORDER)
def test_dvc_knows_all_code_that_a_stage_runs(stage):
    listed = {dep.split("/")[1] for dep in PIPELINE[stage]["deps"] if dep.startswith("stages/")}
    assert listed == closure(stage)


@pytest.mark.parametrize("stage", ORDER)
def test_dvc_knows_all_data_that_a_stage_reads(stage):
    text = "".join(path.read_text() for path in (ROOT / "stages" / stage).rglob("*.py"))
    listed = {dep.split("/")[1] for dep in PIPELINE[stage]["deps"] if dep.startswith("data/")} - TRACKED
    inputs = re.search(r"StageRun\([^)]*inputs=\(([^)]*)\)", text)
    if inputs:
        assert set(re.findall(r'"(\w+)"', inputs[1])) == listed
    else:
        assert not listed or stage == "report"


@pytest.mark.parametrize("stage", ORDER)
def test_a_stage_is_one_thing_in_five_places(stage):
    assert PIPELINE[stage]["desc"] and PIPELINE[stage]["cmd"] == f"python -m stages.{stage}"
    assert {stage, "seed"} <= set(PIPELINE[stage]["params"])
    assert (ROOT / "stages" / stage / "__main__.py").exists() and (ROOT / "tests" / stage).is_dir()
    assert stage in SECTIONS


@pytest.mark.parametrize("section", SECTIONS)
def test_every_setting_is_documented_and_read(section):
    folder = ROOT / "stages" / section
    others = [path.read_text() for path in (ROOT / "stages").rglob("*.py") if path != folder / "schema.py"]
    fields = re.findall(r"^    (\w+): [^\n]*$", (folder / "schema.py").read_text(), re.M)
    documented = re.findall(r"^    (\w+): [^#\n]+# \S", (folder / "schema.py").read_text(), re.M)
    assert fields and fields == documented
    for name in fields:
        assert any(re.search(rf"\.{name}\b|\"{name}\"", text) for text in others), f"{section}.{name} is never read"


def test_every_file_says_what_it_is_for():
    for path in [*ROOT.glob("stages/**/*.py"), *ROOT.glob("benchmarks/*.py")]:
        assert ast.get_docstring(ast.parse(path.read_text())), f"{path} has no docstring"
