"""Every method against where people looked: the meshes with human gaze, each left out of the learning."""

from ._attention import MEANS, agreement_table

NOTES = [
    "{count} meshes, about 20,000 vertices each, and the gaze of 32 people on them in virtual reality, summed over the "
    "people (raw hits, seconds a vertex); as published with FandosA/3D_Mesh_Saliency_Prediction_PyTorch. The truth is "
    "that gaze, and the same spread along the surface with a Gaussian of 2.5 % of the diagonal.",
    "What is learned is learned from the other meshes, but for the starred rows. Twelve views of 1200 x 900 pixels (T "
    "figure 3.2). The intervals are over {count} meshes, which are few; other kinds of objects or people may differ.",
    "Seconds: from the maps to the points, of the median mesh; pictures and maps come on top (see the chart of cost).",
]


def build(results):
    rows = results.attention("gaze")
    count = rows["object"].nunique()
    notes = [note.format(count=count) for note in NOTES]
    return agreement_table(rows, ["nss", "auc", *MEANS], f"Attention against human gaze, {count} meshes", notes)
