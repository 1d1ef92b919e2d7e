"""T figure 3.3: saliency and regions of interest, without and with the colour channels."""

import numpy as np

from stages.report.items import Figure
from stages.report.results import Results
from stages.report.style import MAP, plt, save
from stages.salient_points import COMBINATIONS, fuse

from .views import nearest, render_like, squared_window

COLOUR = ("color", "dkl")  # the thesis's RGB and DKL features
KEPT = 0.3  # of the object's pixels: the thesis retains 30 % of the highest values (T3.1.1)
COUNT, FADED = 4, 0.78
TITLES = ["", "without colour", "regions", "with colour", "regions"]


def build(results: Results) -> Figure:
    names = results.choose(results.settings.figure_objects, COUNT, stage="conspicuity")
    figure, grid = plt.subplots(len(names), 5, figsize=(9.2, 1.9 * len(names)), squeeze=False)
    overlaps = [_row(results, name, axes) for name, axes in zip(names, grid, strict=True)]
    for axes, title in zip(grid[0], TITLES, strict=True):
        axes.set_title(title, fontsize=10, fontweight="normal", loc="center")
    for axes in grid.flat:
        axes.set(xticks=[], yticks=[])
        axes.spines[:].set_visible(False)
    figure.subplots_adjust(wspace=0.04, hspace=0.04)
    path = save(figure, results.reports / "figures/figure_3_3.png")
    shares = ", ".join(f"{name} {100 * share:.0f} %" for name, share in zip(names, overlaps, strict=True))
    return Figure(
        "Figure 3.3: saliency and regions of interest, without and with colour",
        f"Rows of {', '.join(names)}: a render, the saliency map and its highest 30 % without the colour channels, and "
        "the same with them.",
        f"Equal weights of the eight channels of VisAttAll, with and without {' and '.join(COLOUR)}; the objects are "
        "dull grey, as in the thesis. Regions (red lines): the highest 30 % of the object's pixels. Of the regions "
        f"without colour stay with it: {shares}.",
        [path],
    )


def _row(results, name, axes):
    """Draws one object; returns the share of the regions without colour that stay regions with it."""
    maps, masks, viewpoints, channels = results.maps(name, COMBINATIONS["VisAttAll"])
    view = nearest(viewpoints, range(len(viewpoints)))
    mask, part = masks[view], squared_window(masks[view])
    render = render_like(results.mesh(name), viewpoints[view], mask.shape)[part]
    axes[0].imshow(render)
    axes[0].set_ylabel(name)
    regions = []
    for place, left_out in ((1, COLOUR), (3, ())):
        used = [k for k, channel in enumerate(channels) if channel not in left_out]
        saliency = fuse({channels[k]: maps[view, k] for k in used})
        region = mask & (saliency > np.quantile(saliency[mask], 1 - KEPT))
        axes[place].imshow(np.where(mask, saliency, np.nan)[part], cmap=MAP, vmin=0, vmax=saliency[mask].max())
        axes[place + 1].imshow(np.where(region[part][..., None], render, FADED + (1 - FADED) * render))
        axes[place + 1].contour(region[part], [0.5], colors=["#D81B1B"], linewidths=0.9)
        regions.append(region)
    return (regions[0] & regions[1]).sum() / max(regions[0].sum(), 1)
