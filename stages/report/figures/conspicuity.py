"""The nine conspicuity maps of one object beside its render."""

import numpy as np

from stages.conspicuity.storage import viewpoint_named
from stages.report.drawing import VIEWPOINT, picture
from stages.report.items import Figure
from stages.report.style import MAP, plt, save

FAINT = 0.02  # conspicuity below which a map shows nothing


def build(results):
    name = results.choose(results.settings.figure_objects, 1, stage="conspicuity")[0]
    stored = results.conspicuity(name)
    viewpoints = [viewpoint_named(view) for view in stored["viewpoints"]]
    chosen = _best_view(stored["maps"], viewpoints)
    viewpoint = viewpoints[chosen]
    maps, mask = stored["maps"][chosen].astype(np.float32), stored["mask"][chosen]
    window = _window(mask)
    figure, grid = plt.subplots(2, 5, figsize=(9.6, 4.6))
    render = picture(results.mesh(name), viewpoint=viewpoint, rows=mask.shape[0])
    side = (mask.shape[1] - mask.shape[0]) // 2
    render = np.pad(render, ((0, 0), (side, mask.shape[1] - mask.shape[0] - side), (0, 0)), constant_values=1.0)
    grid[0, 0].imshow(render[window])
    grid[0, 0].set_title(name, fontsize=10, loc="center")
    for axes, channel, values in zip(grid.flat[1:], stored["channels"], maps, strict=False):
        top = float(values[mask].max())
        shown = axes.imshow(np.where(mask, values / (top or 1.0), np.nan)[window], cmap=MAP, vmin=0, vmax=1)
        axes.set_title(f"{channel}\nup to {top:.2f}", fontsize=9, fontweight="normal", loc="center")
    for axes in grid.flat:
        axes.set_axis_off()
    figure.subplots_adjust(wspace=0.04, hspace=0.12)
    bar = figure.colorbar(shown, ax=grid, shrink=0.75, pad=0.02, aspect=30)
    bar.set_label("conspicuity, over the map's largest")
    path = save(figure, results.reports / "figures/conspicuity.png")
    return Figure(
        "What each channel sees",
        f"A render of {name} and its conspicuity maps: {', '.join(map(str, stored['channels']))}.",
        f"{name} from azimuth {viewpoint.azimuth:g}, elevation {viewpoint.elevation:g} degrees.",
        [path],
    )


def _best_view(maps, viewpoints):
    """The view in which most channels answer; of several, the one nearest to the other figures' viewpoint."""
    answers = (maps.max(axis=(2, 3)) > FAINT).sum(axis=1)
    near = [view.axes[2] @ VIEWPOINT.axes[2] for view in viewpoints]
    return max(range(len(viewpoints)), key=lambda k: (answers[k], near[k]))


def _window(mask, margin=4):
    down, across = np.flatnonzero(mask.any(axis=1)), np.flatnonzero(mask.any(axis=0))
    return (
        slice(max(down[0] - margin, 0), down[-1] + margin + 1),
        slice(max(across[0] - margin, 0), across[-1] + margin + 1),
    )
