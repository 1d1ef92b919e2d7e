"""Broken meshes, tight budgets and unusual kept sets through every simplifier: valid, refused, ruined or crash.

`valid`: the simplifier returned a sound mesh (stages.stability.surface); `refused`: it raised an error that gives the
reason; `ruined`: it returned a mesh that is not sound, or another mesh on the second run; `crash`: any other error. The
summary for the gate has repeatability, breaking points and these outcomes.
"""

from __future__ import annotations

import traceback
import warnings
from collections import Counter
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import cast

import numpy as np

from haptic_glance.base.lazy import pandas as pd
from haptic_glance.base.timing import Stopwatch
from haptic_glance.disturb.objects import PERTURBATIONS
from haptic_glance.lod import simplify
from haptic_glance.lod.export import face_count
from haptic_glance.mesh.mesh import Mesh
from stages.engine.rows import unit
from stages.engine.statistics import breaking_interval, breaking_point
from stages.lod.cell import warm_up

from .broken import DAMAGES
from .surface import KEPT, RINGS, WEIGHTS, Case, QemErrorCurve, Specimen, find_faults, surface_error

OURS = [Path(__file__).parents[2] / package for package in ("haptic_glance", "stages")]
OUTCOMES = ("valid", "refused", "ruined", "crash")
BUDGETS = ("4", "16", "64", "256", "1024", "50%", "90%")
SMALLEST = "smallest"  # the budget that an InfeasibleTarget names, which must be feasible
REPEATED_BUDGETS = ("50%",)  # budgets at which a case is run twice and must give the same bytes
KEPT_ON, KEPT_BUDGETS = ("sound", "wide_holes", "fins", "soup", "everything"), ("256", "1024", "50%", "90%")
SOFT_ON, SOFT_BUDGETS = ("sound", "islands"), ("256", "50%")


@dataclass(frozen=True, eq=False)
class Result:
    """The result of a case.

    outcome: one of OUTCOMES; note: the reason; asked: the face count asked for; mesh: what was returned, or None;
    error: its mean error, and limit the largest one allowed, over the diagonal; smallest: the face count that a refusal
    names, 0 without.
    """

    outcome: str
    note: str
    asked: int
    seconds: float
    mesh: Mesh | None = None
    error: float = np.nan
    limit: float = np.nan
    smallest: int = 0


def run_case(specimen: Specimen, case: Case, backend: str, target: int | None = None) -> Result:
    """The result of a backend in a case; target: the face count where the case's budget is SMALLEST."""
    target = target or face_count(case.budget, len(specimen.mesh.faces))
    kept_ids, weights = specimen.kept(case), specimen.weights(case)

    def work():
        return simplify(specimen.mesh, target, kept_ids, RINGS, backend=backend, weights=weights)

    with warnings.catch_warnings(), Stopwatch() as watch:
        warnings.simplefilter("error", RuntimeWarning)
        try:
            simplified, problem = work(), None
        except Exception as error:  # any error is an outcome
            simplified, problem = None, error
    if simplified is None:
        return _no_mesh(problem, target, watch.seconds)
    frozen = specimen.kept_faces(kept_ids)
    limit, mean = specimen.limit(target, len(frozen)), surface_error(specimen.mesh, simplified)
    faults = find_faults(specimen.surface, simplified, target, kept_ids, frozen)
    if not mean <= limit:
        faults.append(f"mean error {mean:.2g} of the diagonal, more than the {limit:.2g} allowed")
    if case.budget in REPEATED_BUDGETS and not _same(simplified, work()):
        faults.append("another mesh on the second run")
    return Result("ruined" if faults else "valid", "; ".join(faults), target, watch.seconds, simplified, mean, limit)


def cases_for(damage: str) -> list[Case]:
    """The cases run on a damaged mesh."""
    cases = [Case(budget) for budget in BUDGETS]
    if damage in KEPT_ON:
        cases += [Case(budget, kept_set) for kept_set in list(KEPT)[1:] for budget in KEPT_BUDGETS]
    if damage in SOFT_ON:
        cases += [Case(budget, soft=soft) for soft in WEIGHTS for budget in SOFT_BUDGETS]
    return cases


def run_cases(specimen: Specimen, backend: str, cases: Iterable[Case]) -> Iterator[tuple[Case, Result]]:
    """Yields each Case with its Result.

    After the first refusal of a kept set that names a smallest face count, the case with that count follows.
    """
    refused = set()
    for case in cases:
        result = run_case(specimen, case, backend)
        yield case, result
        if result.smallest and (case.kept, case.soft) not in refused:
            refused.add((case.kept, case.soft))
            least = Case(SMALLEST, case.kept, case.soft)
            yield least, run_case(specimen, least, backend, result.smallest)


def simplification_rows(
    mesh: Mesh, name: str, seed: int, damages: Sequence[str] = tuple(DAMAGES),
    backends: Sequence[str] = ("fast", "pymeshlab"),
) -> list[dict]:  # fmt: skip
    """Rows of one object: `faces` of every case (0 without a mesh) and, where there is a mesh, its `error`."""
    curve, rows = QemErrorCurve(mesh), []
    for backend in backends:
        warm_up(backend)
    for damage in damages:
        specimen = Specimen(mesh, curve, damage, name, seed)
        for backend in backends:
            for case, result in run_cases(specimen, backend, cases_for(damage)):
                rows += _rows(name, damage, backend, case, result)
    return rows


