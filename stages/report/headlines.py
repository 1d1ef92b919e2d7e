"""The few numbers that `dvc metrics show` and `dvc exp show` list: headlines.json."""

from collections.abc import Mapping
from pathlib import Path

import pandas as pd

from haptic_glance.base.files import write_json

FILE = "headlines.json"
# name: (chart of reports/tradeoff, the row that has these values, its column)
HEADLINES: dict[str, tuple[str, dict[str, str], str]] = {
    "nss_glance": ("attention", {"method": "glance", "metric": "nss"}, "mean"),
    "touch_accuracy_knn_glance": ("saliency", {"method": "glance"}, "mean"),
    "touch_accuracy_knn_blind": ("saliency", {"method": "random"}, "mean"),
    "salient_error_qem_25": ("simplification", {"metric": "salient_error", "method": "qem", "target": "25%"}, "mean"),
    "salient_error_soft_25": (
        "simplification", {"metric": "salient_error", "method": "glance-soft", "target": "25%"}, "mean",
    ),
    "metro_mean_qem_25": ("simplification", {"metric": "metro_mean", "method": "qem", "target": "25%"}, "mean"),
    "places_found_again": ("stability", {"method": "glance"}, "found"),
    "corruption_error": ("stability", {"method": "glance"}, "mce"),
    "scene_faces": ("scene", {"method": "ours", "tolerance": "1 pixel"}, "faces"),
    "contour_accuracy_cnn": ("sequences", {"classifier": "cnn"}, "mean"),
    "seconds_glance": ("attention", {"method": "glance", "metric": "nss"}, "seconds"),
}  # fmt: skip


def write_headlines(out: Path, verdicts: Mapping[str, int] | None) -> None:
    """Writes headlines.json from the charts below `out` and the counts of verdicts, without charts that are not there.

    verdicts: None for a folder of a person's own meshes, which the claims of the thesis are not about. A chart may hold
    several rows that fit: the first counts.
    """
    found: dict[str, float] = {}
    for name, (chart, values, column) in HEADLINES.items():
        path = out / "tradeoff" / f"{chart}.csv"
        if not path.exists():
            continue
        rows = pd.read_csv(path)
        if not {*values, column} <= {*rows.columns}:
            continue
        fitting = rows[(rows[list(values)].astype(str) == pd.Series(values)).all(axis=1)]
        if len(fitting):
            found[name] = float(fitting[column].iloc[0])
    if verdicts is not None:
        found |= {f"claims_{word}": verdicts.get(word, 0) for word in ("supported", "contradicted", "open")}
    write_json(out / FILE, found)
