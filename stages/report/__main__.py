"""Writes the report: tables beside the thesis's, claims, figures, charts of accuracy against cost, and the pages.

Reads reports/measurements/SET/STAGE.csv.gz, data/ and data/reference/thesis/*.csv. Writes reports/tables,
reports/figures, reports/tradeoff, claims.md and .csv, thesis.md and .csv, reports/index.html with reports/site, and
reports/metrics/report.json. A table without measurements is listed as not run, with the command that measures it.

`python -m stages.report lod imprints` draws the parts of these stages alone, and leaves claims and pages as they are.
"""

import argparse
import shutil
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from functools import partial
from operator import call
from pathlib import Path
from typing import Any

import pandas as pd

from haptic_glance.base.errors import errors_in_one_line
from haptic_glance.base.files import replace_folder, write_json, write_table, write_text
from stages.charts.results import Results
from stages.engine.measurements import Measurements
from stages.engine.parallel import parallel_map
from stages.engine.settings import Workspace, check_clone, nearest

from . import Params
from .claims import load
from .claims_page import claims_text, counts
from .headlines import HEADLINES_FILE, write_headlines
from .own_page import write_own_page
from .parts import KINDS, PARTS, Built, build_part
from .site import write_site
from .thesis_page import thesis_frame, thesis_text
from .verdict import judge
from .viewer import viewer_or_reason

FOLDERS = (*KINDS, "site")
OUTPUTS = (*FOLDERS, "claims.md", "claims.csv", "thesis.md", "thesis.csv", "index.html", HEADLINES_FILE)
OWN_NOTE = "this page is about a folder alone; `python -m stages.compose` switches the project's own data sets on"


def main() -> None:
    """Writes the report of this repository root, or the parts of the stages that the command line names."""
    summary, _, details = (__doc__ or "").partition("\n")
    parser = argparse.ArgumentParser(
        prog="python -m stages.report",
        description=summary,
        epilog=details,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument(
        "stages", nargs="*", metavar="STAGE", help=f"of {', '.join(PARTS)}; without any, the whole report"
    )
    parser.add_argument("--root", type=Path, default=Path("."), help="the folder of params.yaml (default: this one)")
    errors_in_one_line("report")
    options = parser.parse_args()
    check_clone(options.root)
    for stage in options.stages:
        if stage not in PARTS:
            raise ValueError(f"no stage {stage} has a part in the report: {nearest(stage, list(PARTS))}")
    workspace = Workspace(options.root)
    results = Results(workspace, workspace.settings(Params))
    if options.stages:
        write_parts(results, options.stages)
    else:
        write_report(results)


def write_parts(results: Results, stages: Sequence[str]) -> None:
    """Draws the tables, figures and charts of some stages into the report; prints their files and what was not run."""
    results.out = results.reports
    for stage in stages:
        built = build_part(PARTS[stage], results)
        for item in built.items:
            print("\n".join(str(path) for path in item.paths))
        for name, reason in built.not_run.items():
            print(f"{name}: {reason}")


def write_report(results: Results) -> None:
    """Builds everything, prints what could not be built, and moves the rest into place at the end."""
    with write_then_swap(results.reports, results.out) as out:
        metrics = build(results, out)
    write_json(results.reports / "metrics/report.json", metrics)
    print(f"report: open {results.reports / 'index.html'}")


@contextmanager
def write_then_swap(reports: Path, out: Path) -> Iterator[Path]:
    """A copy of the report of an earlier run, for the update; it replaces the report if nothing failed.

    The copy holds figures of data sets whose data is no longer there.
    """
    shutil.rmtree(out, ignore_errors=True)
    out.mkdir(parents=True)
    for path in (reports / name for name in OUTPUTS):
        if path.is_dir():
            shutil.copytree(path, out / path.name)
        elif path.exists():
            shutil.copyfile(path, out / path.name)
    yield out
    reports.mkdir(parents=True, exist_ok=True)
    for path in (out / name for name in OUTPUTS):
        if path.is_dir():
            replace_folder(path, reports / path.name)
        else:
            shutil.move(path, reports / path.name)
    shutil.rmtree(out)


def build(results: Results, out: Path) -> dict[str, Any]:
    """Writes the report below `out`; returns its metrics."""
    built, claims, meshes = build_parallel(results)
    kept = remove_older(built, out)
    not_run = dict(built.not_run)
    if results.own_meshes:  # what would need other data sets is left out
        claims = claims[claims["pairs"] > 0]
        not_run["what needs other data sets"] = OWN_NOTE
    elif isinstance(meshes, str):
        not_run["viewer"] = meshes
    write_claims(claims, out)
    write_headlines(out, None if results.own_meshes else counts(claims))
    pages = write_site(results, built, not_run, claims, None if isinstance(meshes, str) else meshes, out)
    if results.own_meshes:
        write_own_page(results, pages, out)
    totals = {kind: sum(item.kind == kind for item in built.items) for kind in KINDS}
    print_summary(totals, {name: why for name, why in not_run.items() if name not in kept}, kept, counts(claims))
    return {"claims": counts(claims), **totals, "not_run": len(not_run)}


def build_parallel(results: Results) -> tuple[Built, pd.DataFrame, dict[str, Any] | str]:
    """Builds the parts of all stages, side by side: (their items, the frame of `judge`, the meshes of the viewer)."""
    where = dict(results.workspace.parallel)
    if where.get("backend") == "dask":  # the files that a part reads are here alone
        where["backend"] = "loky"
    jobs = [partial(judge, load(), Measurements(results.reports)), partial(viewer_or_reason, results)]
    jobs += [partial(build_part, part, results) for part in PARTS.values()]
    claims, meshes, *parts = parallel_map(call, jobs, "report", **where)
    return sum(parts, Built()), claims, meshes


def remove_older(built: Built, out: Path) -> dict[str, str]:
    """Removes results of an earlier run that this run did not write, so that no old result looks new.

    Results that lack nothing but a folder of data/ stay: {KIND/NAME: the stage that writes the folder}.
    """
    kept, written = {}, {path for item in built.items for path in item.paths}
    for kind in KINDS:
        (out / kind).mkdir(parents=True, exist_ok=True)
        for path in sorted((out / kind).glob("*.*")):
            name = f"{kind}/{path.stem}"
            if name in built.no_data:
                kept[name] = built.no_data[name]
            elif path not in written:
                path.unlink()
    return kept


def write_claims(claims: pd.DataFrame, out: Path) -> None:
    """Writes claims.csv and claims.md, and what became of the thesis: thesis.csv and thesis.md."""
    write_table(out / "claims.csv", claims)
    write_text(out / "claims.md", claims_text(claims))
    fates = thesis_frame(out)
    write_table(out / "thesis.csv", fates)
    write_text(out / "thesis.md", thesis_text(fates))


def print_summary(
    totals: dict[str, int], not_run: dict[str, str], kept: dict[str, str], verdicts: dict[str, int]
) -> None:
    """Prints what was built, what was left as it was, and what was not run, with the reasons."""
    if kept:
        names = ", ".join(f"{name} ({stage})" for name, stage in kept.items())
        print(f"report: left as it was, since data/ lacks the stage in brackets (`dvc repro STAGE` redraws): {names}")
    for reason in dict.fromkeys(not_run.values()):
        print(f"report: not run, {reason}: {', '.join(name for name, why in not_run.items() if why == reason)}")
    words = ", ".join(f"{count} {word}" for word, count in verdicts.items())
    print(
        f"report: {totals['tables']} tables, {totals['figures']} figures, {totals['tradeoff']} charts; claims: {words}"
    )


if __name__ == "__main__":
    main()
