"""The outcome of simplifying broken meshes: valid, refused, ruined or crash."""

from typing import Any

import numpy as np
import pandas as pd

from stages.charts.drawing import label
from stages.charts.items import Table
from stages.charts.results import Results
from stages.charts.tables import grouped
from stages.stability.simplification import OUTCOMES, SMALLEST
from stages.stability.surface import LARGEST_ERROR, RUIN

STAGE = "stability"


def table(results: Results) -> Table:
    """Cases by outcome, a line a kind of damage and simplifier; the fewest faces, and seconds of each."""
    cases = results.measured(STAGE, metric="faces")
    frame = pd.DataFrame([
        {"damage": damage, "backend": backend, **_outcomes(group)}
        for (damage, backend), group in grouped(cases, ["perturbation", "method"])
    ])  # fmt: skip
    count_columns = [*OUTCOMES, "smallest_named", "smallest_had"]
    total = frame.groupby("backend", sort=False)[count_columns].sum().reset_index().assign(damage="all", least=np.nan)
    text_rows = [
        {"damage": label(row["damage"]), "simplifier": label(row["backend"]), **{name: row[name] for name in OUTCOMES}}
        | {"least": row["least"], "smallest had": f"{row['smallest_had']} of {row['smallest_named']}"}
        for row in pd.concat([frame, total]).to_dict("records")
    ]  # fmt: skip
    valid = cases.loc[(cases["outcome"] == "valid") & (cases["budget"] != SMALLEST)].fillna({"soft": ""})
    keys, backends = ["item", "perturbation", "budget", "kept", "soft"], cases["method"].unique()
    means = valid.pivot_table("seconds", index=keys, columns="method").dropna().mean()  # of what all backends can
    times = [f"{label(peer)} {means[peer]:.4f} ({means[peer] / means[backends[0]]:.2g} times)" for peer in backends]
    objects = ", ".join(dict.fromkeys(cases["item"]))
    words = {"ruin": RUIN, "largest": 100 * LARGEST_ERROR, "objects": objects}
    return Table(frame, pd.DataFrame(text_rows), words | {"times": ", ".join(times)})


def _outcomes(cases: pd.DataFrame) -> dict[str, Any]:
    """One damage and backend: cases by outcome, fewest faces, median seconds, and why the worst case failed."""
    is_valid = cases.loc[cases["budget"] == SMALLEST, "outcome"] == "valid"
    bad = cases.loc[cases["outcome"].isin(OUTCOMES[1:])].sort_values("outcome", ascending=False)
    return {
        **{outcome: (cases["outcome"] == outcome).sum() for outcome in OUTCOMES}, "least": least_valid(cases),
        "smallest_named": len(is_valid), "smallest_had": sum(is_valid), "seconds": cases["seconds"].median(),
        "worst": next(iter(bad["note"]), ""),
    }  # fmt: skip


def least_valid(cases: pd.DataFrame) -> float:
    """The fewest faces, nothing kept, from which on every object gave a valid mesh at every count; or NaN."""
    plain = cases.loc[(cases["kept"] == "none") & cases["soft"].isna() & (cases["budget"] != SMALLEST)]
    counts = plain.assign(valid=plain["outcome"] == "valid").groupby("budget").agg({"severity": "max", "valid": "all"})
    counts = counts.sort_values("severity", ascending=False)
    return min(counts.loc[counts["valid"].cummin(), "severity"], default=np.nan)
