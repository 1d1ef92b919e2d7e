"""T tables 4.7 and 4.8: the two networks, layer by layer, as printed and as they are here."""

from stages.report.items import Table
from stages.report.results import Results

from .rows import STAGE

SAID = {
    ("cnn_images", "conv1"): "kernel 5, 5, 5; padding 2, 2, 2; stride 2, 2, 5; 8 filters",
    ("cnn_images", "norm"): "batch normalisation",
    ("cnn_images", "conv2"): "kernel 5, 5, 3; padding 1, 1, 0; stride 1, 1, 1; tanh; 16 filters",
    ("cnn_images", "fc1"): "tanh; dropout 0.8",
    ("cnn_images", "fc2"): "tanh",
    ("cnn_images", "scores"): "softmax",
    ("cnn_normals", "conv1"): "kernel 1, 3, 5; ReLU; padding 0; stride 1; 32 filters",
    ("cnn_normals", "norm"): "batch normalisation",
    ("cnn_normals", "conv2"): "kernel 1, 3, 3; ReLU; padding 0; max pooling 1, 1, 0.2; dropout 0.5; 32 filters",
    ("cnn_normals", "fc1"): "ReLU; dropout 0.8",
    ("cnn_normals", "fc2"): "ReLU",
    ("cnn_normals", "scores"): "softmax",
}
NETWORKS = {"cnn_images": "3D, images (4.7)", "cnn_normals": "1D, normals (4.8)"}


def build(results: Results) -> Table:
    """The layers of both networks, without dropout, beside what the thesis prints of each."""
    rows = results.measured(STAGE, metric="parameters").query("kind != 'Dropout'").reset_index(drop=True)
    frame = rows.rename(columns={"classifier": "network", "value": "parameters"}).astype({"parameters": int})
    frame["thesis"] = [SAID.get(key, "") for key in zip(frame["network"], frame["layer"], strict=True)]
    frame = frame[["network", "layer", "thesis", "kind", "output", "parameters"]]
    shown = frame.assign(network=frame["network"].map(NETWORKS))
    shown = shown.rename(columns={"kind": "ours", "output": "output of ours"})
    totals = frame.groupby("network")["parameters"].sum()
    return Table(frame, shown, {name: totals[name] for name in NETWORKS})
