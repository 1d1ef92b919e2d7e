"""T figure 4.4: the normalised cross-correlation of imprints, for every pair of objects."""

from itertools import combinations

import numpy as np

from stages.classification.similarity import SIMILARITY_THRESHOLD, similarity
from stages.kit.files import read_arrays
from stages.report.items import Figure
from stages.report.results import NotRun
from stages.report.style import GREY, INK, METHOD_COLOURS, plt, save

from .rows import OURS

SAMPLINGS = {"random": "blind touch", OURS["enhanced_visual_attention"]: "enhanced visual attention"}
THESIS_PAIR = ("duck", "elephant")  # for the thesis's cow and dromedary


def build(results):
    objects = _objects(results)
    found = {method: _pairs(results, objects, method) for method in SAMPLINGS}
    enhanced = found[OURS["enhanced_visual_attention"]]
    order = sorted(enhanced, key=lambda pair: np.median(enhanced[pair]))
    figure, axes = plt.subplots(figsize=(7.6, 0.42 * len(order) + 1.2))
    for place, (method, pairs) in zip((0.18, -0.18), found.items(), strict=True):
        tint = METHOD_COLOURS[method]
        axes.boxplot(
            [pairs[pair].ravel() for pair in order], positions=np.arange(len(order)) + place, widths=0.3,
            orientation="horizontal", whis=(5, 95), showfliers=False, patch_artist=True,
            boxprops={"facecolor": tint, "edgecolor": tint, "alpha": 0.75}, medianprops={"color": INK},
            whiskerprops={"color": tint}, capprops={"color": tint}, label=SAMPLINGS[method],
        )  # fmt: skip
        for k, pair in enumerate(order):
            share = (np.maximum(pairs[pair].max(axis=1)[:, None], 0) >= SIMILARITY_THRESHOLD).mean()
            axes.text(1.03, k + place, f"{100 * share:.0f} %", va="center", fontsize=8, color=INK)
    axes.axvline(SIMILARITY_THRESHOLD, color=GREY, lw=1, ls="--")
    axes.text(1.03, len(order) - 0.35, "share", fontsize=8, color=INK)
    axes.set_yticks(range(len(order)), [" – ".join(pair) for pair in order])
    axes.set_xlim(-1, 1)
    axes.set_xlabel("normalised cross-correlation of two imprints")
    axes.tick_params(axis="y", length=0)
    axes.set_title("How alike the imprints of two objects are", pad=26)
    axes.legend(loc="lower left", bbox_to_anchor=(-0.01, 0.99), ncols=2, fontsize=9)
    path = save(figure, results.reports / "figures/figure_4_4.png")
    return Figure(
        "Figure 4.4: how alike the imprints of two objects are",
        "One pair of boxes for each two objects, ordered by the median under enhanced attention: "
        "correlations of all imprints of one with all of the other, for blind touch and enhanced attention; a dashed "
        f"line at {SIMILARITY_THRESHOLD}.",
        f"Boxes: quartiles of all pairs of imprints, whiskers: 5 to 95 %. Right of {SIMILARITY_THRESHOLD} an imprint "
        "counts as one that the other object has too; the share of the first object's imprints for which that is so "
        f"stands on the right. The thesis shows cow and dromedary; {THESIS_PAIR[0]} and {THESIS_PAIR[1]} stand for "
        "them here.",
        [path],
    )


def _objects(results):
    """The objects of the group six, or of four where that was not run."""
    folder = results.folder("classification")
    for name in ("six", "four"):
        paths = sorted(folder.glob(f"{name}.*.npz"))
        if paths:
            return [str(one) for one in read_arrays(paths[0])["objects"]]
    raise NotRun("no groups in data/classification", "classification")


def _pairs(results, objects, method):
    """{(object, object): (k, l) correlations of their imprints}."""
    images = {name: results.imprints(name)[method] for name in objects}
    return {(one, two): similarity(images[one], images[two]) for one, two in combinations(objects, 2)}
