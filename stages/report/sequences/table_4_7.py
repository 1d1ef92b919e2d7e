"""T tables 4.7 and 4.8: the two networks, layer by layer, as printed and as they are here."""

from stages.report.items import Table

SAID = {
    ("images", "conv1"): "kernel 5, 5, 5; padding 2, 2, 2; stride 2, 2, 5; 8 filters",
    ("images", "norm"): "batch normalisation",
    ("images", "conv2"): "kernel 5, 5, 3; padding 1, 1, 0; stride 1, 1, 1; tanh; 16 filters",
    ("images", "fc1"): "tanh; dropout 0.8",
    ("images", "fc2"): "tanh",
    ("images", "scores"): "softmax",
    ("normals", "conv1"): "kernel 1, 3, 5; ReLU; padding 0; stride 1; 32 filters",
    ("normals", "norm"): "batch normalisation",
    ("normals", "conv2"): "kernel 1, 3, 3; ReLU; padding 0; max pooling 1, 1, 0.2; dropout 0.5; 32 filters",
    ("normals", "fc1"): "ReLU; dropout 0.8",
    ("normals", "fc2"): "ReLU",
    ("normals", "scores"): "softmax",
}
NETWORKS = {"images": "3D, images (4.7)", "normals": "1D, normals (4.8)"}
NOTES = [
    "Output: channels, then frames and cells. Dropout is printed as the share that is kept, as in mdCNN, the tool of "
    "the thesis: 0.8 here drops a fifth.",
    "Where the tables are silent: 64 and 32 units in the fully connected layers; no activation behind the first 3D "
    "convolution; a softmax with weights of its own. Without those the last tanh would cap each probability at 0.51 of "
    "eight classes, and the sum of both networks would follow the weaker one.",
    "Where they cannot be: 3 x 3 kernels on the one row that 3 x 5 kernels leave of 3 x 25 normals (here 3 frames "
    "wide), and pooling by 0.2 (here by 2).",
    "The 32x19 of the second 1D convolution are pooled to 32x9 before the first fully connected layer.",
    "Trained by plain gradient descent from a rate of 0.05, mdCNN's own default, that halves when the training loss "
    "has not fallen for three passes (mdCNN watches the test data).",
]


def build(results):
    frame = results.table("sequences", "layers.csv")
    frame = frame[frame["kind"] != "Dropout"].reset_index(drop=True)
    frame["thesis"] = [SAID.get(key, "") for key in zip(frame["network"], frame["layer"], strict=True)]
    frame = frame[["network", "layer", "thesis", "kind", "output", "parameters"]]
    total = frame.groupby("network")["parameters"].sum()
    counted = "; ".join(f"{NETWORKS[name].partition(',')[0]} {total[name]:,}" for name in NETWORKS)
    shown = frame.assign(network=frame["network"].map(NETWORKS)).rename(
        columns={"kind": "ours", "output": "output of ours"}
    )
    return Table("Tables 4.7 and 4.8: the two networks", frame, [*NOTES, f"Parameters: {counted}."], shown)
