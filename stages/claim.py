"""Judges claims again from the rows that they rest on: `python -m stages.claim KEY ...`

KEY is the key of an entry of conf/claims/*.yaml, or a pattern such as 'glance_*'. Prints each claim with its effect,
its interval, the difference of each pair, the rows it was read from, and the command that measures these rows anew.
Works in a fresh clone, from the rows in reports/measurements. Exits with 1 where a verdict, an effect or a number of
units is not that of reports/claims.csv; of rows measured anew, only where the verdict is not.

Examples: `python -m stages.claim glance_soft_gaze`, `python -m stages.claim 'glance_*' --json`,
`python -m stages.claim contrast --measure`.
"""

import argparse
import json
import math
import subprocess
import sys
from collections.abc import Sequence
from difflib import get_close_matches
from fnmatch import fnmatch
from pathlib import Path
from typing import Any

from haptic_glance.base.errors import errors_in_one_line
from haptic_glance.base.extras import from_extra
from haptic_glance.base.files import read_table
from stages.engine.rows import SUFFIX

PUBLISHED = Path("reports")
TEXTS = {"by_set": "on each set", "readings": "readings", "validity": "invalid", "of": "tests elsewhere"}
COMPARED = ("verdict", "effect", "units")  # columns of claims.csv that rows at rest leave as they are


