"""Holds the metric files against their baselines: `python -m stages.gate [--update]`

Compares the metrics of the sets that params.yaml switches on, reports/metrics/SET/STAGE.json, and those of the report
with reports/baselines/PROFILE.json ({metric: {value, low, high}}) of its profile; exits 1 and names what moved, by how
much. --update writes the baseline from the metrics at hand.
"""

import argparse
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from stages.kit.command import errors_in_one_line
from stages.kit.files import read_json, write_json
from stages.kit.workspace import Workspace

Bounds = dict[str, dict[str, float]]
BAND = 0.15  # of a measured value: what another processor's rounding moves in simplification and training

MEASURED = ("lod.meshes", "lod.paired_cells")  # counts that follow from measured values: held like these
# By stage: rates that may lie near zero, where a share of the value is no band, have at least this much either way.
LEAST = {
    "stability.": 0.1, "salient_points.": 0.02, "touch_stability.": 0.1, "sensor_size.": 0.05, "fixation.": 0.1,
    "classification.": 0.1, "sequences.": 0.2, "transfer.hybrid.": 0.2, "transfer.": 0.1,
    # At smoke a map of sequences is tested with 18 of them, a hybrid with 60 touches after one training.
}  # fmt: skip
FREE = ("report.claims.",)  # a verdict flips where its interval just touches zero; the effects behind it are held
LISTED = 8  # new metrics that are named


def flatten(values: Mapping[str, Any], prefix: str = "") -> dict[str, float]:
    """{"a.b": number} of nested dicts; intervals (keys low and high) are left to the charts."""
    flat = {}
    for key, value in values.items():
        name = f"{prefix}.{key}" if prefix else key
        if isinstance(value, dict):
            flat |= flatten(value, name)
        elif isinstance(value, int | float) and key not in ("low", "high"):
            flat[name] = value
    return flat


def measured(workspace: Workspace) -> dict[str, float]:
    """All metrics of the report and of the switched-on sets, flat: SET.STAGE.NAME."""
    files = {"report": workspace.reports / "metrics/report.json"}
    for dataset, sections in ((name, workspace.params["graph"]) for name in workspace.sets):
        for stage, sets in sections.items():
            if dataset in sets:
                files[f"{dataset}.{stage}"] = workspace.on(dataset).metrics / f"{stage}.json"
    found = flatten({name: read_json(path) for name, path in files.items() if path.exists()})
    return {name: value for name, value in found.items() if not name.startswith(FREE)}


def of_stage(name: str) -> str:
    """A metric's name without the set: `lod.meshes` for `household.lod.meshes`."""
    return name.partition(".")[2]


def baseline(metrics: Mapping[str, float]) -> Bounds:
    """Bounds about the metrics: counts exact, measured values within BAND or, near zero, LEAST."""
    bounds = {}
    for name, value in metrics.items():
        exact = isinstance(value, int) and of_stage(name) not in MEASURED
        least = next((band for prefix, band in LEAST.items() if of_stage(name).startswith(prefix)), 0)
        band = 0 if exact else max(BAND * abs(value), least)
        bounds[name] = {"value": value, "low": value - band, "high": value + band}
    return bounds


def compare(metrics: Mapping[str, float], bounds: Bounds) -> list[str]:
    """Sentences on every metric that left its bounds or is missing; [] when all hold."""
    moved = []
    for name, bound in bounds.items():
        value = metrics.get(name)
        if value is None:
            moved.append(f"{name} is missing (baseline {bound['value']:g})")
        elif not bound["low"] <= value <= bound["high"]:
            change = value - bound["value"]
            moved.append(
                f"{name} moved by {change:+.4g} from {bound['value']:.4g} to {value:.4g},"
                f" outside {bound['low']:.4g} .. {bound['high']:.4g}"
            )
    return moved


def hold(workspace: Workspace, update: bool = False) -> str:
    """Compares or, with update, writes the baseline; what to say of it. SystemExit where a metric left its bounds."""
    path = workspace.reports / "baselines" / f"{workspace.params.get('profile', 'laptop')}.json"
    metrics = measured(workspace)
    if update and not metrics:
        raise SystemExit(f"gate: no metrics in {workspace.reports / 'metrics'}: run `dvc repro` first")
    if update:
        write_json(path, baseline(metrics))
        return f"gate: {path} written from {len(metrics)} metrics"
    if not path.exists():
        raise SystemExit(f"gate: no {path}; make it by `python -m stages.gate --update` after a run that you trust")
    bounds = read_json(path)
    moved = compare(metrics, bounds)
    if moved:
        raise SystemExit(
            "\n".join([f"gate: {len(moved)} of {len(bounds)} metrics left their bounds in {path}", *moved])
        )
    new = sorted(set(metrics) - set(bounds))
    more = f" and {len(new) - LISTED} more" if len(new) > LISTED else ""
    said = f"gate: {len(bounds)} metrics within the bounds of {path}"
    return f"{said}; not in the baseline yet: {', '.join(new[:LISTED])}{more}" if new else said


def main() -> None:
    """Compares, or updates the baseline."""
    parser = argparse.ArgumentParser(
        prog="python -m stages.gate", description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--update", action="store_true", help="write the baseline from the metrics at hand")
    update = parser.parse_args().update
    errors_in_one_line("gate")
    print(hold(Workspace(Path(".")), update))


if __name__ == "__main__":
    main()
