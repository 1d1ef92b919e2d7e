"""How well the marks in data/annotations agree with each other, and with human gaze."""

from collections.abc import Sequence

import numpy as np
import pandas as pd

from stages.kit.stats import interval
from stages.report.grid import grouped
from stages.report.items import Table
from stages.report.markdown import with_interval
from stages.report.results import Results
from stages.report.words import dataset_text

from .rows import GAIN, MEAN, gain

METRICS = {"found": "marks found again by another pass, %", "nss": "NSS against gaze", "auc": "AUC against gaze"}
BESIDE = {"random": "as many random points", "height": "height alone"}


def build(results: Results) -> Table:
    """Agreement of the passes beside random points, and with gaze beside height; intervals over the objects."""
    sets = results.datasets("annotations") or [None]  # without any, the reader says what is missing
    rows = pd.concat([results.rows("annotations", dataset) for dataset in sets])
    found, shown = [], []
    for (dataset, metric), group in grouped(rows, ["dataset", "metric"]):
        table = group.pivot(index="item", columns="method", values="value")
        other = "random" if metric == "found" else "height"
        cells = {
            name: dict(zip(MEAN, interval(table[name]), strict=True)) | gain(table, name, other)
            for name in map(str, table)
        }
        about = {"dataset": dataset, "metric": metric}
        found += [about | {"method": name, "objects": len(table)} | cell for name, cell in cells.items()]
        shown.append({
            "objects": f"{len(table)} {'household objects' if dataset == 'household' else dataset_text(dataset)}",
            "measure": METRICS[metric],
            "three passes": _text(cells.get("passes", {}), metric),
            "one pass alone": _text(cells["one"], metric) if "one" in cells else "–",
            "beside": BESIDE[other],
            "gets": _text(cells.get(other, {}), metric),
            "passes − that": _text(cells.get("passes", {}), metric, GAIN),
        })  # fmt: skip
    # no ranking: a row is a question, not a method
    return Table(pd.DataFrame(found), pd.DataFrame(shown), {"extremes": _extremes(rows)})


def _text(cell: dict[str, float], metric: str, names: Sequence[str] = MEAN) -> str:
    scale, places = (100, 0) if metric == "found" else (1, 2)
    return with_interval(*(cell.get(name, np.nan) for name in names), scale=scale, places=places)


def _extremes(rows: pd.DataFrame) -> str:
    """Where the passes agree least, and most; nothing where they were not compared."""
    passes = rows[(rows["metric"] == "found") & (rows["method"] == "passes")].set_index("item")["value"]
    if passes.empty:
        return ""
    low = str(passes.idxmin())
    return (
        f"The passes agree least on {low} ({100 * passes[low]:.0f} %); on {(passes == 1).sum()} of {len(passes)} "
        "objects each mark was found again by every other pass."
    )
