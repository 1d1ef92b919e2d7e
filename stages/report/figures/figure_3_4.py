"""T figure 3.4: errors of the simplified meshes by combination of channels and number of faces."""

import numpy as np

from stages.report.items import Figure
from stages.report.results import NotRun
from stages.report.style import INK, label, plt, save
from stages.report.tables.table_3_1_5_combinations import ALIASES, NAMES, combined_cells
from stages.weights.agreement import paired

CLASSICAL = ALIASES["VisAtt"]
METHODS = [ALIASES.get(name, name) for name in NAMES]
METRICS = {"metro_mean": "Metro mean error,\n% of the diagonal", "ssim_error": "SSIM error, %"}
FEWEST = 3  # objects that a face count needs to be shown
SHADES = ["#0072B2", "#56B4E9", "#009E73", "#E69F00", "#D55E00", "#CC79A7"]


def build(results):
    rows = combined_cells(results)
    methods = [method for method in METHODS if method in set(rows["method"])]
    if CLASSICAL not in methods or len(methods) < 2:
        raise NotRun("no two combinations of channels reach one face count on one object", "lod", runnable=False)
    counts = rows.groupby("target")["object"].nunique()
    targets = sorted(counts.index[counts >= FEWEST], key=_size)
    if not targets:
        raise NotRun(f"no face count that all combinations reach on {FEWEST} objects", "lod", runnable=False)
    figure, panels = plt.subplots(2, 1, figsize=(9.6, 6.2), sharex=True)
    for axes, (metric, name) in zip(panels, METRICS.items(), strict=True):
        _bars(axes, rows[rows["metric"] == metric], methods, targets)
        axes.set_ylabel(name)
    panels[0].legend(loc="lower left", bbox_to_anchor=(0, 1), ncols=len(targets), fontsize=9, columnspacing=1.2)
    panels[1].set_xticks(range(len(methods)), [label(method) for method in methods], rotation=25, ha="right")
    path = save(figure, results.reports / "figures/figure_3_4.png")
    said = ", ".join(f"{_said(target)}: {counts[target]} objects" for target in targets)
    return Figure(
        "Figure 3.4: what each combination of channels does to the simplified mesh",
        f"Bars of the Metro and the SSIM error for {', '.join(map(label, methods))} at {len(targets)} face counts.",
        f"Mean over the objects on which every combination reaches the face count ({said}). Lines: 95 % interval of "
        f"the paired difference from {label(CLASSICAL)} (VisAtt), drawn about the bar: where one covers the dotted "
        "line, the two are not told apart.",
        [path],
    )


def _bars(axes, rows, methods, targets):
    width = 0.84 / len(targets)
    for place, target in enumerate(targets):
        table = 100 * rows[rows["target"] == target].pivot(index="object", columns="method", values="value")[methods]
        x = np.arange(len(methods)) + (place - (len(targets) - 1) / 2) * width
        tint, base = SHADES[place % len(SHADES)], table[CLASSICAL].mean()
        axes.bar(x, table.mean(), width * 0.92, color=tint, label=_said(target))
        for across, method in zip(x[1:], methods[1:], strict=True):
            _, low, high = paired(table[method], table[CLASSICAL])
            axes.plot([across, across], [base + low, base + high], color=INK, lw=1)
        axes.axhline(base, color=tint, lw=0.8, ls=":", zorder=0)
    axes.set_ylim(bottom=0)
    axes.tick_params(axis="x", length=0)


def _size(target):
    """Shares before counts, large before small."""
    return (not target.endswith("%"), -float(target.rstrip("%")))


def _said(target):
    return target if target.endswith("%") else f"{int(target):,} faces"
