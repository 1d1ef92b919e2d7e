"""How well the marks in data/annotations agree with each other, and with human gaze."""

import pandas as pd

from stages.kit.stats import interval
from stages.report.items import Table
from stages.report.markdown import with_interval
from stages.report.results import Results
from stages.report.words import dataset_text

WHERE = {"household": "household objects"}
METRICS = {"found": "marks found again by another pass, %", "nss": "NSS against gaze", "auc": "AUC against gaze"}
BESIDE = {"found": "random", "nss": "height", "auc": "height"}
NAMES = {"random": "as many random points", "height": "height alone"}
NOTES = [
    "Marked on rendered views by a vision model in three passes; no human subjects. So these marks say what a machine "
    "that has seen many pictures takes for salient, and no more.",
    "Found again: the share of one pass's marks that another pass has a mark within 5 % of the diagonal of, mean over "
    "the pairs of passes. Against gaze: the marks spread over the surface, on those gaze meshes that were marked too. "
    "Mean [95 % interval over the objects].",
]


def build(results: Results) -> Table:
    found = results.datasets("annotations") or [None]  # without any, the reader says what is missing
    rows = pd.concat([results.rows("annotations", dataset) for dataset in found])
    lines = []
    for (dataset, metric), group in rows.groupby(["dataset", "metric"], sort=False):
        table = group.pivot(index="item", columns="method", values="value")
        for method in table:
            mean, low, high = interval(table[method].dropna())
            line = {"dataset": dataset, "metric": metric, "method": method, "objects": len(table)}
            lines.append(line | {"mean": mean, "low": low, "high": high} | _over(table, method, BESIDE[metric]))
    frame = pd.DataFrame(lines)
    return Table("The marks: agreement of the passes, and with gaze", frame, [*_said(rows), *NOTES], _wide(frame))


def _over(table, method, other):
    if method == other or other not in table:
        return {}
    both = table[[method, other]].dropna()
    return dict(zip(("gain", "gain_low", "gain_high"), interval(both[method] - both[other]), strict=True))


def _said(rows):
    """Where the passes agree least, and most."""
    passes = rows[(rows["metric"] == "found") & (rows["method"] == "passes")].set_index("item")["value"]
    if passes.empty:
        return []
    low, high = passes.idxmin(), int((passes == 1).sum())
    return [
        f"The passes agree least on {low} ({100 * passes[low]:.0f} %); on {high} of {len(passes)} objects each mark "
        "was found again by every other pass."
    ]


def _wide(frame):
    lines = []
    for (dataset, metric), group in frame.groupby(["dataset", "metric"], sort=False):
        cell, other = group.set_index("method"), BESIDE[metric]
        scale, places = (100, 0) if metric == "found" else (1, 2)

        def text(method, columns=("mean", "low", "high"), cell=cell, scale=scale, places=places):
            values = cell.loc[method, list(columns)] if method in cell.index else [float("nan")] * 3
            return with_interval(*values, scale, places)

        lines.append(
            {
                "objects": f"{group['objects'].max()} {WHERE.get(dataset, dataset_text(dataset))}",
                "measure": METRICS[metric],
                "three passes": text("passes"),
                "one pass alone": text("one") if "one" in cell.index else "–",
                "beside": NAMES[other],
                "gets": text(other),
                "passes − that": text("passes", ("gain", "gain_low", "gain_high")),
            }
        )
    return pd.DataFrame(lines)
