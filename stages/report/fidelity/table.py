"""The table of sections, formulas and protocols of the thesis, from data/reference/thesis/fidelity.csv."""

from stages.report.items import Table
from stages.report.results import NotRun, Results
from stages.report.words import dataset_text

PRINTED = "as printed"
RUNS = (PRINTED, "differs", "no data", "illustration")  # how a row is run; all but the first say what differs
HEADS = {"code": "in stages/", "run": "run as printed?", "sets": "on", "twin": "table or figure"}


def build(results: Results) -> Table:
    """One row each: where it is in the code, whether it runs as printed and on which set, and what differs."""
    if results.own_meshes:
        raise NotRun("the thesis is not about a folder of one's own", "report", runnable=False)
    frame = results.thesis("fidelity").fillna("")
    said = (frame["run"] + ": " + frame["differs"]).str.removesuffix(": ").replace(PRINTED, "yes")
    shown = frame.assign(run=said, sets=frame["sets"].map(dataset_text)).drop(columns="differs")
    counts = {str(name).replace(" ", "_"): count for name, count in frame["run"].value_counts().items()}
    return Table(frame, shown.rename(columns=HEADS), dict.fromkeys((run.replace(" ", "_") for run in RUNS), 0) | counts)
