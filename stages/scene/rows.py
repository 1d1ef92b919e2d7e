"""Plans as rows of measurements, and the few numbers of a run that the gate checks."""

from collections.abc import Mapping, Sequence

import numpy as np

from haptic_glance.base.rng import rng
from haptic_glance.lod.scene.frames import Plan
from haptic_glance.lod.scene.level_renders import picture_error
from stages.engine.rows import named_means

from .compare import MethodPlan, SceneSetup

RESAMPLES = 2000
SAVED_AGAINST = ("uniform", "uniform_size", "network")
OF_OURS = (
    "error_worst",
    "step_worst",
    "salient_displacement",
    "ssim_error",
)  # metrics that the gate checks of ours alone
PRECISION = 1e-9  # of a tolerance: rounding of an error equal to it


def plan_rows(
    setup: SceneSetup, planned: MethodPlan, saliency: Mapping[str, np.ndarray | None], pictures: bool = True
) -> list[dict]:
    """Rows of one MethodPlan over all frames: faces, errors, jumps at switches, and the cost.

    saliency: dict name -> (n,) or None, for the displacement weighted by it. pictures: also 1 - SSIM.
    """
    plan, checks = planned.plan, planned.plan.checks
    spread = np.concatenate([check.displacements for check in checks])
    jumps = [jump for _, _, jump in plan.jumps]
    values = {
        "faces": float(plan.faces.sum(axis=1).mean()),
        "error": float(plan.errors.mean()), "error_worst": float(plan.errors.max()),
        "held": held(plan),
        "displacement_mean": _or_zero(np.mean, spread), "displacement_99.9": _or_zero(np.quantile, spread, 0.999),
        "salient_displacement": salient_displacement(setup, plan, saliency),
        "step_worst": max(jumps, default=0.0),
    }  # fmt: skip
    if planned.planning is not None:
        values["planning_ms"] = 1000 * planned.planning / len(plan.levels)  # processor time, of a frame
    if pictures:
        frames = range(len(plan.levels))
        values["ssim_error"] = float(
            np.mean([picture_error(setup.frames, frame, plan.shown(frame)) for frame in frames])
        )
    return [_row(setup, planned, "all", metric, value) for metric, value in values.items()]


def frame_rows(setup: SceneSetup, planned: MethodPlan) -> list[dict]:
    """Rows of each frame: faces and error."""
    faces, errors = planned.plan.faces.sum(axis=1), planned.plan.errors
    return [
        _row(setup, planned, frame, metric, value) | {"seconds": None}  # those of the plan are on its own rows
        for frame in range(len(errors))
        for metric, value in (("faces", int(faces[frame])), ("error", float(errors[frame])))
    ]


def saved_rows(setup: SceneSetup, ours: MethodPlan, others: Sequence[MethodPlan], seed: int) -> list[dict]:
    """Rows of the share of the faces that ours saves against others, with a 95 % interval over the objects."""
    rows, names = [], [placed.name for placed in setup.scene.objects]
    for other in others:
        if other.method in SAVED_AGAINST and other.matched not in ("", "asked"):
            value, low, high = saved(ours.plan.faces.sum(axis=0), other.plan.faces.sum(axis=0), names, seed)
            row = _row(setup, ours, "all", f"saved_{other.method}", value) | {"low": low, "high": high}
            rows.append(row | {"matched": other.matched, "seconds": None})
    return rows


def saved(ours: np.ndarray, others: np.ndarray, names: Sequence[str], seed: int = 0) -> tuple[float, float, float]:
    """(share, low, high): 1 - the sum of ours (o,) over that of the others, bootstrap over the objects.

    names: of the objects; copies of one shape are not independent, so they are drawn together (cluster bootstrap:
    Davison and Hinkley 1997, section 3.8). With one name alone the interval is NaN.
    """
    _, groups = np.unique(names, return_inverse=True)
    ours, others = (np.bincount(groups, weights=faces) for faces in (ours, others))
    share = float(1 - ours.sum() / max(others.sum(), 1))
    if len(ours) == 1:
        return share, np.nan, np.nan
    draws = rng(seed, "saved").integers(len(ours), size=(RESAMPLES, len(ours)))
    total = np.maximum(others[draws].sum(axis=1), 1)
    low, high = np.quantile(1 - ours[draws].sum(axis=1) / total, [0.025, 0.975])
    return share, float(low), float(high)


def held(plan: Plan) -> float:
    """Share of the frames within the tolerance."""
    return float((plan.errors <= plan.frames.scene.tolerance * (1 + PRECISION)).mean())


def salient_displacement(setup: SceneSetup, plan: Plan, saliency: Mapping[str, np.ndarray | None]) -> float | None:
    """Mean displacement in pixels over the full frames, weighted by the saliency there; None without any."""
    total, weight = 0.0, 0.0
    for frame in range(len(plan.levels)):
        for item, level in enumerate(plan.shown(frame)):
            values = saliency.get(setup.scene.objects[item].name)
            if values is not None:
                products, weights = setup.frames.weighted(frame, item, level, values)
                total, weight = total + products, weight + weights
    return total / weight if weight > 0 else None


def summary(rows: Sequence[dict]) -> dict[str, float]:
    """dict for the gate: faces, errors and frames within the tolerance of the main methods at the scene's tolerance."""
    rows = [row for row in rows if row.get("factor") == 1.0 and row["frame"] == "all" and row["value"] is not None]
    pairs = []
    for row in rows:
        method, matched, metric = row["method"], row["matched"], row["metric"]
        if metric in ("faces", "error", "held") and matched in ("", "error"):
            pairs.append((f"{metric}_{method}", row["value"]))
        if metric.startswith("saved_"):
            pairs.append((f"{metric}_{matched}", row["value"]))
        if (method, matched) == ("ours", "") and metric in OF_OURS:
            pairs.append((metric, row["value"]))
    return named_means(pairs)


def _row(setup, entry, frame, metric, value):
    return {
        "item": None, "method": entry.method, "kind": setup.scene.kind,
        "tolerance": setup.scene.tolerance, "matched": entry.matched, "frame": frame, "metric": metric, "value": value,
        "seconds": entry.seconds, "note": entry.note,
    }  # fmt: skip


def _or_zero(function, values, *more):
    return float(function(values, *more)) if len(values) else 0.0
