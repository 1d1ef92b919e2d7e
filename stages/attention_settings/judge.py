"""Learns the model of gaze from pictures of all other objects and judges it on each."""

from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np

from stages.conspicuity import CHANNELS
from stages.kit.files import read_arrays, read_json
from stages.kit.run import Rows
from stages.salient_points import COMBINATIONS
from stages.weights import fit_fixations, fixation_density
from stages.weights.agreement import GroundTruth, auc, nss
from stages.weights.features import CHANNEL_FEATURES

from .measure import parse, stored

CHOICES: dict[str, tuple[str, ...]] = {
    "none": (),
    "symmetry": CHANNEL_FEATURES,
    "orientation, symmetry": ("orientation", "symmetry"),
    "edge, orientation, symmetry": ("edge", "orientation", "symmetry"),
    "curvature, symmetry": ("curvature", "symmetry"),
    "itti": COMBINATIONS["VisAtt"],
    "itti, symmetry": (*COMBINATIONS["VisAtt"], "symmetry"),
    "nine": tuple(CHANNELS),
    **{f"nine without {name}": tuple(channel for channel in CHANNELS if channel != name) for name in CHANNELS},
}


def process(
    picture: str, folder: Path, data: Path, made: Path, names: list[str], choices: Mapping[str, list[str]]
) -> Rows:
    """Rows of one of the settings' pictures (VIEWS-ROWS), for its choices of channels, leaving each object out.

    made: where measure.process has written; names: the objects with human gaze; choices: {picture: names of CHOICES}.
    """
    views, rows = parse(picture)
    gaze = {name: read_arrays(data / "weights/ground_truth" / f"{name}.npz") for name in names}
    truths = {name: GroundTruth(one["amounts"], one["density"], one["areas"]) for name, one in gaze.items()}
    features = {name: stored(made / picture / f"{name}.npz", "feature") for name in names}
    maps = {name: stored(made / picture / f"{name}.npz", "map") for name in names}
    seconds = {name: read_json(made / picture / f"{name}.json") for name in names}
    found = []
    for choice in choices[picture]:
        channels = CHOICES[choice]
        chosen = [name for name in features[names[0]] if name in channels or name not in CHANNELS]
        densities = left_out(features, truths, chosen)
        for name in names:
            answers = {"fixations": densities[name]}
            if channels:
                answers["equal"] = np.add.reduce([maps[name][channel] for channel in channels])
            found += [
                {"item": name, "views": views, "rows": rows, "channels": choice, "method": model}
                | {"metric": metric.__name__, "value": float(metric(answer, truths[name]))}
                | {"seconds": cost(seconds[name], channels, model)}
                for model, answer in answers.items()
                for metric in (nss, auc)
            ]
    return found


def left_out(
    features: Mapping[str, dict[str, np.ndarray]], truths: Mapping[str, GroundTruth], chosen: Sequence[str]
) -> dict[str, np.ndarray]:
    """{object: (n,) density of fixations that the model predicts, learned from all other objects}."""
    stacked = {name: np.stack([own[key] for key in chosen], axis=1) for name, own in features.items()}
    found = {}
    for name, own in features.items():
        others = [other for other in features if other != name]
        weights = fit_fixations(
            [stacked[other] for other in others],
            [truths[other].amounts for other in others],
            [truths[other].areas for other in others],
        )
        found[name] = fixation_density(own, dict(zip(chosen, weights, strict=True)))
    return found


def cost(seconds: Mapping[str, float], channels: Sequence[str], model: str) -> float:
    """Seconds of what a choice of channels needs: without channels no picture is taken."""
    parts = ["facing", "features"] if model == "fixations" else []
    if channels:
        parts = ["pictures", "view_maps", *channels, *(["features"] if model == "fixations" else [])]
    return sum(seconds[part] for part in parts)
