"""What the weights stage knows, as the later stages ask for it: for one object, never learned from that object."""

from dataclasses import dataclass, field
from pathlib import Path

from stages.kit.files import read_arrays, read_table, write_arrays

from .convexity import convexity, nearest
from .learn import ALL
from .published import ENHANCED, METHODS, weights
from .svm import Model

SEEN = "_seen"  # ends the names of weights that were learned from the object too, the thesis's way


def shipped():
    """The published weights, and `enhanced` with those learned from human gaze."""
    return {method: weights(method) for method in METHODS} | {ENHANCED: weights("gaze")}


@dataclass(frozen=True)
class Learned:
    """weights: method -> dict name -> weight; svms: kind -> its models, one for all views or one a view."""

    weights: dict = field(default_factory=shipped)
    svms: dict = field(default_factory=dict)


def learned_for(folder, name, mesh):
    """The Learned of an object out of data/weights.

    Weights that were learned leave the object out where it has ground truth; the same with SEEN in their name do not.
    Where it is the only one with ground truth, nothing was learned without it, and those weights are not there.
    SVMs: `svm`, one for all other objects; `svm_nearest`, that of the other object nearest in convexity; `svm_object`
    and `svm_viewpoint`, of the object itself and of each of its views (T3.2.3), for an object with ground truth alone.
    """
    table = read_table(Path(folder) / "weights.csv").fillna({"left_out": ALL})
    from_all = table[table.left_out == ALL]
    own = table[table.left_out == name]
    every = _by_method(from_all)
    found = every | _by_method(own)
    if own.empty and (Path(folder) / "lessons" / f"{name}.npz").exists():
        alone = every[ENHANCED] == every["fixations"]
        found = {
            method: values for method, values in every.items() if method in (*METHODS, *([] if alone else [ENHANCED]))
        }
    seen = {f"{method}{SEEN}": values for method, values in every.items() if method not in METHODS}
    return Learned(found | seen, _svms(Path(folder), name, mesh))


def _by_method(table):
    groups = table.groupby("method", sort=False)
    return {method: dict(zip(rows.channel, rows.weight.astype(float), strict=True)) for method, rows in groups}


def _svms(folder, name, mesh):
    if not (folder / "convexity.csv").exists():
        return {}
    convexities = read_table(folder / "convexity.csv").set_index("object").convexity.to_dict()
    own = folder / "svm" / f"{name}.npz"
    others = {other: value for other, value in convexities.items() if other != name}
    found = {"svm": read_models(own, "without") if own.exists() else read_models(folder / "svm.npz", "all")}
    found["svm_seen"] = read_models(folder / "svm.npz", "all")
    if others:
        found["svm_nearest"] = read_models(folder / "svm" / f"{nearest(convexity(mesh), others)}.npz", "object")
    found["svm_object"] = read_models(own, "object")
    found["svm_viewpoint"] = read_models(own, "view")
    return {kind: models for kind, models in found.items() if models}


def write_models(path, models):
    """Writes a dict prefix -> list of Models, None where a view gave nothing to learn from."""
    arrays = {
        f"{prefix}.{k}.{key}": values
        for prefix, group in models.items()
        for k, model in enumerate(group)
        if model is not None
        for key, values in model.to_arrays().items()
    }
    write_arrays(path, **arrays)


def read_models(path, prefix):
    """dict k -> Model of a prefix; {} where the file or the prefix is not there."""
    if not path.exists():
        return {}
    grouped = {}
    for name, values in read_arrays(path).items():
        kind, k, key = name.split(".")
        if kind == prefix:
            grouped.setdefault(int(k), {})[key] = values
    return {k: Model.from_arrays(arrays) for k, arrays in grouped.items()}
