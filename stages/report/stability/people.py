"""The cost of disturbances, one or two at once, for agreement with people's gaze and for the points found."""

import numpy as np
import pandas as pd

from haptic_glance.disturb.objects import PERTURBATIONS
from stages.charts.datasets import GAZED
from stages.charts.drawing import label
from stages.charts.items import Table
from stages.charts.results import Results, require_rows
from stages.charts.tables import (
    grouped,
    interval_columns,
    interval_text,
    percent,
    records,
    signed,
    with_interval,
)
from stages.engine.statistics import interval
from stages.stability.disturbance import AND
from stages.stability.simplification import middle_severity
from stages.stability.subject import UNPERTURBED

from .score import BENCHMARK, STAGE, of_gaze, points_lost, scores

REFERENCE = "glance"  # Itti's attention was not disturbed on these sets


def people_table(results: Results) -> Table:
    """A row a disturbance: per method the share of points found again, and the NSS and AUC that are lost."""
    sets = require_rows([name for name in GAZED if name in results.datasets(STAGE)], "no objects with gaze", STAGE)
    rows = pd.concat([results.measured(STAGE, name) for name in sets])
    plain = rows.loc[rows["perturbation"] == UNPERTURBED].set_index(["item", "method", "metric"])["value"]
    disturbed = rows.loc[rows["perturbation"] != UNPERTURBED]
    frame = pd.DataFrame([
        dict(zip(("perturbation", "severity", "method"), key, strict=True)) | _cell(case, plain)
        for key, case in grouped(disturbed, ["perturbation", "severity", "method"])
    ])  # fmt: skip
    methods = list(dict.fromkeys(frame["method"]))
    text_table = pd.DataFrame([_line(key, case, methods) for key, case in grouped(frame, ["perturbation", "severity"])])
    start = plain.xs("nss", level="metric").groupby("method").mean()
    items = {name: results.rows(STAGE, name)["item"].nunique() for name in sets}
    words = {
        "count": sum(items.values()), "meshes": items.get("gaze", 0), "clouds": items.get("gaze_clouds", 0),
        "undisturbed": ", ".join(f"{label(name)} {start[name]:.2f}" for name in methods), "score": _score(rows),
        "not_run": "\n".join(filter(None, (results.left_out(STAGE, name) for name in sets))),
    }  # fmt: skip
    return Table(frame, text_table, words)


def _score(rows: pd.DataFrame) -> str:
    """The mean corruption errors in AUC and what they have beyond the undisturbed error, in a sentence."""
    if REFERENCE not in set(rows["method"]):
        return ""
    table = scores(of_gaze(rows), REFERENCE)
    text = "; ".join(
        f"{label(row.method)} {interval_text(row, 'mce', 100, 0)} %, "
        f"relative {interval_text(row, 'relative', 100, 0)} %"
        for row in records(table[table["method"] != REFERENCE])
    )
    return (
        f"Mean corruption error of 1 - AUC, that of {label(REFERENCE)} being 100 %: {text}. Relative: of what is lost "
        "beyond the undisturbed error alone, where a disturbance costs the reference anything."
    )


def _cell(case, plain):
    """The numbers of one method under one disturbance: rows with item, method, metric, value."""
    wide = case.pivot(index="item", columns="metric", values="value")
    method = case["method"].iloc[0]
    shares = np.clip(interval(wide["repeatability"], statistic=np.median), 0, 1)
    numbers = interval_columns("again", shares) | {"chance": wide["chance"].mean()}
    for metric in ("nss", "auc"):
        losses = wide[metric] - plain.xs((method, metric), level=("method", "metric")).reindex(wide.index)
        numbers |= interval_columns(metric, interval(losses))
    return numbers | {"objects": len(wide)}


