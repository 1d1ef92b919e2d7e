"""Networks on imprints: accuracy against the seconds of training."""

import pandas as pd

from haptic_glance.know.split import shared_by
from stages.report.drawing import label, start
from stages.report.items import Figure
from stages.report.networks import FINE, THEIRS, measured
from stages.report.pareto import pareto_chart
from stages.report.results import Results
from stages.report.tables import means
from stages.report.words import dataset_text

REFERENCE = "MobileNetV2, ImageNet, frozen"


def build(results: Results) -> Figure:
    """Accuracy on touches at random of each network, start and mode against its seconds, on the thesis's classes."""
    dataset = results.printed(THEIRS, "transfer")
    rows = measured(results, dataset, data=FINE, split="random")
    size = rows["size"].max()
    rows = rows[rows["size"] == size] if size == size else rows  # costs at other sizes are not comparable
    frame = pd.DataFrame(means(rows, ["method", "weights", "mode"], shared_by("random"), top=1.0))
    frame = frame.dropna(subset=["seconds"])
    frame["network"] = frame["method"].map(label) + frame["weights"].map(_beside)
    frame["way"] = frame["mode"].map(label).str.replace(r"^\d+:\d+$", "part of the layers frozen", regex=True)
    mode = frame["mode"].map(label).str.replace(r"^(\d+):(\d+)$", r"layers \1 to \2 frozen", regex=True)
    frame["name"] = frame["method"].map(label) + ", " + frame["weights"].map(start) + ", " + mode
    chart = pareto_chart(
        frame, "mean", title="From sight to touch: what training costs", reference=REFERENCE,
        quality_label="test accuracy, touches at random", colour="network", marker="way",
        legends={"way": "trained"}, clock=results.clock("transfer", dataset),
    )  # fmt: skip
    chart.words |= {
        "on": dataset_text(str(rows["dataset"].iloc[0])),
        "size": f"{size:.0f}",
        "splits": frame["values"].max(),
    }
    return chart


def _beside(weights: str) -> str:
    return "" if weights == "imagenet" else f", {start(weights)}"
