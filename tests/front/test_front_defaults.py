"""Default means cheapest that is as good: each default is that of the front's smallest choice as good as the best."""

from dataclasses import asdict
from inspect import signature
from pathlib import Path

import pandas as pd
import pytest

from haptic_glance.cli.touch import parser
from haptic_glance.gallery import exhibit
from haptic_glance.know import library
from haptic_glance.studio.feeling import Sensor
from haptic_glance.touch import press
from stages.engine.settings import load_params
from stages.front.space import DEFAULT, WHOLE, WIDTH
from stages.report.chain import smallest_kept

ROOT = Path(__file__).parents[2]
FRONT = smallest_kept(pd.read_csv(ROOT / "reports/tables/front.csv", dtype={"level": str}))
RUN = load_params(ROOT / "params.yaml")["household"]
PIPELINE = {
    "points": RUN["salient_points"]["count"],
    "cells": RUN["imprints"]["cells"][0],
    "level": WHOLE,  # the stage imprints presses the array on the mesh of the stage meshes
    "touches": RUN["classification"]["touches"][0],
    "classifier": RUN["classification"]["classifiers"][0],
}
# The belief of `know` has no other classifier and no number of touches: it goes on until it is sure.
DEFAULTS = {
    "pipeline": PIPELINE,
    "know": {"points": library.TOUCHES, "cells": library.CELLS[0], "level": WHOLE},
    "studio": {"cells": Sensor().cells},
    "press": {"cells": signature(press).parameters["cells"].default[0]},
    "touch": {"cells": parser().get_default("cells")[0]},
    "gallery": {"cells": exhibit.CELLS[0]},
}
ROWS = "rows of household and furniture, and claims on them, rest on it: it changes when they are measured again"
DOORS = "one question has one answer: it changes together with imprints.cells of the pipeline"
BELIEF = "`know` has a belief, not the front's classifier: with 40 learned places it takes half as many touches again"
# Defaults that are not the front's yet: their value, and why.
OPEN = {
    ("pipeline", "cells"): (16, ROWS), ("pipeline", "touches"): (1, ROWS),
    ("know", "points"): (128, BELIEF),
    **{(door, "cells"): (16, DOORS) for door in DEFAULTS if door != "pipeline"},
}  # fmt: skip


@pytest.mark.parametrize(("door", "setting"), [(door, setting) for door in DEFAULTS for setting in DEFAULTS[door]])
def test_a_default_is_the_smallest_that_the_front_keeps(door, setting):
    value, reason = OPEN.get((door, setting), (FRONT[setting], ""))
    assert DEFAULTS[door][setting] == value, reason
    assert (value == FRONT[setting]) == (not reason), f"the front agrees by now: leave {door}, {setting} out of OPEN"


def test_the_front_asks_about_the_defaults_of_the_pipeline():
    assert PIPELINE.items() <= asdict(DEFAULT).items()
    assert RUN["salient_points"]["methods"][0] == DEFAULT.method


def test_the_array_is_as_wide_at_every_door_as_in_the_front():
    pitches = {RUN["imprints"]["pitch"], library.PITCH, exhibit.PITCH, Sensor().pitch}
    pitches |= {signature(press).parameters["pitch"].default, parser().get_default("pitch")}
    assert [pitch * PIPELINE["cells"] for pitch in pitches] == [pytest.approx(WIDTH)]