def _line(key, case, methods):
    perturbation, severity = key
    case = case.set_index("method")
    shares = case[["again", "again_low", "again_high"]]
    return {
        "disturbance": label(perturbation), "severity": f"{severity:g} {PERTURBATIONS[perturbation].unit}",
        **{f"{label(name)}, %": with_interval(*shares.loc[name], scale=100, places=0) for name in methods},
        "chance, %": f"{100 * case['chance'].mean():.0f}",
        **{f"{label(name)}, NSS": signed(*case.loc[name, ["nss", "nss_low", "nss_high"]]) for name in methods},
    }  # fmt: skip


OF_PAIRS = ("glance", "glance_any_pose", "itti", "mesh_saliency", "harris")  # the CSV has all


def pairs_table(results: Results) -> Table:
    """A row a pair and method: the share of points lost to each alone, to both, and to both less the sum."""
    rows = results.rows(STAGE, results.printed(BENCHMARK, STAGE), metric=["repeatability", "chance"])
    lost_shares = points_lost(rows)
    pairs = [name for name in dict.fromkeys(lost_shares["perturbation"]) if AND in name]
    pairs = require_rows(pairs, "no pairs of disturbances: stability.pairs is empty", STAGE, runnable=False)
    methods = [method for method in dict.fromkeys(lost_shares["method"]) if method != "random"]
    middle = middle_of(rows)
    frame = pd.DataFrame([
        {"pair": " and ".join(map(label, pair.split(AND))), "method": method}
        | compared(lost_shares[lost_shares["method"] == method], pair, middle)
        for pair in pairs
        for method in methods
    ])  # fmt: skip
    text_table = pd.DataFrame([
        {"disturbances": row.pair, "method": label(row.method),
         "first alone, %": percent(row.first), "second alone, %": percent(row.second),
         "both, %": percent(row.both),
         "both less the sum": signed(100 * row.beyond, 100 * row.beyond_low, 100 * row.beyond_high, 0),
         "is": verdict(row.beyond_low, row.beyond_high)}
        for row in records(frame[frame["method"].isin(OF_PAIRS)])
    ])  # fmt: skip
    words = [verdict(row.beyond_low, row.beyond_high) for row in records(frame)]
    word_counts = ", ".join(f"{words.count(word)} {word}" for word in ("milder", "additive", "worse"))
    return Table(frame, text_table, {"objects": rows["item"].nunique(), "counted": word_counts, "cases": len(words)})


def middle_of(rows: pd.DataFrame) -> dict[str, float]:
    """{perturbation: its middle severity}."""
    cases = rows.dropna(subset=["severity"]).drop_duplicates(["perturbation", "severity"])
    severities = cases.groupby("perturbation", sort=False)["severity"]
    return {str(name): middle_severity(list(values)) for name, values in severities}


def compared(lost: pd.DataFrame, pair: str, middle: dict[str, float]) -> dict[str, float]:
    """Means over the objects of one method: lost to `first`, `second` and `both`; `beyond` the sum, with its interval.

    lost: as of `points_lost`. The sum is at most 1, where all is lost. `independent`: both less what would be lost if
    what one leaves were lost to the other in the same share.
    """
    first, second = (
        lost[(lost["perturbation"] == name) & (lost["severity"] == middle[name])].set_index("item")["value"]
        for name in pair.split(AND)
    )
    joint = lost[lost["perturbation"] == pair].set_index("item")["value"]
    lost_shares = pd.concat({"first": first, "second": second, "both": joint}, axis=1, join="inner")
    beyond = interval(lost_shares["both"] - np.minimum(lost_shares["first"] + lost_shares["second"], 1))
    independent = lost_shares["both"] - 1 + (1 - lost_shares["first"]) * (1 - lost_shares["second"])
    numbers = {name: float(lost_shares[name].mean()) for name in ("first", "second", "both")}
    numbers |= interval_columns("beyond", beyond)
    return numbers | {"independent": float(independent.mean()), "objects": len(lost_shares)}


def verdict(low: float, high: float) -> str:
    """milder or worse than the sum, or additive where the interval covers 0 or there is none."""
    return "milder" if high < 0 else "worse" if low > 0 else "additive"
