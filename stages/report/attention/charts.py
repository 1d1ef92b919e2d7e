"""Agreement with gaze against the seconds of looking, of every method."""

from stages.report.costs import attention_seconds
from stages.report.items import Figure
from stages.report.pareto import pareto_chart
from stages.report.results import Results
from stages.report.style import label

from .rows import CLASSICAL, HUMAN, agreement, method_text, scores


def by_method(results: Results) -> Figure:
    """NSS on gaze against seconds, for every method."""
    rows = results.rows("salient_points", "gaze")
    frame = agreement(rows, ["nss"])
    frame = frame.loc[~frame["has_seen"] & (frame["method"] != HUMAN)]
    seconds = frame["method"].map(attention_seconds(results, "gaze"))
    frame = frame.assign(seconds=seconds, name=frame["method"].map(method_text)).dropna(subset=["seconds"])
    title, unit = "Predicting where people look", label(CLASSICAL)
    chart = pareto_chart(
        frame, "mean", title=title, reference=unit, quality_label="NSS on human gaze",
        clock=results.clock("salient_points", "gaze"), units=scores(rows, "nss").rename(columns=method_text),
    )  # fmt: skip
    chart.words["objects"] = frame["objects"].max()
    return chart
