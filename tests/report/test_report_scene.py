"""The table of a scene."""

import pandas as pd

from stages.report import scene as topic
from stages.report.parts import build_item

VALUES = {"full": 9000, "uniform": 1600, "uniform_size": 1250, "network": 1500, "ours": 1000}


def scene():
    """Rows of a scene in which ours takes 1,000 faces a frame."""
    rows = []
    for method, faces in VALUES.items():
        matched = "error" if method in ("uniform", "uniform_size", "network") else ""
        values = {"faces": faces, "error": 0.9, "error_worst": 0.95, "held": 1.0, "step_worst": 0.8}
        rows += [{"method": method, "matched": matched, "metric": metric, "value": value}
                 for metric, value in values.items()]  # fmt: skip
    for rival in ("uniform", "uniform_size"):
        saving = {"method": "ours", "matched": "error", "metric": f"saved_{rival}", "value": 0.4}
        rows.append(saving | {"low": 0.3, "high": 0.5})
        spread = {"method": "ours", "matched": "displacement", "metric": f"saved_{rival}"}
        rows.append(spread | {"value": 0.07, "low": -0.1, "high": 0.2})
    return rows


ABSENT = {"method": "network", "matched": "error", "metric": "faces", "value": None, "note": "no object to learn from"}
COMMON = {"dataset": "test", "group": "shelf", "kind": "pixels", "tolerance": 1.0, "frame": "all", "factor": 1.0,
          "item": None, "seconds": 1.0, "note": None}  # fmt: skip


def test_the_table_says_why_there_is_no_network_and_what_is_left_of_the_saving(measure):
    rows = pd.DataFrame([COMMON | row for row in (*scene(), ABSENT)])
    built = build_item(topic, "tables", "scene", measure("scene", rows))
    assert "the thesis's network: no object to learn from." in built.notes
    assert "40 [30, 50] % against uniform levels by distance" in " ".join(built.notes)
    assert "most of the saving vanishes: 7 % instead of 40 %" in " ".join(built.notes)
    assert built.frame.set_index("method")["faces"].to_dict() == VALUES
