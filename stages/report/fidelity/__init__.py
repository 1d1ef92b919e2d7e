"""How faithful the project is to the thesis: each section, formula, table and figure, and where it is done."""

import re

from stages.report.items import Table
from stages.report.results import NotRun, Results, dataset_text

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


FORMS = {
    "r": r"r = (-?[\d.]+)",  # a correlation
    "difference": r"difference < ([\d.e-]+)",  # the largest absolute one lies below
    "settings": r"(\d+) of (\d+) settings",
    "pixels": r"([\d.]+) pixels",
    "share": r"([\d.]+) % apart",
}
CORRELATION, DIFFERENCE = 0.99, 1e-3  # the least and the most of what is as printed
ROUNDING = 0.51  # of the last digit that is stated


def stated(text: str) -> tuple[str, list[float]]:
    """(kind, numbers) of a stated agreement; ValueError for another form."""
    for kind, form in FORMS.items():
        if match := re.fullmatch(form, text):
            return kind, [float(number) for number in match.groups()]
    raise ValueError(f"{text!r} is no agreement: write it as one of {', '.join(FORMS.values())}")


def is_printed(text: str) -> bool:
    """Whether a stated agreement is good enough for `as printed`."""
    kind, numbers = stated(text)
    if kind == "r":
        return numbers[0] >= CORRELATION
    if kind == "settings":
        return numbers[0] == numbers[1]
    return numbers[0] <= (DIFFERENCE if kind == "difference" else 0)


def matches(text: str, kind: str, measured: float | tuple[int, int]) -> bool:
    """Whether a stated agreement is what a test measures, within its last digit; a difference need only be below."""
    form, numbers = stated(text)
    if form != kind:
        return False
    if isinstance(measured, tuple):
        return numbers == list(measured)
    if kind == "difference":
        return measured < numbers[0]
    digits = re.search(r"\d+\.?(\d*)", text)
    return abs(measured - numbers[0]) <= ROUNDING * 10.0 ** -len(digits[1] if digits else "")


TABLES = {"fidelity": build}
FIGURES = {}
CHARTS = {}
CLAIMS = []
