"""Scores of methods by stability: the mean corruption error (mCE), a ratio to Itti's attention, the reference.

The error is the share of the points that are not found again, corrected for chance; `of_gaze` takes 1 - AUC instead.
The leaderboard has the score, breaking points, accuracy on gaze and seconds of each method. Reference: Hendrycks and
Dietterich, Benchmarking neural network robustness to common corruptions and perturbations, ICLR 2019.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
import pandas as pd

from haptic_glance.disturb.objects import PERTURBATIONS
from stages.charts.drawing import label
from stages.charts.items import Figure, Table
from stages.charts.pareto import attention_seconds, pareto_chart
from stages.charts.results import NotRun, Results, require_rows
from stages.charts.tables import interval_columns, interval_text, number, percent, records, with_interval
from stages.engine.rows import unit
from stages.engine.statistics import expanded_levels, interval, resampled_means, resamples
from stages.stability.simplification import breaking_points
from stages.stability.subject import UNPERTURBED

from .breaking import cell

STAGE = "stability"
BENCHMARK = "household_stability"
REFERENCE = "itti"
KEYS = ["item", "method", "perturbation", "severity"]
LEAST = 0.02  # a disturbance that costs the reference less than this is no unit to measure by
KINDS = {  # the disturbances that score, by what they change
    "surface": ("noise", "decimation", "remeshing", "missing_faces", "scan"),
    "pose": ("turn", "tilt"),
    "picture": ("light", "pattern", "image_size"),
}


@dataclass(frozen=True, eq=False)
class Errors:
    """values (n, m, k): of each object, method and case; cases: (perturbation, severity) of each k, mild to harsh.

    clean (n, m): the errors on the undisturbed objects.
    """

    objects: list[str]
    methods: list[str]
    cases: list[tuple[str, float]]
    values: np.ndarray
    clean: np.ndarray

    @property
    def perturbations(self) -> list[str]:
        """Their names, in order."""
        return list(dict.fromkeys(name for name, _ in self.cases))

    @property
    def severities(self) -> np.ndarray:
        """(p,): how many cases each perturbation has."""
        return np.array([sum(name == perturbation for name, _ in self.cases) for perturbation in self.perturbations])

    @property
    def beyond_clean(self) -> "Errors":
        """The Errors less those on the undisturbed objects."""
        return replace(self, values=self.values - self.clean[:, :, None], clean=np.zeros_like(self.clean))

    def counting(self, reference: str) -> np.ndarray:
        """(p,) boolean: whether a perturbation costs the reference LEAST a case, or more: 0 / 0 says nothing.

        NotRun without the reference.
        """
        if reference not in self.methods:
            message = f"{reference}, the reference of the score, is not among stability.methods"
            raise NotRun(message, STAGE, runnable=False)
        sums = self.by_perturbation(self.means(np.ones((1, len(self.objects)))))[0, self.methods.index(reference)]
        return sums > LEAST * self.severities

    def means(self, counts: np.ndarray) -> np.ndarray:
        """(r, m, k): the means over the objects that counts (r, n) name."""
        n, m, k = self.values.shape
        return resampled_means(self.values.reshape(n, m * k), counts).reshape(len(counts), m, k)

    def by_perturbation(self, means: np.ndarray) -> np.ndarray:
        """(r, m, p): means (r, m, k) summed over the severities of each perturbation."""
        return np.stack([means[..., [name == perturbation for name, _ in self.cases]].sum(axis=-1)
                         for perturbation in self.perturbations], axis=-1)  # fmt: skip


def points_lost(rows: pd.DataFrame) -> pd.DataFrame:
    """A frame of item, method, perturbation, severity and value: 1 - repeatability, 1 at the level of chance.

    Rows of a pair have no severity. What could not be disturbed is left out.
    """
    rows = rows[rows["metric"].isin(["repeatability", "chance"])].dropna(subset=["value"])
    wide = rows.set_index([*KEYS, "metric"])["value"].unstack("metric").reset_index()
    return wide[KEYS].assign(value=1 - (wide["repeatability"] - wide["chance"]) / (1 - wide["chance"]))


def of_points(rows: pd.DataFrame) -> Errors:
    """The Errors of the points: `points_lost`. On the undisturbed object every method finds its own points again."""
    return _gathered(points_lost(rows), rows)


def of_gaze(rows: pd.DataFrame) -> Errors:
    """The Errors of the agreement with gaze: 1 - AUC."""
    rows = rows[rows["metric"] == "auc"].dropna(subset=["value"])
    return _gathered(rows[KEYS].assign(value=1 - rows["value"]), rows)


def _gathered(errors: pd.DataFrame, rows: pd.DataFrame) -> Errors:
    """The Errors of the single perturbations that belong to a kind; copies of a shape are one object."""
    errors = errors.assign(item=errors["item"].map(unit)).groupby(KEYS, sort=False, dropna=False, as_index=False).mean()
    members = [name for names in KINDS.values() for name in names]
    cases = rows.loc[rows["perturbation"].isin(members), ["perturbation", "severity"]].drop_duplicates()
    cases = sorted(cases.itertuples(index=False, name=None), key=lambda case: members.index(case[0]))
    require_rows(cases, "no disturbed points", STAGE)
    pairs = list(zip(errors["perturbation"], errors["severity"], strict=True))
    errors = errors.assign(case=pd.Series(pairs, index=errors.index, dtype=object))
    disturbed, clean = (errors[errors["perturbation"].isin(names)] for names in (members, [UNPERTURBED]))
    objects, methods = (sorted(set(disturbed["item"])), list(dict.fromkeys(rows["method"])))
    values = _filled(disturbed, ["item", "method", "case"], (objects, methods, cases))
    start = np.zeros(values.shape[:2]) if clean.empty else _filled(clean, ["item", "method"], (objects, methods))
    return Errors(objects, methods, cases, values, start)


def _filled(frame: pd.DataFrame, columns: Sequence[str], names: Sequence[Sequence]) -> np.ndarray:
    """The values of a frame by the places of its columns among the names, NaN where there is none."""
    values = np.full([len(part) for part in names], np.nan)
    places = [{name: place for place, name in enumerate(part)} for part in names]
    for *key, value in frame[[*columns, "value"]].itertuples(index=False, name=None):
        values[tuple(index[part] for index, part in zip(places, key, strict=True))] = value
    return values


def corruption_errors(errors: Errors, reference: str, counts: np.ndarray) -> tuple[np.ndarray, list[str]]:
    """((r, m, p) errors under each perturbation over those of the reference, the p perturbations that count).

    Errors are means over the objects that counts (r, n) name, summed over the severities.
    """
    ids = np.flatnonzero(errors.counting(reference))
    summed, column = errors.by_perturbation(errors.means(counts))[..., ids], errors.methods.index(reference)
    return summed / summed[:, column : column + 1], [errors.perturbations[place] for place in ids]


def scores(errors: Errors, reference: str = REFERENCE, seed: int = 0) -> pd.DataFrame:
    """A row a method: `mce`, the mean over the perturbations of its corruption errors, and that of each of KINDS.

    `relative`: the same of what is lost beyond the undisturbed error. `found`: the share found again beyond chance, the
    mean over the perturbations. Intervals (`_low`, `_high`) are over the objects, resampled for all methods at once, so
    that they are paired: that of the reference is [1, 1]. One object gives none.
    """
    count = len(errors.objects)
    whole, draws = np.ones((1, count)), resamples(count, seed)
    ce, names = corruption_errors(errors, reference, whole)
    require_rows(names, f"nothing disturbs {reference}", STAGE, runnable=False)
    samples = corruption_errors(errors, reference, draws)[0]
    frame = pd.DataFrame({"method": errors.methods, **_with_ends("mce", ce.mean(axis=2), samples.mean(axis=2), count)})
    for kind, members in KINDS.items():
        places = [place for place, name in enumerate(names) if name in members]
        frame[kind] = ce[0][:, places].mean(axis=1) if places else np.nan
    beyond = errors.beyond_clean
    excess, excess_samples = (corruption_errors(beyond, reference, counts)[0].mean(axis=2) for counts in (whole, draws))
    shares = [1 - errors.by_perturbation(errors.means(counts)) / errors.severities for counts in (whole, draws)]
    columns = _with_ends("found", shares[0].mean(axis=2), shares[1].mean(axis=2), count)
    return frame.assign(**_with_ends("relative", excess, excess_samples, count), **columns)


def _with_ends(name, at, drawn, count):
    """{name and its ends}: at (1, m) and drawn (r, m), of `count` objects."""
    levels = expanded_levels(count) if count > 1 else (np.nan, np.nan)
    ends = np.quantile(drawn, levels, axis=0) if count > 1 else np.full((2, drawn.shape[1]), np.nan)
    return interval_columns(name, (at[0], *ends))


GAZE = "gaze"  # the set that tells accuracy and seconds
CHANCE = "random"
PROTOCOL = (  # conf/stability/benchmark.yaml
    "Smaller than the thesis: pictures of a fourth of the rows, two or three severities, three draws of what is "
    "random. Left out, since they are the slowest: regions of interest, spectral and cluster-based saliency. Copies of "
    "a primitive at other sizes count once."
)
BANDS = {0.3: "under 0.3", 0.6: "0.3 to 0.6", 1.2: "0.6 to 1.2", np.inf: "above 1.2"}  # NSS on gaze, for the chart


def table(results: Results) -> Table:
    """A row a method, the most stable first."""
    rows, frame, errors = _scored(results)
    frame = frame.merge(_accuracy(results), on="method", how="left").sort_values("mce")
    text_table = pd.DataFrame([
        {
            "method": label(row.method),
            "mCE, %": interval_text(row, "mce", 100, 0),
            **{f"{kind}, %": percent(getattr(row, kind)) for kind in KINDS},
            "found again, %": interval_text(row, "found", 100, 0),
            "NSS on gaze": number(row.nss, 2) if np.isfinite(row.nss) else "–",
            "seconds": number(row.seconds, 2) if np.isfinite(row.seconds) else "–",
        }
        for row in records(frame)
    ])  # fmt: skip
    return Table(frame, text_table, _words(results, rows, errors))


def breaking(results: Results) -> Table:
    """A row a method, a column a disturbance: the severity at which half of the points are lost."""
    rows, frame, errors = _scored(results)
    rows = rows[rows["perturbation"].isin(errors.perturbations)]
    points = pd.DataFrame([
        {"method": method, "perturbation": name, "unit": PERTURBATIONS[name].unit,
         "harshest": [severity for perturbation, severity in errors.cases if perturbation == name][-1],
         **interval_columns("breaking_point", ends, prefix="")}
        for (name, method), ends in breaking_points(rows[rows["method"] != CHANCE]).items()
    ])  # fmt: skip
    points["text"] = [cell(row, PERTURBATIONS[row.perturbation].unharmed) for row in records(points)]
    order = [name for name in frame.sort_values("mce")["method"] if name != CHANCE]
    wide = points.pivot(index="method", columns="perturbation", values="text").loc[order, errors.perturbations]
    text_table = wide.rename(index=label, columns=label).rename_axis(columns=None).reset_index()
    units = "; ".join(f"{label(name)}: {PERTURBATIONS[name].unit}" for name in errors.perturbations)
    return Table(points.drop(columns="text"), text_table, _words(results, rows, errors) | {"units": units})


def chart(results: Results) -> Figure:
    """The share of points found again against the seconds of a look, coloured by the agreement with gaze."""
    _, frame, errors = _scored(results)
    frame = frame[frame["method"] != CHANCE].merge(_accuracy(results), on="method").dropna(subset=["seconds"])
    require_rows(frame, f"no seconds of a look on {GAZE}", "salient_points", runnable=False)
    frame = frame.assign(name=frame["method"].map(label), low=frame["found_low"], high=frame["found_high"])
    frame["band"] = [next(text for top, text in BANDS.items() if nss < top) for nss in frame["nss"].fillna(0)]
    frame = frame.sort_values("nss", ascending=False)
    for end in ("found", "low", "high"):
        frame[end] *= 100
    figure = pareto_chart(
        frame, "found", title="Stability against the cost of a look", reference=label(REFERENCE),
        quality_label="points found again beyond chance, %", colour="band", legends={"band": "NSS on gaze"},
        clock=results.clock("salient_points", GAZE),
    )  # fmt: skip
    sharp = frame[frame["band"] == frame["band"].iloc[0]].sort_values("found", ascending=False).iloc[0]
    best = f"{sharp['name']}, {with_interval(sharp['found'], sharp['low'], sharp['high'], places=0)} %"
    figure.words |= {"objects": len(errors.objects), "band": sharp["band"], "sharp": best}
    return figure


def _scored(results: Results) -> tuple[pd.DataFrame, pd.DataFrame, Errors]:
    """(rows of the benchmark or else of the first set, `scores`, the Errors)."""
    rows = results.rows(STAGE, results.printed(BENCHMARK, STAGE), metric=["repeatability", "chance"])
    errors = of_points(rows)
    return rows, scores(errors), errors


def _accuracy(results: Results) -> pd.DataFrame:
    """The NSS of each method on the meshes with gaze, with its interval, and the seconds of a look; empty without."""
    if not results.printed(GAZE, "salient_points"):
        return pd.DataFrame(columns=["method", "nss", "seconds"]).astype({"nss": float, "seconds": float})
    rows = results.measured("salient_points", GAZE, metric="nss")
    seconds = attention_seconds(results, GAZE)
    groups = rows.groupby("method")["value"]
    frame = pd.DataFrame([interval_columns("nss", interval(values)) | {"method": name} for name, values in groups])
    return frame.assign(seconds=frame["method"].map(seconds))


def _words(results: Results, rows: pd.DataFrame, errors: Errors) -> dict[str, object]:
    names, counting = np.array([label(name) for name in errors.perturbations]), errors.counting(REFERENCE)
    dropped = ", ".join(names[~counting])
    return {
        "objects": len(errors.objects), "methods": len(errors.methods), "reference": label(REFERENCE),
        "perturbations": ", ".join(names[counting]),
        "protocol": PROTOCOL if rows["dataset"].iloc[0] == BENCHMARK else "",
        "left_out": f"Without {dropped}, which cost the reference nothing." if dropped else "",
        "not_run": results.left_out(STAGE, rows["dataset"].iloc[0]),
    }  # fmt: skip
