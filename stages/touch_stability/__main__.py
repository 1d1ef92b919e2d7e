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
from threadpoolctl import threadpool_limits

from stages.classification import CLASSIFIERS, features
from stages.exploration import SPLITS
from stages.imprints import read_imprints
from stages.kit import StageRun, arguments, params
from stages.kit.files import read_arrays, read_mesh, write_arrays
from stages.kit.run import DATA
from stages.salient_points import read_saliency

from .breaking import breaking_point, lead_left
from .perturbations import PERTURBATIONS
from .recognise import NONE, pairs, recognise
from .touches import Touches

DRAWS = 3  # of a perturbation that is a matter of luck; the repetitions take them in turn
SHOWN = 4  # touches whose imprints are kept for the picture
SALIENCY = "enhanced"  # what simplification spares, as lod's enhanced-soft


def touches_of(name, settings, count, seed):
    """The first `count` Touches of an object, with the simplified meshes that are there."""
    found = read_imprints(DATA / "imprints" / f"{name}.npz")[settings.method]
    levels = {path.stem: read_mesh(path) for path in sorted((DATA / "lod" / name).glob("*.npz")) if _wanted(path.stem)}
    saliency = read_saliency(DATA / "salient_points" / f"{name}.npz").get(SALIENCY)
    mesh, cells = read_mesh(DATA / "meshes" / f"{name}.npz"), found.images.shape[1:]
    return Touches(name, mesh, found.vertices[:count], cells, float(found.pitch), saliency, levels, seed)


def _wanted(level):
    return level.rpartition("_")[0] in ("qem", "enhanced-soft")


def process(name, folder, settings, count, seed):
    """Makes all disturbed touches of one object; returns a row where a perturbation cannot be had."""
    touches, rows = touches_of(name, settings, count, seed), []
    kept = {"clean": features(touches.images), "positions": touches.positions}
    kept["shown.clean"] = touches.images[:SHOWN]
    for key, severity in pairs(settings.severities):
        known = PERTURBATIONS[key]
        for draw in range((DRAWS if known.drawn else 1) if known.disturb else 0):
            try:
                felt = known.disturb(touches, severity, draw)
            except ValueError as error:
                note = f"{key} {severity:g} left out: {name}: {error}"
                rows.append(
                    {"perturbation": key, "severity": severity, "metric": "accuracy", "value": None, "note": note}
                )
                break
            kept[f"{key}.{severity:g}.{draw}"] = features(felt.images)
            if known.moves:
                kept[f"{key}.{severity:g}.{draw}.positions"] = felt.positions
            if draw == 0:
                kept[f"shown.{key}.{severity:g}"] = felt.images[:SHOWN]
    write_arrays(folder / f"{name}.npz", **kept)
    return rows


def trial(item, folder, objects, settings, width, seed):
    """The rows of one repetition, whose number the item's name ends on."""
    repetition = int(item.rpartition(" ")[2])
    stored = [read_arrays(folder / f"{name}.npz") for name in objects]

    def gathered(key):
        return np.concatenate([one[key] for one in stored])

    def disturbed(perturbation, severity, features):
        draw = repetition % DRAWS if PERTURBATIONS[perturbation].drawn else 0
        key = f"{perturbation}.{severity:g}.{draw}"
        if not all(key in one for one in stored):
            return None
        return gathered(key) if features == "imprint" else np.hstack([gathered(key), gathered(f"{key}.positions")])

    places = gathered("positions")
    clean = {"imprint": gathered("clean"), "imprint_place": np.hstack([gathered("clean"), places])}
    truth = np.repeat(np.arange(len(objects)), len(places) // len(objects))
    common = {"object": settings.set, "method": settings.method, "repetition": repetition, "chance": 1 / len(objects)}
    rows = []
    with threadpool_limits(1):  # equal sums on any number of cores
        for split in SPLITS:
            given = (places, truth, split, width, settings.severities, settings.classifiers, repetition, seed)
            try:
                rows += [common | row | {"note": None} for row in recognise(clean, disturbed, *given)]
            except ValueError as error:
                rows.append(common | {"split": split, "value": None, "note": f"set {settings.set}, {split}: {error}"})
    return rows


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
