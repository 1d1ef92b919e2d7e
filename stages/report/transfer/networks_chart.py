"""Networks on imprints: accuracy against the seconds of training."""

import pandas as pd

from stages.kit.split import shared_by
from stages.report.grid import means
from stages.report.items import Figure
from stages.report.networks import FINE, measured
from stages.report.pareto import pareto_chart
from stages.report.results import Results
from stages.report.style import label, start

REFERENCE = "MobileNetV2, ImageNet, frozen"


def build(results: Results) -> Figure:
    """Accuracy on touches at random of each network, start and mode against its seconds."""
    rows = measured(results, data=FINE, split="random")
    frame = pd.DataFrame(means(rows, ["method", "weights", "mode"], shared_by("random"), top=1.0))
    frame = frame.dropna(subset=["seconds"])
    mode = frame["mode"].map(label).str.replace(r"^(\d+):(\d+)$", r"layers \1 to \2 frozen", regex=True)
    frame["name"] = frame["method"].map(label) + ", " + frame["weights"].map(start) + ", " + mode
    return pareto_chart(
        frame, "mean", title="From sight to touch: what training costs", reference=REFERENCE,
        quality_label="test accuracy, touches at random",
    )  # fmt: skip
