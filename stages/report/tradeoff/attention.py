"""Where people look: agreement with gaze against the seconds of looking, for every method."""

from stages.report.costs import gaze_seconds
from stages.report.judged import CLASSICAL, HUMAN, agreement, spoken
from stages.report.pareto import pareto_chart
from stages.report.results import NotRun
from stages.report.style import label


def build(results):
    frame = agreement(results.attention("gaze"), ["nss"])
    frame = frame[~frame["has_seen"] & (frame["method"] != HUMAN)]
    frame = frame.assign(seconds=frame["method"].map(gaze_seconds(results)), name=frame["method"].map(spoken))
    frame = frame.dropna(subset=["seconds"])
    if CLASSICAL not in set(frame["method"]):
        raise NotRun(f"no cost of {CLASSICAL} on the meshes with gaze", "gaze", runnable=False)
    chart = pareto_chart(
        frame, "seconds", "mean", "name", name="attention", title="Predicting where people look",
        reference=label(CLASSICAL), quality_label="NSS on human gaze", folder=results.reports / "tradeoff",
    )  # fmt: skip
    chart.caption += (
        " Cost: twelve views, the maps of the method's channels and the points, of the median of "
        f"{frame['objects'].max()} meshes. What was learned has not seen the mesh that it is judged on. NSS 0: chance."
    )
    return chart
