"""Reads the learned weights and SVMs that may be applied to an object: those not learned from the same object."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from stages.kit import Mesh
from stages.kit.files import read_arrays, read_table, write_arrays

from .convexity import convexity, nearest_convexity
from .learn_weights import ALL
from .published import DEEP, GLANCE, GLANCES, METHODS, weights
from .svm import SVMModel

SEEN_SUFFIX = "_seen"  # of methods whose weights were learned from all objects, the same one included, as in the thesis


def published_weights() -> dict[str, dict[str, float]]:
    """{method: its published weights}."""
    return {method: weights(method) for method in METHODS} | _deep()


@dataclass(frozen=True)
class LearnedWeights:
    """weights: method -> dict name -> weight; svms: kind -> dict k -> SVMModel, one for all views or one per view."""

    weights: dict[str, dict[str, float]] = field(default_factory=published_weights)
    svms: dict[str, dict[int, SVMModel]] = field(default_factory=dict)


def read_learned_weights(folder: str | Path, name: str, mesh: Mesh) -> LearnedWeights:
    """The LearnedWeights of an object, from data/SET/weights.

    For an object with ground truth, learned weights are those that leave it out; with SEEN_SUFFIX in the name, those
    learned from all objects. If it is the only object with ground truth, weights that leave it out do not exist, and
    the methods are missing. The SVMs are `svm`, trained on all other objects; `svm_nearest`, that of the other object
    nearest in convexity; and, for an object with ground truth, `svm_object` and `svm_viewpoint`, trained on the object
    itself and on each of its views (T3.2.3).
    """
    table = read_table(Path(folder) / "weights.csv").fillna({"left_out": ALL})
    from_all = table[table.left_out == ALL]
    own = table[table.left_out == name]
    every = _by_method(from_all)
    found = every | _by_method(own)
    if own.empty and (Path(folder) / "ground_truth" / f"{name}.npz").exists():
        published = np.allclose([*every[GLANCE].values()], [*weights(GLANCE).values()])
        usable = {*METHODS} if published else {*METHODS} - {*GLANCES}
        found = {method: values for method, values in every.items() if method in usable}
    seen = {f"{method}{SEEN_SUFFIX}": values for method, values in every.items() if method not in METHODS}
    gazed = (Path(folder) / "ground_truth" / f"{name}.npz").exists()  # weights of DEEP that leave it out do not exist
    return LearnedWeights(found | seen | ({} if gazed else _deep()), _svms(Path(folder), name, mesh))


def _deep():
    return {method: dict(found) for method, found in DEEP.items()}


def _by_method(table):
    groups = table.groupby("method", sort=False)
    return {str(method): dict(zip(rows.channel, rows.weight.astype(float), strict=True)) for method, rows in groups}


def _svms(folder, name, mesh):
    if not (folder / "convexity.csv").exists():
        return {}
    convexities = read_table(folder / "convexity.csv").set_index("object").convexity.to_dict()
    own = folder / "svm" / f"{name}.npz"
    others = {other: value for other, value in convexities.items() if other != name}
    found = {"svm": read_models(own, "without") if own.exists() else read_models(folder / "svm.npz", "all")}
    found["svm_seen"] = read_models(folder / "svm.npz", "all")
    if others:  # their names are texts, which pandas does not tell
        found["svm_nearest"] = read_models(
            folder / "svm" / f"{nearest_convexity(convexity(mesh), others)}.npz",  # pyright: ignore[reportArgumentType]
            "object",
        )
    found["svm_object"] = read_models(own, "object")
    found["svm_viewpoint"] = read_models(own, "view")
    return {kind: models for kind, models in found.items() if models}


def write_models(path: str | Path, models: Mapping[str, Sequence[SVMModel | None]]) -> None:
    """Writes a dict prefix -> list of models, None for a view without training data."""
    arrays = {
        f"{prefix}.{k}.{key}": values
        for prefix, group in models.items()
        for k, model in enumerate(group)
        if model is not None
        for key, values in model.to_arrays().items()
    }
    write_arrays(path, **arrays)


def read_models(path: Path, prefix: str) -> dict[int, SVMModel]:
    """dict k -> SVMModel of a prefix; {} if the file or the prefix does not exist."""
    if not path.exists():
        return {}
    grouped = {}
    for name, values in read_arrays(path, f"{prefix}.").items():
        _, k, key = name.split(".")
        grouped.setdefault(int(k), {})[key] = values
    return {k: SVMModel.from_arrays(arrays) for k, arrays in grouped.items()}
