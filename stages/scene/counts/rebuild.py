"""Tests of predicted counts: the mesh is simplified to as many faces, and its error measured."""

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np
import pandas as pd

from haptic_glance.base.rng import rng
from haptic_glance.base.timing import Stopwatch
from haptic_glance.lod import metro, simplify

from .cases import Case

if TYPE_CHECKING:
    from .fold import Fold  # which imports this module

BUILT = 4  # objects per fold, one case each: all folds and models together take half a minute on one core


def build_some(fold: "Fold", cases: Sequence[Case], counts: np.ndarray) -> pd.DataFrame:
    """Frame like that of `score_counts`, but measured on meshes, for one case of each of BUILT objects, with `seconds`.

    The same cases for equal folds, whatever the model. Neighbourhoods shrink where the count needs it, as in the lod
    stage. A case without a sound mesh has no row.
    """
    names = np.array([case.curve.object for case in cases])
    draw = rng(fold.seed, "cases to build")
    places = [draw.choice(np.flatnonzero(names == name)) for name in draw.permutation(np.unique(names))[:BUILT]]
    rows = [_built(cases[place], int(counts[place]), fold) for place in places]
    columns = ["object", "ratio", "error", "within", "seconds"]
    return pd.DataFrame([row for row in rows if row is not None], columns=columns).astype({"within": bool})


def _built(case, count, fold):
    name, method = case.curve.object, case.curve.method
    mesh, keep = fold.meshes[name], fold.points[name][method]
    with Stopwatch() as watch:
        try:
            found = simplify(mesh, count, keep, shrink=True)
        except ValueError:
            return None
        error = metro(mesh, found, seed=fold.seed)["mean"] / case.error
    ratio = len(found.faces) / case.needed
    return {"object": name, "ratio": ratio, "error": error, "within": error <= 1, "seconds": watch.seconds}
