"""The measurements of the scene stage, and how its methods are called."""

from .results import NotRun

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
    return first["scene"], float(first["tolerance"]), UNITS[first["kind"]]
