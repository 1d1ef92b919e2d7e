"""The measurements of the scene stage, how its methods are called, and what the comparison of them leaves open."""

import numpy as np

from stages.report.results import NotRun

NAMES = {
    "full": "full models",
    "uniform": "uniform levels by distance",
    "uniform_size": "uniform levels by size on the screen",
    "network": "the thesis's network",
    "ours_plain": "ours, salience left out",
    "ours": "ours",
    "equal": "ours, the limit shared equally",
}
COLOURS = {
    "full": "#222222", "uniform": "#E69F00", "uniform_size": "#D55E00", "network": "#CC79A7", "ours_plain": "#56B4E9",
    "ours": "#0072B2",
}  # fmt: skip
UNITS = {"pixels": "pixels", "ssim": "1 − SSIM"}
OURS = "ours"
UNIFORM = ("uniform", "uniform_size")


def scene_rows(results, **where):
    """Rows of the scene stage with a value; an empty `matched` reads as such. NotRun where there are none."""
    return results.measured("scene", **where).assign(matched=lambda rows: rows["matched"].fillna(""))


def at_tolerance(rows):
    """Rows at the scene's own tolerance, of plans that are equal to ours in the mean error or stand for themselves."""
    return rows[(rows["factor"] == 1) & rows["matched"].isin(["", "error"])]


def amount(value, unit):
    """A tolerance in words: 1 pixel, 0.5 pixels."""
    return f"{value:g} {unit.removesuffix('s') if value == 1 else unit}"


def of_scene(rows):
    """(name of the scene, its tolerance, the tolerance's unit in words)."""
    known = rows[rows["factor"] == 1].dropna(subset=["tolerance"])
    if known.empty:
        raise NotRun("no row at the scene's own tolerance", "scene")
    first = known.iloc[0]
    return first["group"], float(first["tolerance"]), UNITS[first["kind"]]


def limits_of(saved):
    """Sentences on what a saving at an equal error leaves open.

    saved: dict (rival, matched) -> shares of the faces that ours saves, one a scene.
    """
    pairs = {name: (saved[name, "error"], saved[name, "displacement"]) for name in UNIFORM
             if (name, "error") in saved and (name, "displacement") in saved}  # fmt: skip
    planned = (
        "The error made equal, that of each frame's worst object (the 99 % quantile of its displacement, or its mean "
        "1 − SSIM), is the one that ours plans by, and no rival does."
    )
    if pairs:
        parts = [f"{_range(spread)} instead of {_range(equal)} against {NAMES[name]}"
                 for name, (equal, spread) in pairs.items()]  # fmt: skip
        planned += f" At an equal mean displacement of all pixels {_left(pairs)}: {'; '.join(parts)}."
    return [
        planned,
        "Each rival has one number for the whole path, its factor. Ours sees the rendered error of every object in "
        "every frame, what its neighbours hide there, and the whole path ahead, which has to be known beforehand.",
        "The intervals resample the objects, while the rival's factor stays as it was tuned on the whole scene: how it "
        "would change with other objects is not in them.",
    ]


def _left(pairs):
    """How much of the saving at an equal error is left at an equal displacement, in words."""
    equal, spread = (np.mean(np.concatenate(shares)) for shares in zip(*pairs.values(), strict=True))
    if spread >= equal:
        return "the saving is no smaller"
    return "most of the saving vanishes" if spread < equal / 2 else "part of the saving vanishes"


def _range(shares):
    """Shares as percent: 12 %, or 3 to 40 %."""
    return " to ".join(dict.fromkeys(f"{round(100 * share):d}" for share in (min(shares), max(shares)))) + " %"
