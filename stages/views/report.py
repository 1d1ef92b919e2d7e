"""The share of the surface that the views see (T3.2.4)."""

from contextlib import suppress

from stages.charts.drawing import CYCLE, GREY, MARKERS, plt
from stages.charts.items import Figure
from stages.charts.results import NotRun, Results, require_rows

NAMES = {"greedy": "chosen one by one", "twelve": "the twelve of T figure 3.2", "four": "four all round"}
ENOUGH = 99  # per cent of the visible surface


def views_seen(results: Results) -> Figure:
    """The median over the objects and the quartiles, a line a set of views."""
    rows = results.measured("views", metric="seen_share")
    sets = {method: name for method, name in NAMES.items() if method in set(rows["method"])}
    require_rows(sets, f"none of {', '.join(NAMES)} among the sets of views", "views", runnable=False)
    figure, axes = plt.subplots(figsize=(7.2, 4.2))
    for (method, name), tint, mark in zip(sets.items(), CYCLE, MARKERS, strict=False):
        table = rows[rows["method"] == method].pivot(index="item", columns="views", values="value")
        # A greedy choice ends where nothing is left to see: what it saw stays seen.
        low, middle, high = (100 * table.ffill(axis=1)).quantile([0.25, 0.5, 0.75]).to_numpy()
        axes.fill_between(table.columns, low, high, color=tint, alpha=0.16, lw=0)
        axes.plot(table.columns, middle, mark, ls="-", color=tint, mec="white", ms=6.5, label=name)
    axes.axhline(ENOUGH, color=GREY, lw=0.9, ls=":")
    axes.set(xlabel="number of views", ylabel="share of the visible surface, %", ylim=(None, 100.5))
    axes.set_xticks(range(1, int(max(rows["views"])) + 1))
    axes.grid(axis="y")
    axes.set_title("What each further view adds", pad=12)
    axes.legend(loc="lower right")
    fewest = ""
    with suppress(NotRun):
        counts = results.measured("views", metric="fewest_views")["value"]
        fewest = f"The fewest candidates that see {ENOUGH} %: {counts.median():g} for the median object, "
        fewest += f"{counts.min():.0f} to {counts.max():.0f}."
    words = {"sets": ", ".join(sets.values()), "objects": rows["item"].nunique()}
    return Figure(figure, words | {"enough": ENOUGH, "fewest": fewest})


PAGE = "look"
TABLES = {}
FIGURES = {
    "views_seen": views_seen,
}
CHARTS = {}
