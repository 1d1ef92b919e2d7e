"""Where networks look: agreement with people against the seconds of training and looking."""

import pandas as pd

from stages.kit.stats import interval
from stages.report.items import Figure
from stages.report.markdown import signed
from stages.report.pareto import pareto_chart
from stages.report.results import NotRun, Results

from .rows import FUSED, best_source, gap, network_text, networks, scores

REFERENCE = "mobilenet_v2-frozen"


def build(results: Results) -> Figure:
    source, rows = best_source(results)
    table = scores(rows, "pcc")
    methods = [method for method in networks(rows) if (method, FUSED) in table]
    frame = pd.DataFrame([_line(rows, table, method) for method in methods])
    if REFERENCE not in methods:
        raise NotRun(f"the reference {network_text(REFERENCE)} is not measured", "fixation", runnable=False)
    chart = pareto_chart(
        frame, "seconds", "mean", "name", name="fixation", title="Where networks look: what training costs",
        reference=network_text(REFERENCE), quality_label=f"PCC, {source}", folder=results.reports / "tradeoff",
    )  # fmt: skip
    chart.caption += (
        f" EWIGC on {source}. Cost: teaching all tasks, and for every object its pictures, the network's maps and "
        f"putting them on the surface. Frozen: the maps are computed once for all tasks. {_saved(table, methods)}"
    )
    return chart


def _line(rows, table, method):
    mean, low, high = interval(table[method, FUSED].dropna())
    own = rows[rows["method"] == method].dropna(subset=["seconds"])
    teaching = own.loc[own["metric"] == "accuracy"].drop_duplicates(["task", "seconds"])["seconds"].sum()
    looking = own.loc[own["metric"] == "pcc"].drop_duplicates("item")["seconds"].median()
    objects = own.loc[own["metric"] == "views", "item"].nunique()
    line = {"name": network_text(method), "mean": mean, "low": low, "high": high, "objects": objects}
    return line | {"teaching": teaching, "looking": looking, "seconds": teaching + objects * looking}


def _saved(table, methods):
    """What training every layer changes, paired over the objects."""
    said = []
    for method in methods:
        frozen = f"{method.removesuffix('-finetuned')}-frozen"
        if method.endswith("-finetuned") and frozen in methods:
            difference = signed(*interval(gap(table, (method, FUSED), (frozen, FUSED))), places=3)
            said.append(f"{network_text(method)} minus frozen: PCC {difference}")
    return f"{'; '.join(said)}." if said else "No network was fine-tuned here."
