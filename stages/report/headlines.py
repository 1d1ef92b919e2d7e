"""headlines.json: the numbers that `dvc metrics show` and `dvc exp show` list, from charts and counts of verdicts."""

from collections.abc import Mapping
from contextlib import suppress
from pathlib import Path

from haptic_glance.base.files import write_json
from stages.charts.cells import rows_of

HEADLINES_FILE = "headlines.json"
HEADLINES = {  # name: (file and rows, as stages.charts.cells has them, of which the first counts; its column)
    "nss_glance": ("tradeoff/attention", "method=glance metric=nss", "mean"),
    "touch_accuracy_knn_glance": ("tradeoff/saliency", "method=glance", "mean"),
    "touch_accuracy_knn_blind": ("tradeoff/saliency", "method=random", "mean"),
    "salient_error_qem_25": ("tradeoff/simplification", "metric=salient_error method=qem target=25%", "mean"),
    "salient_error_soft_25": ("tradeoff/simplification", "metric=salient_error method=glance-soft target=25%", "mean"),
    "metro_mean_qem_25": ("tradeoff/simplification", "metric=metro_mean method=qem target=25%", "mean"),
    "scene_faces": ("tradeoff/scene", "method=ours tolerance=1 pixel", "faces"),
    "contour_accuracy_cnn": ("tradeoff/sequences", "classifier=cnn", "mean"),
    "seconds_glance": ("tradeoff/attention", "method=glance metric=nss", "seconds"),
}


def write_headlines(out: Path, verdicts: Mapping[str, int] | None) -> None:
    """Writes headlines.json from the charts below `out` and the counts of verdicts, without charts that are not there.

    verdicts: None for a folder of a person's own meshes, which the claims of the thesis are not about.
    """
    headlines: dict[str, float] = {}
    for name, (file, where, column) in HEADLINES.items():
        with suppress(LookupError):
            headlines[name] = float(rows_of(out / f"{file}.csv", where)[column].iloc[0])
    if verdicts is not None:
        headlines |= {f"claims_{word}": verdicts.get(word, 0) for word in ("supported", "contradicted", "open")}
    write_json(out / HEADLINES_FILE, headlines)
