"""T figure 3.10: the nine conspicuity maps of one object beside its render."""

import numpy as np

from stages.conspicuity import CHANNELS
from stages.report.items import Figure
from stages.report.results import Results
from stages.report.style import MAP, plt, save

from .views import nearest, render_like, window

FAINT = 0.02  # conspicuity below which a map shows nothing


def build(results: Results) -> Figure:
    name = results.choose(results.settings.figure_objects, 1, stage="conspicuity")[0]
    maps, masks, viewpoints, stored = results.maps(name)
    channels = [channel for channel in CHANNELS if channel in stored]
    maps = maps[:, [stored.index(channel) for channel in channels]]
    chosen = _best_view(maps, viewpoints)
    viewpoint, maps, mask = viewpoints[chosen], maps[chosen], masks[chosen]
    part = window(mask)
    figure, grid = plt.subplots(2, 5, figsize=(9.6, 4.6))
    grid[0, 0].imshow(render_like(results.mesh(name), viewpoint, mask.shape)[part])
    grid[0, 0].set_title(name, fontsize=10, loc="center")
    for axes, channel, values in zip(grid.flat[1:], channels, maps, strict=False):
        top = float(values[mask].max())
        shown = axes.imshow(np.where(mask, values / (top or 1.0), np.nan)[part], cmap=MAP, vmin=0, vmax=1)
        axes.set_title(f"{channel}\nup to {top:.2f}", fontsize=9, fontweight="normal", loc="center")
    for axes in grid.flat:
        axes.set_axis_off()
    figure.subplots_adjust(wspace=0.04, hspace=0.12)
    bar = figure.colorbar(shown, ax=grid, shrink=0.75, pad=0.02, aspect=30)
    bar.set_label("conspicuity, over the map's largest")
    path = save(figure, results.reports / "figures/figure_3_10.png")
    return Figure(
        "Figure 3.10: what each channel sees",
        f"A render of {name} and its conspicuity maps: {', '.join(channels)}.",
        f"{name} from azimuth {viewpoint.azimuth:g}, elevation {viewpoint.elevation:g} degrees.",
        [path],
    )


def _best_view(maps, viewpoints):
    """The view in which most channels answer; of several, the one nearest to the other figures' viewpoint."""
    answers = (maps.max(axis=(2, 3)) > FAINT).sum(axis=1)
    return nearest(viewpoints, np.flatnonzero(answers == answers.max()))
