"""T figure 3.13: the binarised ground truth of a view, and what the SVM makes of its nine maps."""

import numpy as np

from stages.report.items import Figure
from stages.report.results import NotRun, Results
from stages.report.style import MAP, label, plt, save
from stages.weights.ground_truth import gts_map, visible_points
from stages.weights.svm_pixels import SALIENT_LEVEL

from .views import nearest, render_like, window

MACHINES = ("svm_object", "svm")  # the thesis's, one for the object itself; and one that has not seen it
SALIENT, OBJECT, BACKGROUND = 0.1, 0.85, 1.0  # greys of the binary picture
MANY = 0.6  # of the most points that a view shows: such views are good enough to choose from
RED = "#D81B1B"


def build(results: Results) -> Figure:
    name = results.with_ground_truth(results.settings.figure_objects, 1)[0]
    mesh, ground_truth = results.mesh(name), results.ground_truth(name)
    maps, masks, viewpoints, _ = results.maps(name, ground_truth["channels"])
    svms = results.learned(name, mesh).svms
    machines = [machine for machine in MACHINES if machine in svms]
    if not machines:
        raise NotRun(f"no SVM was trained for {name}", "weights", runnable=False)
    seen = [visible_points(mesh, ground_truth["points"], viewpoint, masks.shape[1:])[:2] for viewpoint in viewpoints]
    counts = np.array([len(rows) for rows, _ in seen])
    view = nearest(viewpoints, np.flatnonzero(counts >= MANY * counts.max()))
    mask, part = masks[view], window(masks[view])
    truth = gts_map(*seen[view], mask) > SALIENT_LEVEL
    pixels = maps[view][:, mask].T
    answers = {machine: _answer(svms[machine], pixels, mask) for machine in machines}
    figure, grid = plt.subplots(1, 2 + len(machines), figsize=(2.7 * (2 + len(machines)), 2.7))
    grid[0].imshow(render_like(mesh, viewpoints[view], mask.shape)[part])
    down, across = (places - kept.start for places, kept in zip(seen[view], part, strict=True))
    grid[0].plot(across, down, "o", color=RED, ms=4.2, mec="white", mew=0.8)
    binary = np.where(mask, np.where(truth, SALIENT, OBJECT), BACKGROUND)
    grid[1].imshow(binary[part], cmap="gray", vmin=0, vmax=1)
    for axes, answer in zip(grid[2:], answers.values(), strict=True):
        shown = axes.imshow(answer[part], cmap=MAP, vmin=0, vmax=1)
        axes.contour(np.nan_to_num(answer)[part], [0.5], colors=[RED], linewidths=0.9)
    titles = [f"{name}, {len(down)} points", "binarised ground truth", *map(label, machines)]
    for axes, title in zip(grid, titles, strict=True):
        axes.set_title(title, fontsize=10, fontweight="normal", loc="center")
        axes.set_axis_off()
    bar = figure.colorbar(shown, ax=grid, shrink=0.8, pad=0.015, aspect=18)
    bar.set_label("the SVM's answer")
    path = save(figure, results.reports / "figures/figure_3_13.png")
    right = [f"{label(machine)} {100 * _right(answers[machine][mask], truth[mask]):.0f} %" for machine in machines]
    return Figure(
        "Figure 3.13: binarised ground truth, and the SVM's answer",
        f"A view of {name} with its ground truth points, the pixels near them in black, and maps of what the SVMs say.",
        "Red line: where the SVM says salient. SVM of the object: trained on this very object, the thesis's way; SVM: "
        f"on the other objects alone. Right on this view's object, both classes alike: {'; '.join(right)}; guessing "
        "gets 50 %.",
        [path],
    )


def _answer(models, pixels, mask):
    """(h, w): the answer of an SVM for all views, NaN off the object."""
    image = np.full(mask.shape, np.nan)
    image[mask] = next(iter(models.values())).predict(pixels)
    return image


def _right(answer, truth):
    """The mean of the shares told right of both classes."""
    return np.mean([((answer > 0.5)[truth == value] == value).mean() for value in (True, False)])
