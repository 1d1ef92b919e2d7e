"""Published and learned weights of the channels.

Published weights are equal ones, those of T table 3.1, and those learned from human gaze. Weights and SVMs that were
learned from an object are never applied to the same object: learning leaves one object out at a time.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from haptic_glance.base.files import read_arrays, read_table, write_arrays
from haptic_glance.mesh.mesh import Mesh

from .attention import average, euclidean_weights, fit_fixations, similarity_weights
from .convexity import convexity, nearest_convexity
from .svm import SVMModel

# T table 3.1: channel -> (average SSIM over 43 models, one minus the average normalised Euclidean distance): how
# similar its map is to that of the ground truth (T3.2.1.2, T3.2.1.4), and how near its brightest pixels are (T3.2.1.1).
# The text calls the second a value "for a selected viewpoint from model of skull", the caption an average; T3.2.2
# agrees with the caption. In code rather than in a data file, so that they are available with the package.
TABLE = {
    "color": (0.1096, 0.6417),
    "contrast": (0.7692, 0.3941),
    "curvature": (0.7536, 0.7929),
    "dkl": (0.6389, 0.7098),
    "edge": (0.7264, 0.5651),
    "entropy": (0.8914, 0.7879),
    "intensity": (0.6274, 0.4487),
    "orientation": (0.4596, 0.6773),
    "symmetry": (0.7235, 0.4970),
}


GLANCE = "glance"  # the default method


# Of the features of haptic_glance.look.glance, learned from 32 people's gaze on the 19 meshes of the data set `gaze`
# and on the 14 point clouds of `gaze_clouds`. The features without an up axis are a model of their own, for what lies
# in any pose.
GLANCES = {
    "glance": {
        "rank": 0.44, "middle": 0.309, "upward": 0.128, "upward_high": -0.344, "seen": 0.08, "above": 0.019,
        "above_high": 0.004, "below": -0.06, "log_below": 0.178, "log_side": 0.612, "convexity": 0.601,
        "detail": -0.013, "relief": 0.066, "fullness_0.12": -0.036, "fullness_0.24": 0.226, "distance": -0.031,
        "distance_squared": 0.131, "outward": 0.199, "off_plane": -0.212, "on_plane": 0.097,
    },
    "glance_any_pose": {
        "seen": 0.441, "convexity": 0.627, "detail": -0.016, "relief": 0.007, "fullness_0.12": -0.035,
        "fullness_0.24": 0.334, "distance": -0.101, "distance_squared": 0.106, "outward": 0.147,
    },
}  # fmt: skip


# Of the features of haptic_glance.look.glance and of the maps of a network (haptic_glance.look.points.glance), learned
# from the same gaze by benchmarks/deep_gaze.py. They are not in METHODS, since the stage `weights` does not learn them.
MAP_WEIGHTS = (
    0.004, 0.004, 0.008, 0, 0.021, -0.004, -0.007, -0.007, 0.008, 0.002, -0.002, 0.011, 0.011, -0.008, 0.008, -0.004,
    -0.014, -0.01, -0.005, 0.003, 0.009, -0.004, 0.006, -0.011, 0.003, 0, -0.011, 0, -0.006, -0.011, -0.005, 0.011,
    -0.011, 0.002, 0.001, -0.016, -0.005, 0, 0.005, -0.001, -0.024, -0.004, 0.014, -0.003, -0.013, -0.004, -0.017,
    -0.004, 0.02, -0.01, 0.011, -0.003, 0.004, 0, 0.002, 0.007, -0.006, 0, 0, -0.004, 0, -0.009, 0.014, 0.014, 0.003,
    0.013, -0.007, 0.007, -0.006, 0.007, 0.013, 0.02, -0.01, -0.007, 0.007, -0.008, -0.001, -0.013, -0.009, 0.023,
    0.001, 0, -0.001, 0.005, 0.002, 0.003, 0.005, -0.012, -0.003, 0, -0.001, -0.008, 0.009, -0.005, 0.014, -0.007,
    0.001, -0.009, 0.004, -0.014, -0.016, 0.007, -0.001, -0.031, 0.02, -0.022, -0.011, -0.012, 0.012, 0.008, -0.017,
    -0.003, -0.001, -0.006, 0.009, 0.001, -0.003, -0.014, 0.026, 0.014, 0.009, 0.002, -0.012, 0.006, 0.031, 0.004,
    -0.028, 0.007, -0.006, -0.002, -0.022, 0.008, -0.008, 0.001, -0.016, -0.005, -0.02, -0.019, -0.013, -0.013, -0.002,
    0.008, -0.009, 0.005, -0.022, -0.001, -0.011, -0.028, -0.015, 0.012, -0.005, 0.005, 0.003, 0.009, -0.014, -0.006,
    0.016, -0.009, 0.007, 0.001, 0.004, 0.006, 0.011, 0.018, 0.007, -0.001, 0.02, -0.002, -0.006, -0.012, -0.01,
    -0.016, -0.024, 0.003, 0.01, 0.005, 0.008, -0.02, 0.023, -0.002, -0.001, -0.001, 0.011, 0.003, 0.013, 0.001, 0,
    -0.004, -0.011, -0.004, -0.014, 0.011, 0.008, -0.003, -0.018, -0.01, -0.006, -0.011, -0.007, 0.002, -0.011, 0.011,
    0.01, -0.015, 0.006, 0.017, -0.01, -0.028, 0.003, -0.015, -0.019, -0.007, 0.004, 0.023, 0.007, -0.002, -0.001,
    0.012, -0.014, 0.005, 0.01, 0.017, 0.001, 0.014, -0.003, 0.002, 0.012, -0.005, 0, -0.001, 0.01, -0.016, 0.002,
    -0.003, -0.002, -0.001, 0.009, -0.004, 0.003, 0.01, -0.022, -0.009, 0.019, -0.006, -0.02, 0.003, 0, -0.006, -0.007,
    0.006, 0.009, -0.001, -0.012, 0.019, -0.008, -0.017,
)  # fmt: skip
MAPS = tuple(f"map_{k}" for k in range(len(MAP_WEIGHTS)))
DEEP = {
    "glance_deep": {
        "rank": 0.247, "middle": 0.244, "upward": 0.107, "upward_high": -0.257, "seen": 0.082, "above": 0.052,
        "above_high": 0.019, "below": -0.06, "log_below": 0.14, "log_side": 0.569, "convexity": 0.628, "detail": -0.06,
        "relief": 0.098, "fullness_0.12": -0.066, "fullness_0.24": 0.128, "distance": -0.066,
        "distance_squared": 0.084, "outward": 0.14, "off_plane": -0.138, "on_plane": 0.129,
        **dict(zip(MAPS, MAP_WEIGHTS, strict=True)),
    },
}  # fmt: skip


METHODS: dict[str, dict[str, float]] = {
    "equal": dict.fromkeys(TABLE, 1.0),  # the plain average (T eq. 3.8)
    "thesis_ssim": {channel: ssim for channel, (ssim, _) in TABLE.items()},
    "thesis_ed": {channel: nearness for channel, (_, nearness) in TABLE.items()},
    **GLANCES,
}


def weights(method: str) -> dict[str, float]:
    """The weight of each channel by a method of METHODS: dict channel -> weight, not normalised.

    The methods give weights of all nine channels, for T eq. 3.9, which divides by their sum; GLANCES give those of the
    features of haptic_glance.look.glance. Raises ValueError for an unknown method.
    """
    if method not in METHODS:
        raise ValueError(f"unknown weights {method!r}: choose one of {', '.join(METHODS)}")
    return dict(METHODS[method])


SEEN_SUFFIX = "+seen"  # of methods whose weights were learned from all objects, the same one included, as in the thesis


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
    the methods are missing. The SVMs are `svm`, trained on all other objects; `svm+nearest`, that of the other object
    nearest in convexity; and, for an object with ground truth, `svm+object` and `svm+viewpoint`, trained on the object
    itself and on each of its views (T3.2.3).
    """
    table = read_table(Path(folder) / "weights.csv").fillna({"left_out": ALL})
    from_all = table[table.left_out == ALL]
    without = table[table.left_out == name]
    overall = _by_method(from_all)
    learned_weights = overall | _by_method(without)
    gazed = (Path(folder) / "ground_truth" / f"{name}.npz").exists()  # weights of DEEP that leave it out do not exist
    if without.empty and gazed:
        published = np.allclose([*overall[GLANCE].values()], [*weights(GLANCE).values()])
        usable = {*METHODS} if published else {*METHODS} - {*GLANCES}
        learned_weights = {method: values for method, values in overall.items() if method in usable}
    seen_weights = {f"{method}{SEEN_SUFFIX}": values for method, values in overall.items() if method not in METHODS}
    return LearnedWeights(learned_weights | seen_weights | ({} if gazed else _deep()), _svms(Path(folder), name, mesh))


