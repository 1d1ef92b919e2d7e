"""docs/first_change.md: the code of the example runs, and the run writes to the folder that the page names."""

import re
import shlex
from pathlib import Path

import numpy as np
import trimesh

from haptic_glance.look.points import detectors
from haptic_glance.mesh.mesh import Mesh
from stages.compose import own_folder

PAGE = (Path(__file__).parents[2] / "docs/first_change.md").read_text(encoding="utf-8")
BLOCKS = [block.replace("\n   ", "\n") for block in re.findall(r"^   ```\w+\n   (.*?)^   ```$", PAGE, re.M | re.S)]


def test_the_function_the_entry_and_the_test_of_the_example_run(monkeypatch):
    function, entry, test, _ = BLOCKS
    needed = re.search(r"from haptic_glance\.mesh\.mesh import [\w, ]+", PAGE)[0]
    names = {**vars(detectors)}
    exec(f"{needed}\n{function}", names)
    assert eval(f"{{{entry}}}", names).keys() == {"angle_defect"}
    monkeypatch.setattr(detectors, "angle_defect", names["angle_defect"], raising=False)
    names = {"np": np, "trimesh": trimesh, "Mesh": Mesh}
    exec(test, names)
    names["test_a_box_has_its_defects_at_its_corners"]()


def test_the_run_of_the_example_writes_to_the_folder_that_the_page_names():
    compose = BLOCKS[3].splitlines()[0]
    folder = own_folder(shlex.split(compose)[3:])
    assert set(re.findall(r"`(runs/[\w-]+)/", PAGE)) == {folder}
