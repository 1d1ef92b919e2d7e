"""Collects classes of objects and finds the salient points that guide the touch (T4.3.2, T4.4.10).

Reads the source named by classes.source, as the stage `meshes` does, and writes data/classes/NAME.npz (the normalised
mesh, and for each detector DETECTOR.points, vertex ids, most salient first), classes.csv (what each object is, in the
order of classes.names) and refused.csv (what was left out and why). In reports/measurements/classes.csv `seconds` of a
detector include the look that the detectors of an object share. A class left with fewer than two objects has a note
there: no object of it can be held out.
"""

import functools
import sys
from difflib import get_close_matches

import pandas as pd

from stages.kit import StageRun, arguments, params
from stages.kit.files import write_table
from stages.meshes.sources import SOURCES
from stages.salient_points.methods import teachable
from stages.weights import Learned

from .files import TABLE
from .one_object import items, process

REFUSED = ["object", "class", "reason"]


def check(settings):
    """Raises ValueError, naming the setting and the remedy, for what cannot be collected."""
    if settings.source not in SOURCES:
        raise ValueError(f"classes.source={settings.source!r} is not known: {', '.join(SOURCES)}")
    if not settings.names or not all(settings.names.values()):
        raise ValueError("classes.names must name at least one class, and every class at least one object")
    every = [name for objects in settings.names.values() for name in objects]
    twice = sorted({name for name in every if every.count(name) > 1})
    if twice:
        raise ValueError(f"classes.names: {', '.join(twice)} named twice; an object belongs to one class")
    if settings.count < 1 or not settings.methods:
        raise ValueError("classes: count must be 1 or more, and methods name at least one")
    idle = teachable(settings.methods, Learned())[1]
    if idle:
        raise ValueError(f"classes.methods: {', '.join(idle)} must learn from this data first; take others")


def unknown(name, known, source):
    """The row of an object that its source does not have."""
    near = get_close_matches(name, known, n=1, cutoff=0.5) or known
    note = f"{source} has no such object, but {', '.join(near)}"
    return {"object": name, "metric": "faces", "value": None, "note": note}


def thin(names, table):
    """Rows with a note, one a class that is left with fewer than two objects."""
    for name, objects in names.items():
        left = [row["object"] for row in table if row["class"] == name]
        if len(left) < 2:
            note = f"class {name} has {len(left)} of its {len(objects)} objects: none of it can be held out"
            yield {"class": name, "metric": "objects", "value": len(left), "note": note}


def main():
    arguments(__doc__)
    settings = params("classes")
    check(settings)
    known = items(settings)  # once, before the workers: it may fetch
    belongs = {name: label for label, objects in settings.names.items() for name in objects}
    with StageRun("classes") as run:
        run.dataset = settings.source
        work = functools.partial(process, settings=settings, seed=run.seed)
        run.each(work, [name for name in belongs if name in known])
        run.rows += [unknown(name, known, settings.source) for name in belongs if name not in known]
        run.rows = [{"object": row["object"], "class": belongs[row["object"]]} | row for row in run.rows]
        told = [row for row in run.rows if "known" in row]
        table = [{"object": row["object"], "class": row["class"]} | row.pop("known") for row in told]
        refused = [row | {"reason": row["note"]} for row in run.rows if row["value"] is None]
        for row in refused:
            print(f"classes: refused {row['object']}: {row['reason']}", file=sys.stderr)
        if not table:
            raise ValueError("classes: every object was refused; nothing is left to touch")
        run.rows += thin(settings.names, table)
        write_table(run.folder / TABLE, pd.DataFrame(table))
        write_table(run.folder / "refused.csv", pd.DataFrame(refused, columns=REFUSED))
        points = sum(row["value"] for row in run.rows if row["metric"] == "points")
        classes = len({row["class"] for row in table})
        run.metrics({"classes": classes, "objects": len(table), "refused": len(refused), "points": points})
    print(f"classes: {classes} classes, {len(table)} objects, {points} points, {len(refused)} refused")


if __name__ == "__main__":
    main()