def _deep():
    return {method: dict(factors) for method, factors in DEEP.items()}


def _by_method(table):
    groups = table.groupby("method", sort=False)
    return {str(method): dict(zip(rows.channel, rows.weight.astype(float), strict=True)) for method, rows in groups}


def _svms(folder, name, mesh):
    if not (folder / "convexity.csv").exists():
        return {}
    convexities = read_table(folder / "convexity.csv").set_index("object").convexity.to_dict()
    path = folder / "svm" / f"{name}.npz"
    others = {other: value for other, value in convexities.items() if other != name}
    svms = {"svm": read_models(path, "without") if path.exists() else read_models(folder / "svm.npz", "all")}
    svms["svm+seen"] = read_models(folder / "svm.npz", "all")
    if others:  # their names are texts, which pandas does not tell
        svms["svm+nearest"] = read_models(
            folder / "svm" / f"{nearest_convexity(convexity(mesh), others)}.npz",  # pyright: ignore[reportArgumentType]
            "object",
        )
    svms["svm+object"] = read_models(path, "object")
    svms["svm+viewpoint"] = read_models(path, "view")
    return {kind: models for kind, models in svms.items() if models}


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


ALL = ""  # the value of `left_out` for weights learned from all objects


def learned_weight_rows(training_data: dict[str, dict[str, np.ndarray]]) -> list[dict]:
    """Rows of method, channel, weight, left_out: the weights learned from all objects, and from all but each one.

    training_data: dict name -> arrays of collect_training_data. An object with ground truth must use the row that
    leaves it out, since the agreement with people is meaningless for weights that were learned from the same object.
    With a single object, only the rows learned from all objects exist.
    """
    folds = [ALL, *training_data] if len(training_data) > 1 else [ALL]
    per_object = {name: _views(arrays) for name, arrays in training_data.items()}
    rows = []
    for left_out in folds:
        names = [name for name in training_data if name != left_out]
        learned = {
            "guided_ed": average([per_object[name][0] for name in names]),
            "guided_ssim": average([per_object[name][1] for name in names]),
            "guided_ssim+object": average([per_object[name][2] for name in names]),
            **{method: _glance([training_data[name] for name in names], method) for method in GLANCES},
        }
        rows += [
            {"method": method, "channel": channel, "weight": round(weight, 9), "left_out": left_out}
            for method, weights in learned.items()
            for channel, weight in weights.items()
        ]
    return rows


def _views(arrays):
    """(weights by distance, by similarity, by similarity on the object) of one object, averaged over views (T3.2.1)."""
    distances, similarities, on_object = (_dicts(arrays, kind) for kind in ("distances", "similarities", "on_object"))
    return euclidean_weights(distances), similarity_weights(similarities), similarity_weights(on_object)


def _dicts(arrays, kind):
    """One dict channel -> value per view; empty for a view that shows no ground truth."""
    channels = [str(channel) for channel in arrays["channels"]]
    return [dict(zip(channels, row, strict=True)) if np.isfinite(row).all() else {} for row in arrays[kind]]


def _glance(objects, method):
    """The weights of a method of GLANCES."""
    names = list(GLANCES[method])
    columns = [objects[0]["glance_names"].tolist().index(name) for name in names]
    amounts, areas = ([arrays[key] for arrays in objects] for key in ("glance_amounts", "glance_areas"))
    weights = fit_fixations([arrays["glance"][:, columns] for arrays in objects], amounts, areas)
    return dict(zip(names, weights.tolist(), strict=True))
