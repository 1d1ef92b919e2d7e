"""How faithful the project is to the thesis: each section, formula, table and figure, and where it is done."""

from stages.charts.datasets import dataset_text
from stages.charts.items import Table
from stages.charts.results import NotRun, Results

PRINTED = "as printed"
RUNS = (PRINTED, "differs", "no data", "not measured", "illustration")  # all but the first say what differs
HEADS = {"code": "in", "run": "run as printed?", "sets": "on", "twin": "table or figure", "test": "test"}


def build(results: Results) -> Table:
    """One row each: where it is in the code, whether it runs as printed, by which test and how well, what differs."""
    if results.own_meshes:
        raise NotRun("the thesis is not about a folder of one's own", "report", runnable=False)
    frame = results.thesis("fidelity").fillna("")
    answers = (frame["run"] + ": " + frame["differs"]).str.removesuffix(": ").replace(PRINTED, "yes")
    answers = answers.str.replace(r"\b(\w+_\w+)\b", r"`\1`", regex=True)  # names of files and columns
    files = {name: frame[name].map(lambda text: text and f"`{text}`") for name in ("code", "twin", "test")}
    text_table = frame.assign(run=answers, sets=frame["sets"].map(dataset_text), **files).drop(columns="differs")
    counts = {str(name).replace(" ", "_"): count for name, count in frame["run"].value_counts().items()}
    words = dict.fromkeys((run.replace(" ", "_") for run in RUNS), 0) | counts
    return Table(frame, text_table.rename(columns=HEADS), words)  # no ranking: sections do not compete


PAGE = "thesis"
TABLES = {"fidelity": build}
FIGURES = {}
CHARTS = {}
