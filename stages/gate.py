"""Holds the metric files against their baselines: `python -m stages.gate [--update]`

Compares reports/metrics/*.json with reports/baselines/PROFILE.json ({metric: {value, low, high}}) of the profile that
params.yaml names; exits 1 and names what moved, by how much. --update writes the baseline from the metrics at hand.
"""

import argparse
import sys
from pathlib import Path

from stages.kit.files import read_json, write_json
from stages.kit.params import load_params
from stages.kit.run import METRICS, errors_in_one_line

BASELINES = Path("reports/baselines")
BAND = 0.15  # of a measured value: what another processor's rounding moves in simplification and training

MEASURED = ("lod.meshes", "lod.paired_cells")  # counts that follow from measured values: held like these
# Rates that may lie near zero, where a share of the value is no band: at least so much either way.
LEAST = {
    "stability.": 0.1, "salient_points.": 0.02, "touch_stability.": 0.1, "sequences.": 0.1, "sensor_size.": 0.05,
    "fixation.": 0.1, "transfer.": 0.1,
}  # fmt: skip
FREE = ("report.claims.",)  # a verdict flips where its interval just touches zero; the effects behind it are held
LISTED = 8  # new metrics that are named


def flatten(values, prefix=""):
    """{"a.b": number} of nested dicts; intervals (keys low and high) are left to the charts."""
    flat = {}
    for key, value in values.items():
        name = f"{prefix}.{key}" if prefix else key
        if isinstance(value, dict):
            flat |= flatten(value, name)
        elif isinstance(value, int | float) and key not in ("low", "high"):
            flat[name] = value
    return flat


def measured(folder=METRICS):
    """All metrics of a folder, flat, each under its file's name."""
    found = flatten({path.stem: read_json(path) for path in sorted(Path(folder).glob("*.json"))})
    return {name: value for name, value in found.items() if not name.startswith(FREE)}


def baseline(metrics):
    """Bounds about the metrics: counts exact, measured values within BAND or, near zero, LEAST."""
    bounds = {}
    for name, value in metrics.items():
        exact = isinstance(value, int) and name not in MEASURED
        least = next((band for prefix, band in LEAST.items() if name.startswith(prefix)), 0)
        reach = 0 if exact else max(BAND * abs(value), least)
        bounds[name] = {"value": value, "low": value - reach, "high": value + reach}
    return bounds


def compare(metrics, bounds):
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


def main():
    """Compares, or updates the baseline."""
    parser = argparse.ArgumentParser(
        prog="python -m stages.gate", description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--update", action="store_true", help="write the baseline from the metrics at hand")
    update = parser.parse_args().update
    errors_in_one_line("gate")
    path, metrics = BASELINES / f"{load_params().get('profile', 'laptop')}.json", measured()
    if update and not metrics:
        sys.exit(f"gate: no metrics in {METRICS}: run `dvc repro` first")
    if update:
        write_json(path, baseline(metrics))
        print(f"gate: {path} written from {len(metrics)} metrics")
        return
    if not path.exists():
        sys.exit(f"gate: no {path}; make it by `python -m stages.gate --update` after a run that you trust")
    bounds = read_json(path)
    moved = compare(metrics, bounds)
    new = sorted(set(metrics) - set(bounds))
    if new:
        more = f" and {len(new) - LISTED} more" if len(new) > LISTED else ""
        print(f"gate: not in the baseline yet: {', '.join(new[:LISTED])}{more}")
    if moved:
        sys.exit("\n".join([f"gate: {len(moved)} of {len(bounds)} metrics left their bounds in {path}", *moved]))
    print(f"gate: {len(bounds)} metrics within the bounds of {path}")


if __name__ == "__main__":
    main()