def run(argv: Sequence[str]) -> int:
    """Judges the claims that the command line names; 1 where what comes out is not what is committed."""
    parser = argparse.ArgumentParser(
        prog="python -m stages.claim", description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("keys", nargs="+", metavar="KEY", help="a key of conf/claims, or a pattern")
    parser.add_argument("--json", action="store_true", help="print one JSON object a claim")
    parser.add_argument("--measure", action="store_true", help="measure its rows anew first, by `dvc repro`")
    options = parser.parse_args(argv)
    verdicts = PUBLISHED / "claims.csv"
    if not verdicts.exists():
        raise ValueError(f"no {verdicts}: run it in a clone of the project")
    with from_extra():
        from stages.report.claims import load
    committed = read_table(verdicts).set_index("key")
    changes = []
    for claim in chosen(load(), options.keys):
        row = judged_again(claim)
        if options.measure:
            row = judged_again(claim, measure(row["rows"]))
        print(json.dumps(row) if options.json else as_text(row))
        if claim.key not in committed.index:
            changes.append(f"{claim.key}: not yet in reports/claims.csv; `make repro` adds it")
            continue
        reference = committed.loc[claim.key].to_dict()
        if not agree(row, reference, COMPARED[:1] if options.measure else COMPARED):
            remedy = "" if options.measure else f": {restore(claim.stage, row['rows'])}"
            changes.append(f"{claim.key}: {in_short(row)}, in reports/claims.csv {in_short(reference)}{remedy}")
    print("\n".join(f"claim: {line}" for line in changes), file=sys.stderr, end="\n" if changes else "")
    return 1 if changes else 0


def agree(row: dict[str, Any], reference: dict[str, Any], columns: Sequence[str]) -> bool:
    """Whether two rows of claims.csv are the same in some columns; numbers to the digits that the file has."""
    cells = ((row.get(column, math.nan), reference.get(column, math.nan)) for column in columns)
    return all(
        math.isclose(first, second, rel_tol=1e-4) or (first != first and second != second)
        if isinstance(first, int | float) and isinstance(second, int | float)
        else first == second
        for first, second in cells
    )


def in_short(row: dict[str, Any]) -> str:
    """`contradicted (-110, 17 units)`: a row of claims.csv in a few words."""
    effect, tested = row.get("effect", math.nan), str(row.get("tested_on"))
    numbers = f" ({effect:.3g}, {row['units']:.0f} units)" if effect == effect else ""
    return row["verdict"] + (f" ({tested})" if tested.startswith("not run") else numbers)


def restore(stage: str, rows: Sequence[str]) -> str:
    """How to bring back the rows of a stage: of the files that git finds missing or changed, else of those read."""
    command = ["git", "ls-files", "--modified", "--", f"{PUBLISHED}/measurements/*/{stage}{SUFFIX}"]
    try:
        paths = subprocess.run(command, capture_output=True, text=True).stdout.split()
    except OSError:  # no git
        paths = []
    files = paths or list(rows)
    words = [f"{file} is {'changed' if Path(file).exists() else 'missing'}" for file in paths]
    return f"{', '.join(words) or 'the rows are not those judged'}; `git checkout {' '.join(files)}` brings them back"


def chosen(claims: Sequence[Any], keys: Sequence[str]) -> list[Any]:
    """The claims that match the keys or patterns, in the order of the report; ValueError for a key without a claim."""
    names = [claim.key for claim in claims]
    for key in keys:
        if not any(fnmatch(name, key) for name in names):
            close = " or ".join(get_close_matches(key, names)) or "a key of conf/claims"
            raise ValueError(f"there is no claim {key}: try {close}")
    return [claim for claim in claims if any(fnmatch(claim.key, key) for key in keys)]


def judged_again(claim: Any, reports: Path = PUBLISHED) -> dict[str, Any]:
    """A claim's row of reports/claims.csv, made again, with `differences` ({pair: value}), `rows` and `command`.

    reports: the folder with the measurements. Raises ClaimError for an entry that names a metric, column or statistic
    that there is not.
    """
    from stages.charts.commands import command
    from stages.engine.measurements import Measurements
    from stages.report.effects import check
    from stages.report.verdict import judge_one

    measurements = Measurements(reports)
    files = [measurements.path(claim.stage, name) for name in claim.sets_read()]
    if all(file.exists() for file in files):
        check(claim, measurements)
    row, pairs = judge_one(claim, measurements)
    return {
        **{name: value for name, value in row.items() if value not in ("", None) and value == value},
        "differences": {pair: value for _, pair, value, _ in pairs},
        "rows": [file.as_posix() for file in files if file.exists()],
        "command": command(Path("conf"), claim.stage, claim.sets_read()),
    }


def as_text(row: dict[str, Any]) -> str:
    """A claim as a person reads it, with a line for each pair."""
    lines = [f"{row['key']} ({row['section']}): {row['claim']}", f"  {row['verdict']}"]
    if "effect" in row:
        interval = f" [{row['low']:.3g}, {row['high']:.3g}]" if "low" in row else ""
        lines[1] += (
            f": {row['effect']:+.3g}{interval} {row['unit']}, {row['pairs']} {row['over']}, {row['units']} units"
        )
        lines += as_share(row)
    lines.append(f"  tested on: {row['tested_on']}")
    lines += [f"  {words}: {row[name]}" for name, words in TEXTS.items() if name in row]
    lines += [f"    {pair:32} {value:+.4g}" for pair, value in row["differences"].items()]
    lines += [f"  rows: {file}" for file in row["rows"]]
    return "\n".join([*lines, f"  measure anew: {row['command']}", ""])


def as_share(row: dict[str, Any]) -> list[str]:
    """A line with an effect in % of the mean of both as README.md and the pages state it: % less, or times as much."""
    if not row["unit"].startswith("% of the mean of both") or "low" not in row:
        return []
    less = row["effect"] > 0
    effect, *ends = ((200 * value if less else 200 - value) / (200 + value)
                     for value in (row["effect"], row["low"], row["high"]))  # fmt: skip
    low, high = sorted(ends)
    words = "% less than the first" if less else "times the first"
    return [f"  as a share: the second is {effect:.3g} [{low:.3g}, {high:.3g}] {words}"]


def measure(rows: Sequence[str]) -> Path:
    """Runs the stages that make the rows, and returns the folder of the reports of the run that params.yaml describes.

    ValueError where a set is not switched on, or a stage fails.
    """
    from stages.engine.settings import Workspace

    workspace = Workspace(Path("."))
    for file in rows:
        dataset, stage = Path(file).parent.name, Path(file).name.removesuffix(SUFFIX)
        if dataset not in workspace.params["graph"].get(stage, {}):
            raise ValueError(f"{stage} is not switched on for {dataset}: `python -m stages.compose 'sets=[{dataset}]'`")
        if subprocess.run([sys.executable, "-m", "dvc", "repro", f"{stage}@{dataset}"]).returncode:
            raise ValueError(f"dvc repro {stage}@{dataset} failed, as said above; the rows stay as they were")
    return workspace.reports


def main() -> None:
    """Judges the claims of the command line."""
    errors_in_one_line("claim")
    sys.exit(run(sys.argv[1:]))


if __name__ == "__main__":
    main()
