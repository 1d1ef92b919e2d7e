"""The few numbers of a run that the gate checks."""

from collections.abc import Sequence

import pandas as pd

from stages.kit.rows import some_rows

COLUMNS = ("item", "method", "target", "metric", "value", "infeasible", "shrunk")
METRICS = ("metro_mean", "ssim_error", "salient_error")


def summarise(rows: Sequence[dict]) -> dict[str, int | float | None]:
    """dict of mean errors per method over the cells (object, target) for which every method has a mesh (paired).

    A method without any mesh has None and is left out of the pairing. Also the number of such cells and of meshes, and
    the shares of infeasible cells and of those with shrunk neighbourhoods, over all and per method, among the cells
    that ask for fewer faces than the object has.
    """
    table = some_rows(rows, COLUMNS, ("faces", *METRICS))
    cells = pd.DataFrame(table[(table["metric"] == "faces") & (table["value"].notna() | table["infeasible"])])
    methods = list(dict.fromkeys(table["method"]))
    summary: dict[str, int | float | None] = {"meshes": len(cells.dropna(subset="value"))}
    summary["paired_cells"] = len(paired(table, "faces"))
    for share in ("infeasible", "shrunk"):
        summary[f"share_{share}"] = round(float(cells[share].to_numpy().mean()), 6)
        by_method = pd.Series(cells.groupby("method")[share].mean())
        summary |= {
            f"{share}_{method}": round(float(by_method[method]), 6) for method in methods if method in by_method
        }
    for metric in METRICS:
        means = paired(table, metric).mean()
        summary |= {f"{metric}_{method}": _rounded(means.get(method)) for method in methods}
    return summary


def paired(table: pd.DataFrame, metric: str) -> pd.DataFrame:
    """Frame of one metric, one column per method, one row per cell for which all methods have a mesh."""
    wide = table[table["metric"] == metric].pivot(index=["item", "target"], columns="method", values="value")
    return wide.astype(float).dropna(axis="columns", how="all").dropna()


def _rounded(value):
    return None if value is None or pd.isna(value) else round(float(value), 9)
