"""The table of a scene."""

import pandas as pd

from stages.report.parts import build_item
from stages.scene import report

FACES = {"full": 9000, "uniform": 1600, "uniform_size": 1250, "ours": 1000}
ABSENT = {"method": "network", "matched": "error", "metric": "faces", "value": None, "note": "no object to learn from"}


def rows():
    """Rows of a scene in which ours takes 1,000 faces a frame, 40 % less than uniform levels of the same error."""
    entries = [ABSENT]
    for method, faces in FACES.items():
        matched = "error" if method.startswith("uniform") else None
        values = {"faces": faces, "error": 0.9, "error_worst": 0.95, "held": 1.0, "step_worst": 0.8}
        entries += [{"method": method, "matched": matched, "metric": metric, "value": value}
                    for metric, value in values.items()]  # fmt: skip
    saved = {"method": "ours", "matched": "error", "metric": "saved_uniform", "value": 0.4, "low": 0.3, "high": 0.5}
    common = {"dataset": "test", "group": "shelf", "kind": "pixels", "tolerance": 1.0, "frame": "all", "factor": 1.0,
              "item": None, "seconds": 1.0, "note": None}  # fmt: skip
    return pd.DataFrame([common | entry for entry in [*entries, saved]])


def test_table_has_the_faces_that_ours_saves_and_why_there_is_no_network(measure):
    built = build_item(report, "tables", "scene", measure("scene", rows()))
    assert "the thesis's network: no object to learn from." in built.notes
    assert dict(zip(built.frame["method"], built.frame["faces"], strict=True)) == FACES
    shown = built.shown.set_index("levels chosen by")["faces that ours saves, %"]
    assert shown["uniform levels by distance"] == "40 [30, 50]" and shown["ours"] == "–"
