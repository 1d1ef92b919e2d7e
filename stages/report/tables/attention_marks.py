"""Every method of this run against the marks on this run's own objects."""

from ._attention import agreement_table

METRICS = ["nss", "auc", "points_strong", "fne@0.05", "fpe@0.05"]
MARKED = "household"  # the data set whose marks come with the project
NOTES = {
    True: "The truth here is no gaze: marks of three passes over rendered views by a vision model "
    "(data/annotations). No human subjects took part. A bunny is among these objects and among the meshes with gaze.",
    False: "The truth is what comes with the data set {}.",
}
LEFT_OUT = (
    "Each object is judged with weights and SVMs that were learned without it; ours was learned from human gaze on "
    "other meshes and has seen no mark, unless weights.method says otherwise."
)


def build(results):
    rows = results.measured("salient_points")
    dataset = rows["dataset"].iloc[0]
    count = rows.loc[rows["metric"] == "nss", "object"].nunique()
    title = f"Attention against the marks on {count} objects of this run"
    return agreement_table(rows, METRICS, title, [NOTES[dataset == MARKED].format(dataset), LEFT_OUT])
