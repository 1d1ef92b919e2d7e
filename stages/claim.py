"""Judges claims again from the rows that they rest on: `python -m stages.claim KEY ...`

KEY is the key of an entry of conf/claims/*.yaml, or a pattern such as 'glance_*'. Prints each claim with its verdict,
its effect beside the printed one, each reading with its own effect, the difference of each unit, the rows it was read
from, and the command that measures these rows anew. Works in a fresh clone, from the rows in reports/measurements.
Exits with 1 where a verdict, an effect or a number of units is not that of reports/claims.csv.

Examples: `python -m stages.claim glance_soft_gaze`, `python -m stages.claim 'glance_*' --json`.
"""

import argparse
import json
import math
import sys
from collections.abc import Sequence
from difflib import get_close_matches
from fnmatch import fnmatch
from pathlib import Path
from typing import Any

from haptic_glance.base.errors import errors_in_one_line
from haptic_glance.base.extras import from_extra
from haptic_glance.base.files import read_table

PUBLISHED = Path("reports")
COMPARED = ("verdict", "effect", "units")  # columns of claims.csv that rows at rest leave as they are
DIGITS = 1e-4  # relative: what a number loses in claims.csv


def run(argv: Sequence[str]) -> int:
    """Judges the claims that the command line names; 1 where what comes out is not what is committed."""
    parser = argparse.ArgumentParser(
        prog="python -m stages.claim", description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("keys", nargs="+", metavar="KEY", help="a key of conf/claims, or a pattern")
    parser.add_argument("--json", action="store_true", help="print one JSON object a claim")
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
        print(json.dumps(row) if options.json else as_text(row))
        if claim.key not in committed.index:
            changes.append(f"{claim.key}: not yet in reports/claims.csv; `make repro` adds it")
        elif moved := differing(row, committed.loc[claim.key].to_dict()):
            changes.append(f"{claim.key}: {moved}; `git checkout {' '.join(row['rows'])}` brings the judged rows back")
    print("\n".join(f"claim: {line}" for line in changes), file=sys.stderr, end="\n" if changes else "")
    return 1 if changes else 0


def chosen(claims: Sequence[Any], keys: Sequence[str]) -> list[Any]:
    """The claims that match the keys or patterns, in the order of the report; ValueError for a key without a claim."""
    names = [claim.key for claim in claims]
    for key in keys:
        if not any(fnmatch(name, key) for name in names):
            close = " or ".join(get_close_matches(key, names)) or "a key of conf/claims"
            raise ValueError(f"there is no claim {key}: try {close}")
    return [claim for claim in claims if any(fnmatch(claim.key, key) for key in keys)]


def differing(row: dict[str, Any], reference: dict[str, Any]) -> str:
    """`effect -110, in reports/claims.csv -103`: the COMPARED columns that are not the same; numbers to DIGITS."""
    moved = []
    for name in COMPARED:
        new, old = row.get(name, math.nan), reference.get(name, math.nan)
        if isinstance(new, str) or isinstance(old, str):
            same = new == old
        else:
            same = math.isclose(new, old, rel_tol=DIGITS) or (new != new and old != old)
        if not same:
            moved.append(f"{name} {new}, in reports/claims.csv {old}")
    return ", ".join(moved)


def judged_again(claim: Any, reports: Path = PUBLISHED) -> dict[str, Any]:
    """A claim's row of reports/claims.csv, made again, with `effects` of each set and reading, `rows` and `command`.

    reports: the folder with the measurements. Raises ClaimError, with the line of the entry, where rows, a metric or
    a column are not there.
    """
    from stages.charts.commands import command
    from stages.engine.measurements import Measurements, Missing
    from stages.report.claims import ClaimError
    from stages.report.verdict import judge_one, judgement

    measurements = Measurements(reports)
    effects, differences = {}, {}
    try:
        for effect in judgement(claim, measurements).effects:
            effects[effect.dataset] = [*effect.interval]
            differences |= {f"{effect.dataset}: {unit}": value for unit, value in effect.units.items()}
        for reading in claim.readings:
            judged = judgement(reading.of(claim), measurements)
            effects[reading.name] = [judged.word, *judged.interval]
    except Missing as missing:
        raise ClaimError(f"{claim.place}: {missing}") from missing
    row = judge_one(claim, measurements)
    row = {name: value for name, value in row.items() if value not in ("", None) and value == value}
    files = [measurements.path(*file) for file in claim.files()]
    row |= {"effects": effects, "differences": differences, "rows": [str(file) for file in files if file.exists()]}
    return row | {"command": command(Path("conf"), claim.stage, dict.fromkeys(name for _, name in claim.files()))}


def as_text(row: dict[str, Any]) -> str:
    """A claim as a person reads it, with a line for each reading and each unit."""
    lines = [f"{row['key']} ({row['section']}): {row['claim']}", f"  {row['verdict']}"]
    if "effect" in row:
        interval = f" [{row['low']:.3g}, {row['high']:.3g}]" if "low" in row else ""
        units = f"{row['pairs']} pairs, {row['units']} {row['over']}" if row.get("over") else "a single number"
        lines[1] += f": {row['effect']:+.3g}{interval} {row['unit']}, {units}"
    lines += [f"  {name}: {row[name]}" for name in ("printed", "size", "caveat") if name in row]
    for name, (*word, mean, low, high) in row["effects"].items():
        interval = "" if math.isnan(low) else f" [{low:.3g}, {high:.3g}]"
        lines.append(f"  {name}: {' '.join([*word, f'{mean:+.3g}{interval}'])}")
    lines += [f"    {pair:32} {value:+.4g}" for pair, value in row["differences"].items()]
    return "\n".join([*lines, *(f"  rows: {file}" for file in row["rows"]), f"  measure anew: {row['command']}", ""])


def main() -> None:
    """Judges the claims of the command line."""
    errors_in_one_line("claim")
    sys.exit(run(sys.argv[1:]))


if __name__ == "__main__":
    main()