def _rows(name, damage, backend, case, result):
    row = {
        "item": name, "method": backend, "perturbation": damage, "severity": result.asked, "budget": case.budget,
        "kept": case.kept, "soft": case.soft, "outcome": result.outcome, "limit": result.limit, "note": result.note,
        "seconds": result.seconds,
    }  # fmt: skip
    rows = [row | {"metric": "faces", "value": 0 if result.mesh is None else len(result.mesh.faces)}]
    return rows if result.mesh is None else [*rows, row | {"metric": "error", "value": result.error}]


def _no_mesh(error, target, seconds):
    """The Result without a mesh: a ValueError of this project with a reason is a refusal, all else a crash."""
    place, note = traceback.extract_tb(error.__traceback__)[-1], " ".join(str(error).split())
    if isinstance(error, ValueError) and any(map(Path(place.filename).is_relative_to, OURS)) and note:
        return Result("refused", note, target, seconds, smallest=getattr(error, "smallest", 0))
    return Result("crash", f"{type(error).__name__}: {note}", target, seconds)


def _same(first, second):
    return first.vertices.tobytes() == second.vertices.tobytes() and first.faces.tobytes() == second.faces.tobytes()


KEYS = ["perturbation", "method", "severity"]


def middle_severity(severities: Sequence[float]) -> float:
    """The severity in the middle of a list, the milder of two: harsh enough to separate the methods."""
    return severities[(len(severities) - 1) // 2]


def mean_repeatability(rows: Sequence[dict] | pd.DataFrame) -> pd.DataFrame:
    """Frame of perturbation, method, severity and value, the mean over the objects, in the order of the rows."""
    table = pd.DataFrame(rows)
    table = table.loc[table["metric"] == "repeatability", [*KEYS, "value"]].astype({"value": float})
    return table.groupby(KEYS, sort=False, as_index=False).mean()


def breaking_points(rows: pd.DataFrame) -> dict[tuple[str, str], tuple[float, float, float]]:
    """dict (perturbation, method) -> the severity at which the mean repeatability falls below one half, and its ends.

    The interval is over the units of the objects, see `breaking_interval`; NaN is beyond the harshest severity. Also
    NaN where a severity before it has no value at all.
    """
    points = {}
    for key, part in rows[rows["metric"] == "repeatability"].groupby(["perturbation", "method"], sort=False):
        perturbation, method = cast(tuple[str, str], key)
        wide = part.assign(unit=part["item"].map(unit)).pivot_table(
            index="unit", columns="severity", values="value", sort=False
        )
        severities = [severity for severity in dict.fromkeys(part["severity"]) if severity in wide.columns]
        if severities:
            curves = wide[severities].to_numpy()
            points[perturbation, method] = breaking_interval(severities, curves, PERTURBATIONS[perturbation].unharmed)
    return points


def summarise(rows: Sequence[dict]) -> dict[str, dict]:
    """Numbers for the gate: `repeatability`, of each PERTURBATION.METHOD at the middle severity; `breaking_point`."""
    means = {
        f"{perturbation}.{method}": values[severities.index(middle_severity(severities))]
        for perturbation, method, severities, values in _curves(rows)
    }
    breaks = {
        f"{perturbation}.{method}": breaking_point(severities, values, PERTURBATIONS[perturbation].unharmed)
        for perturbation, method, severities, values in _curves(rows)
    }
    return {"repeatability": _rounded(means), "breaking_point": _rounded(breaks)}


def summarise_simplification(rows: Sequence[dict]) -> dict[str, dict]:
    """Numbers for the gate, per backend: the share of its cases by outcome, and of the smallest counts that were met.

    Crashes are counted: none is allowed on any machine.
    """
    rows, shares = [row for row in rows if row["metric"] == "faces"], {}
    for backend in dict.fromkeys(row["method"] for row in rows):
        cases = [row for row in rows if row["method"] == backend]
        outcomes = Counter(row["outcome"] for row in cases)
        is_valid = [row["outcome"] == "valid" for row in cases if row["budget"] == SMALLEST]
        shares[backend] = {outcome: round(outcomes[outcome] / len(cases), 6) for outcome in OUTCOMES[:-1]}
        shares[backend]["smallest_had"] = round(sum(is_valid) / len(is_valid), 6) if is_valid else None
        shares[backend]["crashes"] = outcomes[OUTCOMES[-1]]
    return shares


def _curves(rows):
    """(perturbation, method, severities, mean repeatabilities) of each perturbation and method."""
    for key, group in mean_repeatability(rows).groupby(["perturbation", "method"], sort=False):
        perturbation, method = cast(tuple[str, str], key)
        yield perturbation, method, list(group["severity"]), list(group["value"])


def _rounded(values):
    """Values rounded to six digits; NaN (never broken, or never measured) becomes None, which the gate ignores."""
    return {key: round(value, 6) if np.isfinite(value) else None for key, value in values.items()}
