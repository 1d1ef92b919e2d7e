"""Writes the report: tables beside the thesis's, claims, figures, charts of accuracy against cost, and the pages.

Reads reports/measurements/SET/STAGE.csv.gz, data/ and data/reference/thesis/*.csv. Writes reports/tables,
reports/figures, reports/tradeoff, reports/claims.md and .csv with the differences behind them in
reports/claims/differences.csv.gz, reports/index.html with reports/site, and reports/metrics/report.json. A table
without measurements is listed as not run, with the stage to run. Unchanged parts are reused from the last run, see
`reuse`.
"""

import shutil
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import partial
from itertools import product
from operator import call
from pathlib import Path
from typing import Any

import pandas as pd

from haptic_glance.base.files import replace_folder, write_json, write_table, write_text
from stages.engine.measurements import Measurements
from stages.engine.parallel import parallel_map
from stages.engine.settings import workspace_of_arguments

from . import Params
from .claims import load
from .claims_page import claims_shown
from .items import Built
from .page import part, viewer_or_reason
from .records import HEADLINES_FILE, PROVENANCE_FILE, write_headlines, write_records
from .results import NotRun, Results
from .reuse import VIEWER, built, keep, key_of, taken_again
from .site import write_own_page, write_site
from .tables import as_text, markdown_table
from .topics import KINDS, TOPICS, build_all, files_of, name_of
from .verdict import counted, counts, judged

OUTPUTS = ("tables", "figures", "tradeoff", "claims", "site", "claims.md", "claims.csv", "index.html", HEADLINES_FILE,
           PROVENANCE_FILE)  # fmt: skip
OWN_NOTE = "this page is about a folder alone; `python -m stages.compose` switches the project's own data sets on"


def main() -> None:
    """Writes the report of this repository root."""
    workspace = workspace_of_arguments(__doc__, "report")
    write_report(Results(workspace, workspace.settings(Params)))


def write_report(results: Results) -> None:
    """Builds everything, prints what could not be built, and moves the rest into place at the end."""
    with beside(results.reports, results.out) as out:
        metrics = build(results, out)
    write_json(results.reports / "metrics/report.json", metrics)
    print(f"report: open {results.reports / 'index.html'}")


@contextmanager
def beside(reports: Path, out: Path) -> Iterator[Path]:
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
    own_meshes = results.own_meshes
    items, (claims, differences), meshes = side_by_side(results)
    left = remove_older(items, out)
    write_records(items, results, out)
    not_run = {f"{kind}/{name}": reason for kind, batch in items.items() for name, reason in batch.not_run.items()}
    if own_meshes:  # what would need other data sets is left out
        claims = claims[claims["pairs"] > 0]
        not_run["what needs other data sets"] = OWN_NOTE
    write_claims(claims, differences, out)
    write_headlines(out, None if own_meshes else counts(claims))
    parts = {**items, "claims": claims, "differences": differences, "known": load(), "results": results}
    parts |= {"not_run": not_run, "sets": results.sets, "own": own_meshes}
    parts["meshes"] = None if isinstance(meshes, str) else meshes
    if isinstance(meshes, str) and not own_meshes:
        not_run["viewer"] = meshes
    parts |= {"first": ["pipeline"], "dataset": dataset_line(results)}
    pages = write_site(TOPICS, parts, out)
    if own_meshes:
        write_own_page(results, pages, out)
    totals = {kind: len(batch.items) for kind, batch in items.items()}
    reasons: dict[str, list[str]] = {}
    for name, reason in not_run.items():
        if name not in left:
            reasons.setdefault(reason, []).append(name)
    if left:
        names = ", ".join(f"{name} ({stage})" for name, stage in left.items())
        print(f"report: left as it was, since data/ lacks the stage in brackets (`dvc repro STAGE` redraws): {names}")
    for reason, names in reasons.items():
        print(f"report: not run, {reason}: {', '.join(names)}")
    print(
        f"report: {totals['tables']} tables, {totals['figures']} figures, {totals['tradeoff']} charts; claims: "
        f"{', '.join(f'{count} {word}' for word, count in counts(claims).items())}"
    )
    return {"claims": counts(claims), **totals, "not_run": len(not_run)}


def side_by_side(
    results: Results,
) -> tuple[dict[str, Built], tuple[pd.DataFrame, pd.DataFrame], dict[str, Any] | str]:
    """Builds the changed parts; returns {kind: its items}, the frames of `tabled` and the meshes of the viewer."""
    jobs: dict[tuple[str, str], Callable[[Results], Any]] = {}
    keys: dict[tuple[str, str], str] = {}
    for kind, topic in product(("figures", "tradeoff", "tables"), TOPICS):  # the longest first
        job = kind, name_of(topic)
        jobs[job] = partial(build_all, kind, topics=[topic])
        keys[job] = key_of(files_of(topic, kind), results)
    jobs["viewer", "page"], keys["viewer", "page"] = viewer_or_reason, key_of(VIEWER, results)
    parts = {job: taken_again("-".join(job), keys[job], results) for job in jobs}
    anew = [job for job, part in parts.items() if part is None]
    where = dict(results.workspace.parallel)
    if where.get("backend") == "dask":  # the files that a topic reads are here alone
        where["backend"] = "loky"
    work = [partial(built, jobs[job], results) for job in anew]
    for job, (content, file_digests) in zip(anew, parallel_map(call, work, "report", **where), strict=True):
        parts[job] = content
        keep("-".join(job), keys[job], content, file_digests, results)
    if len(anew) < len(jobs):
        print(f"report: {len(jobs) - len(anew)} of {len(jobs)} parts are those of the last run")
    items = {kind: Built() for kind in KINDS}
    for kind, total in items.items():
        for topic in TOPICS:
            total.items += parts[kind, name_of(topic)].items
            total.not_run |= parts[kind, name_of(topic)].not_run
            total.no_data |= parts[kind, name_of(topic)].no_data
    claims = judged(load(), Measurements(results.reports))
    return items, claims, parts["viewer", "page"]


def remove_older(built: dict[str, Built], out: Path) -> dict[str, str]:
    """Removes results of an earlier run that this run did not write, so that no old result looks new.

    Results that lack nothing but a folder of data/ stay: {KIND/NAME: the stage that writes the folder}.
    """
    left: dict[str, str] = {}
    for kind, batch in built.items():
        (out / kind).mkdir(parents=True, exist_ok=True)
        for path in sorted(set((out / kind).glob("*.*")).difference(*(item.paths for item in batch.items))):
            if path.stem in batch.no_data:
                left[f"{kind}/{path.stem}"] = batch.no_data[path.stem]
            else:
                path.unlink()
    return left


def write_claims(claims: pd.DataFrame, differences: pd.DataFrame, out: Path) -> None:
    """Writes claims.csv, claims.md and the differences behind the verdicts."""
    write_table(out / "claims.csv", claims)
    write_table(out / "claims/differences.csv.gz", differences)
    table = markdown_table(as_text(claims_shown(claims)))
    parts = (
        "# Claims of the thesis, tested",
        part("claims_note.md").strip(),
        counted(claims),
        table,
    )
    write_text(out / "claims.md", "\n\n".join(parts))


def dataset_line(results: Results) -> str:
    """How many objects of which data set, for the head of the page."""
    try:
        return f"{len(results.objects)} objects of the data set {results.folder('meshes').parent.name}"
    except NotRun:
        return "no objects yet"


if __name__ == "__main__":
    main()
