"""The few numbers of a run that the gate looks at."""

import pandas as pd

METRICS = ("metro_mean", "ssim_error", "salient_error")


def summarise(rows):
    """dict of mean errors a method over the cells (object, target) that every method reached, so that they are paired.

    Methods that reached no cell at all have None and stay out of the pairing. Beside them: how many such cells, how
    many meshes, the shares of infeasible cells and of those with smaller neighbourhoods than wished, over all and a
    method, among those that ask for fewer faces than the object has.
    """
    table = pd.DataFrame(rows)
    cells = table[(table["metric"] == "faces") & (table["value"].notna() | table["infeasible"])]
    methods = list(dict.fromkeys(table["method"]))
    summary = {"meshes": int(cells["value"].notna().sum()), "paired_cells": len(paired(table, "faces"))}
    for share in ("infeasible", "shrunk"):
        summary[f"share_{share}"] = round(float(cells[share].mean()), 6)
        by_method = cells.groupby("method")[share].mean()
        summary |= {
            f"{share}_{method}": round(float(by_method[method]), 6) for method in methods if method in by_method
        }
    for metric in METRICS:
        means = paired(table, metric).mean()
        summary |= {f"{metric}_{method}": _rounded(means.get(method)) for method in methods}
    return summary


def paired(table, metric):
    """Frame of one metric, a column a method, a row a cell that all of them reached."""
    wide = table[table["metric"] == metric].pivot(index=["object", "target"], columns="method", values="value")
    return wide.astype(float).dropna(axis="columns", how="all").dropna()


def _rounded(value):
    return None if value is None or pd.isna(value) else round(float(value), 9)
