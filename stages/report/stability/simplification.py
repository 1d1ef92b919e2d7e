"""What becomes of broken meshes when they are simplified: valid, refused, ruined or crash, a line a kind of damage."""

import numpy as np
import pandas as pd

from stages.report.items import Table
from stages.report.results import NotRun, Results
from stages.report.style import label
from stages.stability.simplification import OUTCOMES, SMALLEST
from stages.stability.specimen import LARGEST_ERROR, RUIN

STAGE = "stability"
NOTES = [
    f"Cases by outcome: {' / '.join(OUTCOMES)}. Valid: a mesh came back whose count, kept vertices and faces, "
    "boundary, pieces and error are as they must be, with no fold, flat face, crowded edge or pinch more than before, "
    "asked of trimesh and numpy and not of the simplifier. Refused: an error said why. Ruined: a mesh came back that "
    "is not so.",
    f"The error is a ruin beyond {RUIN:g} times that of plain QEM of the sound object with as many faces as are free, "
    f"or {100 * LARGEST_ERROR:g} % of the diagonal.",
    "Least: the fewest faces asked for, nothing kept, from which on every object gave a valid mesh. Smallest had: of "
    "the face counts that a refusal names, those that could then be had. Why the worst case failed is in the CSV.",
]


def build(results: Results) -> Table:
    cases = simplified(results)
    groups = cases.groupby(["perturbation", "method"], sort=False)
    frame = pd.DataFrame([_line(*key, group) for key, group in groups])
    objects = ", ".join(dict.fromkeys(cases["item"]))
    notes = [*NOTES, f"Seconds to a valid mesh, mean over the cases: {_times(cases)}. Objects: {objects}."]
    return Table("Broken meshes, simplified", frame, notes, _wide(frame))


def simplified(results):
    """The rows about simplification, one per case; NotRun where there is none."""
    rows = results.measured(STAGE, metric="faces")
    if "outcome" not in rows:
        raise NotRun("stability simplified no broken mesh", STAGE)
    return rows


def least_valid(cases):
    """The fewest faces, nothing kept, from which on every object gave a valid mesh at every count; or NaN."""
    plain = cases[(cases["kept"] == "none") & cases["soft"].isna() & (cases["budget"] != SMALLEST)]
    counts = plain.groupby("budget")["severity"].max().sort_values(ascending=False)
    valid = plain["outcome"].eq("valid").groupby(plain["budget"]).all()[counts.index]
    return counts[valid.cummin()].min()


def _line(damage, backend, cases):
    counts = {outcome: int((cases["outcome"] == outcome).sum()) for outcome in OUTCOMES}
    had = cases.loc[cases["budget"] == SMALLEST, "outcome"] == "valid"
    bad = cases.loc[cases["outcome"].isin(OUTCOMES[1:]), ["outcome", "note"]].sort_values("outcome", ascending=False)
    return {
        "damage": damage, "backend": backend, **counts, "least": least_valid(cases),
        "smallest_named": len(had), "smallest_had": int(had.sum()), "seconds": cases["seconds"].median(),
        "worst": "" if bad.empty else bad["note"].iloc[0],
    }  # fmt: skip


def _wide(frame):
    lines = []
    for damage, group in frame.groupby("damage", sort=False):
        line = {"damage": label(damage)}
        for row in group.to_dict("records"):
            line[row["backend"]] = " / ".join(str(row[outcome]) for outcome in OUTCOMES)
            line[f"least, {row['backend']}"] = row["least"]
            line[f"smallest had, {row['backend']}"] = f"{row['smallest_had']} of {row['smallest_named']}"
        lines.append(line)
    total = {"damage": "all"}
    for backend, group in frame.groupby("backend", sort=False):
        total[backend] = " / ".join(str(group[outcome].sum()) for outcome in OUTCOMES)
        total[f"least, {backend}"] = np.nan
        total[f"smallest had, {backend}"] = f"{group['smallest_had'].sum()} of {group['smallest_named'].sum()}"
    return pd.DataFrame([*lines, total])


def _times(cases):
    """Mean seconds of each backend, and how many times those of the first, over the cases valid with all of them."""
    keys = ["item", "perturbation", "budget", "kept", "soft"]
    valid = cases[(cases["outcome"] == "valid") & (cases["budget"] != SMALLEST)].fillna({"soft": ""})
    means = valid.pivot_table(index=keys, columns="method", values="seconds", sort=False).dropna().mean()
    means = means[list(dict.fromkeys(cases["method"]))]
    return ", ".join(f"{label(name)} {mean:.4f} ({mean / means.iloc[0]:.2g} times)" for name, mean in means.items())
