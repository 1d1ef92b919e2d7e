"""What the array feels at one place under every perturbation, from mild to harsh."""

from collections.abc import Iterable

import numpy as np

from haptic_glance.base.files import read_arrays
from stages.report.items import Figure
from stages.report.results import Results
from stages.report.style import PALE, label, plt
from stages.touch_stability import PERTURBATIONS

MOST = 6  # severities


def build(results: Results) -> Figure:
    """Tactile images of one object's first place, a line a perturbation of what is asked about."""
    [item] = results.choose(results.settings.figure_objects, 1, "touch_stability")
    stored = read_arrays(results.folder("touch_stability") / f"{item}.npz")
    asked = [name for name, known in PERTURBATIONS.items() if not known.in_training]
    shown = {name: found for name in asked if (found := severities(stored, name))}
    half, across = -(-len(shown) // 2), MOST + 2  # beside the images: the name, and no change
    unmarked = {"xticks": [], "yticks": []}
    figure, grid = plt.subplots(half, 2 * across, figsize=(12.5, 0.86 * half), squeeze=False, subplot_kw=unmarked)
    for axes in grid.flat:
        axes.set_axis_off()
    for k, (name, found) in enumerate(shown.items()):
        words, *row = grid[k % half, across * (k // half) :]
        words.text(1.0, 0.5, label(name), ha="right", va="center", fontsize=9, transform=words.transAxes)
        keys = {"none": "shown.clean"} | {severity: f"shown.{name}.{severity}" for severity in found[:MOST]}
        for axes, (title, key) in zip(row, keys.items(), strict=False):
            axes.set_axis_on()
            axes.imshow(stored[key][0], cmap="gray", vmin=0, vmax=1)
            axes.spines[:].set(visible=True, color=PALE, linewidth=0.6)
            axes.set_title(title, fontsize=7, fontweight="normal", loc="center", pad=2)
    figure.subplots_adjust(wspace=0.06, hspace=0.35)
    return Figure(figure, {"name": item, "perturbations": ", ".join(map(label, shown))})


def severities(keys: Iterable[str], perturbation: str) -> list[str]:
    """The severities of a perturbation as they stand in the keys of a file, from mild to harsh."""
    start, unharmed = f"shown.{perturbation}.", PERTURBATIONS[perturbation].unharmed
    found = [key.removeprefix(start) for key in keys if key.startswith(start)]
    return sorted(found, key=lambda key: np.abs(float(key) - unharmed))
