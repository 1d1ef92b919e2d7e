"""The few numbers of a run that the gate looks at."""

import pandas as pd

METRICS = ("metro_mean", "ssim_error")


def summarise(rows):
    """dict of mean errors a method over the cells (object, target) that every method reached, so that they are paired.

    Beside them: how many such cells, how many meshes, and the share of infeasible cells, over all and a method, among
    those that ask for fewer faces than the object has.
    """
    table = pd.DataFrame(rows)
    cells = table[(table["metric"] == "faces") & (table["value"].notna() | table["infeasible"])]
    methods = list(dict.fromkeys(table["method"]))
    summary = {
        "meshes": int(cells["value"].notna().sum()),
        "share_infeasible": round(float(cells["infeasible"].mean()), 6),
    }
    for metric in METRICS:
        wide = table[table["metric"] == metric].pivot(index=["object", "target"], columns="method", values="value")
        paired = wide.reindex(columns=methods).dropna()
        summary["paired_cells"] = len(paired)
        summary |= {f"{metric}_{m}": round(float(paired[m].mean()), 9) if len(paired) else None for m in methods}
    for method in methods:
        summary[f"infeasible_{method}"] = round(float(cells.loc[cells["method"] == method, "infeasible"].mean()), 6)
    return summary
