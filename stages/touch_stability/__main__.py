"""Disturbs the touches of a set of objects in many ways and measures where recognition breaks.

Reads data/meshes, data/imprints, data/salient_points and data/lod of the objects of one set. Classifiers learn from
clean touches and recognise disturbed ones of other places; where the model is coarse, or touches are few, it is the
known touches that suffer. Writes data/touch_stability/NAME.npz (features and, of the first touches, imprints, of every
perturbation and severity) and reports/measurements/touch_stability.csv: a row a split (`anywhere`, `apart`: see
stages.exploration), classifier, perturbation, severity and repetition; `none` is clean touches, severity 0.
The metrics hold the breaking points: the severity at which half of the lead over guessing is lost.
"""

import functools

import numpy as np
import pandas as pd

from stages.classification import CLASSIFIERS
from stages.imprints import read_imprints
from stages.kit import StageRun, arguments, params
from stages.kit.run import DATA

from .breaking import breaking_point, lead_left
from .one_object import process
from .perturbations import PERTURBATIONS
from .recognise import NONE
from .trial import trial


def summary(rows):
    """{accuracy: {SPLIT.FEATURES.CLASSIFIER}, breaking_point: {....PERTURBATION}}; None where it does not break."""
    table = pd.DataFrame(rows).dropna(subset=["value"])
    tree = {"accuracy": {}, "breaking_point": {}}
    if table.empty:
        return tree
    for key, group in table.groupby(["split", "features", "classifier"], sort=False):
        means = group.groupby(["perturbation", "severity"], sort=False)["value"].mean()
        clean, chance = means[NONE].iloc[0], group["chance"].iloc[0]
        tree["accuracy"][".".join(key)] = round(float(clean), 6)
        for perturbation in dict.fromkeys(group["perturbation"]):
            if perturbation != NONE:
                left = lead_left(means[perturbation].to_numpy(), clean, chance)
                at = breaking_point(list(means[perturbation].index), left, PERTURBATIONS[perturbation].unharmed)
                tree["breaking_point"][".".join((*key, perturbation))] = round(at, 6) if np.isfinite(at) else None
    return tree


def check(settings, sets):
    """ValueError that names a setting which makes no measurement."""
    if settings.set not in sets:
        raise ValueError(f"touch_stability.set: no set {settings.set}; classification.sets: {', '.join(sets)}")
    unknown = [name for name in settings.severities if name not in PERTURBATIONS]
    if unknown:
        raise ValueError(f"touch_stability.severities: {', '.join(unknown)}; choose from {', '.join(PERTURBATIONS)}")
    strange = [name for name in settings.classifiers if name not in CLASSIFIERS]
    if strange:
        raise ValueError(f"touch_stability.classifiers: {', '.join(strange)}; choose from {', '.join(CLASSIFIERS)}")


def left_out(settings, objects):
    """Why the objects cannot be told apart by touch, or None; the touches an object, and the array's width."""
    if len(objects) < 2:
        return f"set {settings.set} left out: at least two objects are needed to tell apart", 0, 0.0
    missing = [name for name in objects if not (DATA / "imprints" / f"{name}.npz").exists()]
    if missing:
        return f"set {settings.set} left out: no imprints of {', '.join(missing)}", 0, 0.0
    found = [read_imprints(DATA / "imprints" / f"{name}.npz").get(settings.method) for name in objects]
    if None in found:
        return f"set {settings.set} left out: no imprints by {settings.method}", 0, 0.0
    return None, min(len(one.images) for one in found), max(one.width for one in found)


def main():
    arguments(__doc__)
    settings, sets = params("touch_stability"), params("classification").sets
    check(settings, sets)
    objects = sorted(sets[settings.set])
    with StageRun("touch_stability", inputs=("meshes", "imprints", "salient_points", "lod")) as run:
        note, count, width = left_out(settings, objects)
        if note:
            run.rows.append({"object": settings.set, "method": settings.method, "value": None, "note": note})
        else:
            run.each(functools.partial(process, settings=settings, count=count, seed=run.seed), objects)
            work = functools.partial(trial, objects=objects, settings=settings, width=width, seed=run.seed)
            run.each(work, [f"repetition {number}" for number in range(settings.repetitions)])
        found = summary(run.rows)
        run.metrics(found)
    broken = sum(value is not None for value in found["breaking_point"].values())
    print(f"touch_stability: {note or f'{len(objects)} objects, {len(settings.severities)} perturbations'}; "
          f"{broken} of {len(found['breaking_point'])} break within range")  # fmt: skip


if __name__ == "__main__":
    main()
