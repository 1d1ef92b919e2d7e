"""Each method's worst case: before and after."""

import numpy as np

from stages.kit import Mesh
from stages.kit.files import read_arrays
from stages.report.drawing import show, square_grid
from stages.report.items import Figure
from stages.report.results import NotRun, Results
from stages.report.style import label, save
from stages.stability import PERTURBATIONS


def build(results: Results) -> Figure:
    worst = _worst(results)
    figure, grid = square_grid(2, len(worst), side=1.9, right=0.2, gap=0.5)
    for across, (method, case) in enumerate(worst.items()):
        before, after = grid[:, across]
        original = results.mesh(case["item"])
        show(before, original, case["before_saliency"], points=case["before_points"])
        show(after, Mesh(case["vertices"], case["faces"]), case["after_saliency"], points=case["after_points"])
        before.set_title(f"{label(method)}\n{case['item']}", fontsize=9, fontweight="normal", loc="center")
        what = f"{label(case['perturbation'])} {float(case['severity']):g}"
        again = f"{100 * float(case['repeatability']):.0f} % found again"
        after.set_title(f"{what}\n{again}", fontsize=9, fontweight="normal", loc="center")
    for axes, text in zip(grid[:, 0], ("before", "after"), strict=True):
        axes.text(-0.04, 0.5, text, rotation=90, va="center", ha="right", transform=axes.transAxes)
    path = save(figure, results.reports / "figures/stability_failures.png")
    units = {case["perturbation"]: PERTURBATIONS[case["perturbation"]].unit for case in worst.values()}
    return Figure(
        "Where each method fails",
        "Two pictures a method, before and after the perturbation that costs it most points, coloured by saliency from "
        f"dark (low) to yellow (high): {', '.join(map(label, worst))}.",
        "The worst of the middle severities, over all objects. Red: the points on the side that is seen. "
        + "; ".join(f"{label(name)}: {unit}" for name, unit in units.items()) + ".",
        [path],
    )  # fmt: skip


def _worst(results):
    """dict method -> its arrays on the object where the fewest points were found again."""
    found = {}
    for path in sorted(results.folder("stability").glob("*.npz")):
        stored = read_arrays(path)
        for method in dict.fromkeys(key.rpartition(".")[0] for key in stored):
            case = {key.rpartition(".")[2]: values for key, values in stored.items() if key.startswith(f"{method}.")}
            case |= {"item": path.stem, "perturbation": str(case["perturbation"])}
            best = found.get(method)
            if best is None or np.nan_to_num(case["repeatability"]) < np.nan_to_num(best["repeatability"]):
                found[method] = case
    if not found:
        raise NotRun("no data/stability", "stability")
    return found
