"""Writes what the run found: tables beside the thesis's, claims, figures, charts of accuracy against cost, the page.

Reads reports/measurements/*.csv, data/ and data/reference/thesis/*.csv. Writes reports/tables, reports/figures,
reports/tradeoff, reports/claims.md and .csv, reports/index.html and reports/metrics/report.json. What lacks its
measurement is listed as not run, with the stage to run.
"""

from stages.kit import arguments, params
from stages.kit.files import write_json, write_table, write_text

from . import figures, tables, tradeoff
from .claims import CLAIMS
from .items import build_all
from .markdown import as_text, markdown_table
from .page import build_page, claims_shown
from .results import NotRun, Results
from .verdict import counted, judge
from .viewer import pack_viewer

CLAIMS_NOTE = """Each effect is a paired difference, positive on the side that the thesis claims, with its 95 %
interval. *supported*: the interval lies wholly on the claimed side; *contradicted*: wholly on the other; *open*: it
covers zero, is unknown (equal differences show no spread), or nothing was measured. Over objects it is a bootstrap
over the objects, and carries to other objects of this kind. Over repetitions it is a bootstrap over repeated splits
of the same imprints, widened for what they share (Nadeau and Bengio 2003): it is about these few objects alone.
Claims are judged one by one, without correction for their number. Section *ours*: what this project says of its own
model, and not the thesis."""


def main():
    arguments(__doc__)
    write_report(Results(params("report")))


def write_report(results):
    """Builds and writes everything, and prints what could not be."""
    out = results.reports
    built = {kind.__name__.rpartition(".")[2]: build_all(kind, results) for kind in (tables, figures, tradeoff)}
    not_run = {f"{kind}/{name}": why for kind, found in built.items() for name, why in found.not_run.items()}
    write_tables_and_tidy(built, out)
    claims = judge(CLAIMS, results)
    write_claims(claims, out)
    meshes = packed_or_none(results, not_run)
    parts = {**built, "claims": claims, "not_run": not_run}
    write_text(out / "index.html", build_page(out / "index.html", parts, meshes, dataset_line(results)))
    counts = {word: int((claims["verdict"] == word).sum()) for word in ("supported", "contradicted", "open")}
    made = {kind: len(found.items) for kind, found in built.items()}
    write_json(out / "metrics/report.json", {"claims": counts, **made, "not_run": len(not_run)})
    for name, why in not_run.items():
        print(f"report: {name} not run, {why}")
    print(
        f"report: {made['tables']} tables, {made['figures']} figures, {made['tradeoff']} charts; claims: "
        + ", ".join(f"{count} {word}" for word, count in counts.items())
        + f"; open {out / 'index.html'}"
    )


def write_tables_and_tidy(built, out):
    """Writes the tables, and removes results of an earlier run that this one did not make, so that none looks new."""
    written = {path for kind in ("figures", "tradeoff") for item in built[kind].items for path in item.paths}
    written |= {path for table in built["tables"].items for path in table.write(out / "tables")}
    for kind in built:
        (out / kind).mkdir(parents=True, exist_ok=True)
        for path in set((out / kind).glob("*.*")) - written:
            path.unlink()


def write_claims(claims, out):
    """Writes claims.csv and claims.md."""
    write_table(out / "claims.csv", claims)
    text = markdown_table(as_text(claims_shown(claims)))
    write_text(out / "claims.md", f"# Claims of the thesis, tested\n\n{CLAIMS_NOTE}\n\n{counted(claims)}\n\n{text}")


def packed_or_none(results, not_run):
    """The viewer's meshes, or None with the reason among what was not run."""
    try:
        return pack_viewer(results)
    except NotRun as missing:
        not_run["viewer"] = str(missing)
        return None


def dataset_line(results):
    """How many objects of which data set, for the head of the page."""
    try:
        known = results.measured_stages
        stage = "meshes" if "meshes" in known or not known else known[0]  # stages of classes have another data set
        return f"{len(results.objects)} objects of the data set {results.measurements(stage)['dataset'].iloc[0]}"
    except NotRun:
        return "no objects yet"


if __name__ == "__main__":
    main()
