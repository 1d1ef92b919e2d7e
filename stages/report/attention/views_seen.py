"""How many views see an object: the share of the visible surface against the number of views (T3.2.4)."""

from contextlib import suppress

from stages.report.items import Figure
from stages.report.results import NotRun, Results
from stages.report.style import CYCLE, GREY, MARKERS, plt

NAMES = {"greedy": "chosen one by one", "twelve": "the twelve of T figure 3.2", "four": "four all round"}
QUARTILES = (0.25, 0.5, 0.75)
ENOUGH = 99  # per cent of the visible surface


def build(results: Results) -> Figure:
    """The median over the objects and the quartiles, a line a set of views."""
    rows = results.measured("views", metric="seen_share")
    methods = [method for method in NAMES if method in set(rows["method"])]
    if not methods:
        raise NotRun(f"none of {', '.join(NAMES)} among the sets of views", "views", runnable=False)
    figure, axes = plt.subplots(figsize=(7.2, 4.2))
    for method, tint, mark in zip(methods, CYCLE, MARKERS, strict=False):
        table = rows[rows["method"] == method].pivot(index="item", columns="views", values="value")
        # A greedy choice ends where nothing is left to see: what it saw stays seen.
        low, middle, high = (100 * table.ffill(axis=1)).quantile(QUARTILES).to_numpy()
        axes.fill_between(table.columns, low, high, color=tint, alpha=0.16, lw=0)
        axes.plot(table.columns, middle, mark, ls="-", color=tint, mec="white", ms=6.5, label=NAMES[method])
    axes.axhline(ENOUGH, color=GREY, lw=0.9, ls=":")
    ticks = range(1, int(max(rows["views"])) + 1)
    axes.set(xlabel="number of views", ylabel="share of the visible surface, %", xticks=ticks)
    axes.set_ylim(top=100.5)
    axes.grid(axis="y")
    axes.set_title("What each further view adds", pad=12)
    axes.legend(loc="lower right")
    fewest = ""
    with suppress(NotRun):
        counts = results.measured("views", metric="fewest_views")["value"]
        fewest = f"The fewest candidates that see {ENOUGH} %: {counts.median():g} for the median object, "
        fewest += f"{counts.min():.0f} to {counts.max():.0f}."
    sets = ", ".join(NAMES[method] for method in methods)
    return Figure(figure, {"sets": sets, "objects": rows["item"].nunique(), "enough": ENOUGH, "fewest": fewest})
