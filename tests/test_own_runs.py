"""A run of one's own leaves the published results as they are, needs [pipeline] alone, and ends in a page."""

import os
import re
import subprocess
import sys
from pathlib import Path

import pytest
import trimesh

from haptic_glance.base.extras import MODULES
from haptic_glance.base.files import write_text
from tests.test_package import without

ROOT = Path(__file__).parents[1]
OTHERS = sorted(
    {module for extra in MODULES.keys() - {"pipeline", "pictures"} for module in MODULES[extra]} - {"cloudpickle"}
)
# An interpreter without what [pipeline] does not bring, but for what joblib has a copy of; its children inherit that.
BLOCKED = without(OTHERS)
# `dvc repro` runs the commands of its stages in its own process here, so that each package is imported once. Digests of
# code, pixels and resamples take long; other tests check them.
REPRO = """
import runpy
import shlex
import sys

import dvc.cli
import dvc.stage.run
from stages.engine import code, statistics
from stages.charts import items

def run(executable, cmd, **options):
    before = sys.argv
    python, option, *sys.argv = shlex.split(cmd)
    assert (python, option) == ("python", "-m")
    runpy.run_module(sys.argv[0], run_name="__main__", alter_sys=True)
    sys.argv = before

save = items.save
items.save = lambda figure, path, dpi: save(figure, path, dpi // 3)
code._digest_of, statistics.RESAMPLES, dvc.stage.run._run = str, 400, run
sys.exit(dvc.cli.main(["repro"]))
"""


def git(*arguments, cwd=ROOT):
    return subprocess.run(["git", *arguments], cwd=cwd, capture_output=True, text=True, check=False).stdout


@pytest.mark.slow
def test_a_folder_ends_in_a_page_with_pipeline_alone(tmp_path):
    tree, scans = tmp_path / "tree", tmp_path / "tree/scans"
    unread = ("reports/figures", "reports/tradeoff", "dvc.lock", "tests", "docs")
    for name in git("ls-files", "-co", "--exclude-standard").splitlines():
        if (ROOT / name).is_file() and not name.startswith(unread):
            (tree / name).parent.mkdir(parents=True, exist_ok=True)
            (tree / name).write_bytes((ROOT / name).read_bytes())
    scans.mkdir()
    for name, shape in (("teapot", trimesh.creation.icosphere(2)), ("cup", trimesh.creation.capsule(1, 0.4))):
        shape.export(scans / f"{name}.obj")  # names of the project's own marks, which are of other meshes
    (scans / "broken.stl").write_bytes(b"solid nothing")
    for command in ("init -q", "-c core.compression=0 add -A", "-c user.name=a -c user.email=a@b commit -qm all"):
        git(*command.split(), cwd=tree)
    write_text(tmp_path / "blocked/sitecustomize.py", BLOCKED)
    environment = os.environ | {"PYTHONPATH": f"{tmp_path / 'blocked'}:{tree}"}
    environment["PATH"] = f"{Path(sys.executable).parent}:{environment['PATH']}"
    options = {"cwd": tree, "env": environment, "capture_output": True, "text": True}
    with pytest.raises(AssertionError):
        assert not subprocess.run([sys.executable, "-c", "import torch"], **options).returncode
    quick = ["views.size=[150,200]", "conspicuity.size=[60,80]", "lod.targets=[50%]", "views.viewpoints=four"]
    chosen = ["sets=[folder]", "meshes.folder=scans", *quick, "parallel=sequential"]
    process = subprocess.run([sys.executable, "-m", "stages.compose", *chosen], **options)
    assert process.returncode == 0, process.stderr
    process = subprocess.run([sys.executable, "-c", REPRO], **options)
    assert process.returncode == 0, process.stdout + process.stderr
    page = (tree / "runs/folder/index.html").read_text()
    assert all(f"<h2>{name}</h2>" in page for name in ("cup", "teapot")) and "broken.stl" in page
    addresses = re.findall(r'href="(site/[^"]+)"', page)
    assert addresses and all((tree / "runs/folder" / address).exists() for address in addresses)
    changed = {line[3:] for line in git("status", "--short", "--untracked-files=all", cwd=tree).splitlines()}
    assert changed <= {"params.yaml", "code.yaml", "dvc.lock", "runs/folder/headlines.json"}  # the code is made up here
    assert "0 of 2 objects have ground truth" in process.stdout
    gate = subprocess.run([sys.executable, "-m", "stages.gate"], **options)
    assert gate.returncode == 1 and gate.stderr.count("\n") == 1 and "runs/folder/baseline.json" in gate.stderr
