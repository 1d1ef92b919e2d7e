"""Objects known by touch, the planner's places beside random ones: `python -m benchmarks.knowing [FOLDER] [DRAWS]`

The meshes of a folder, data/household/meshes by default, are learned. Each is explored DRAWS times (five) at places
that were not learned, by both ways in turn from the same 64 places, until one object has 95 % of the belief or there
were 30 touches. `placed`: the objects stand as they were learned; else only what was felt counts, not where.

Writes reports/bench/knowing.csv. `value` is a mean over the draws, then over the objects; low and high are its 95 %
interval (bootstrap over the objects). Metrics: right (the object is known), wrong (another one is), touches, and of all
three the paired difference, planner minus random, under `way` difference.
"""

from pathlib import Path

import numpy as np
import pandas as pd

from benchmarks import arguments
from haptic_glance.base.files import write_table
from haptic_glance.base.rng import rng
from haptic_glance.know import Exploration, known_objects, learn
from haptic_glance.know.exploration import MOST
from haptic_glance.touch import Surface
from stages.engine.parallel import progress
from stages.engine.statistics import interval

OUT, MESHES, DRAWS = Path("reports/bench/knowing.csv"), Path("data/household/meshes"), 5
METRICS = ("right", "wrong", "touches")


def explored(library, surface, name, draw, way):
    """{metric: value} of one exploration."""
    exploration = Exploration(library, surface, rng(1, f"{name} {draw}"))
    if way == "planner":
        known = exploration.finish()
    else:
        for place in rng(2, f"{name} {draw}").permutation(len(exploration.candidates.positions))[:MOST]:
            exploration.touch(exploration.candidate(int(place)))
            if exploration.belief.known:
                break
        known = exploration.belief.known
    return {"right": known == name, "wrong": known not in ("", name), "touches": len(exploration.images)}


def rows_of(meshes, placed, draws):
    """The rows of one kind of knowing."""
    library, rows = learn(meshes, placed), []
    common = {"objects": len(meshes), "placed": placed, "draws": draws}
    by_way = {way: {metric: [] for metric in METRICS} for way in ("planner", "random")}
    for name in progress(list(meshes), "objects"):
        surface = Surface(meshes[name])
        for way, values in by_way.items():
            trials = [explored(library, surface, name, draw, way) for draw in range(draws)]
            for metric in METRICS:
                values[metric].append(np.mean([trial[metric] for trial in trials]))
    planner, random = (by_way[way] for way in ("planner", "random"))
    by_way["difference"] = {metric: np.subtract(planner[metric], random[metric]) for metric in METRICS}
    for way, values in by_way.items():
        for metric in METRICS:
            mean, low, high = interval(np.array(values[metric]))
            rows.append(common | {"way": way, "metric": metric, "value": mean, "low": low, "high": high})
    return rows


def main() -> None:
    """Runs the benchmark of the command line."""
    chosen = arguments(__doc__, folder=MESHES, draws=DRAWS)
    meshes, notes = known_objects(Path(chosen.folder))
    print(*notes, sep="\n", end="\n" if notes else "")
    table = pd.DataFrame([row for placed in (True, False) for row in rows_of(meshes, placed, int(chosen.draws))])
    write_table(OUT, table.round(4))
    print(table.round(3).to_string(index=False))


if __name__ == "__main__":
    main()
