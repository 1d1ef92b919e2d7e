"""The table of all scenes: what was measured beside what is to be reached."""

import pandas as pd
import pytest

from stages.kit.files import write_table
from stages.report.results import NotRun
from stages.report.tables import scenes

VALUES = {"full": 9000, "uniform": 1600, "uniform_size": 1250, "network": 1500, "ours": 1000}


def scene(name, saved=0.4, held=1.0, **changes):
    """Rows of a scene in which ours takes 1,000 faces a frame, or 500 under a limit."""
    rows = []
    for method, faces in VALUES.items():
        matched = "error" if method in ("uniform", "uniform_size", "network") else ""
        values = {"faces": faces, "error": 0.9, "error_worst": 0.95, "held": held, "step_worst": 0.8}
        rows += [{"method": method, "matched": matched, "metric": metric, "value": value}
                 for metric, value in values.items()]  # fmt: skip
    for method, error in (("ours", 1.5), ("equal", 2.5)):
        limited = {"method": method, "matched": "limit", "note": "limit of 600 faces"}
        rows += [limited | {"metric": "faces", "value": 500}, limited | {"metric": "error", "value": error}]
    for rival in ("uniform", "uniform_size"):
        found = {"method": "ours", "matched": "error", "metric": f"saved_{rival}", "value": saved}
        rows.append(found | {"low": saved - 0.1, "high": saved + 0.1})
    spread = {"method": "ours", "matched": "displacement", "metric": "saved_uniform"}
    rows.append(spread | {"value": 0.07, "low": -0.1, "high": 0.2})
    common = {"scene": name, "kind": "pixels", "tolerance": 1.0, "objects": 8, "shapes": 5, "frames": 24}
    return [common | changes | row for row in rows]


def table(root, results, *groups):
    write_table(root / "reports/bench/scenes.csv", pd.DataFrame([row for group in groups for row in group]))
    return scenes.build(results)


def test_every_scene_has_a_line_a_way(root, results):
    found = table(root, results, scene("shelf"), scene("hall"), scene("hall", kind="ssim", tolerance=0.05)).shown
    assert len(found) == 3 * len(scenes.WAYS)
    assert found["tolerance"].unique().tolist() == ["1 pixel", "0.05 1 − SSIM"]
    lines = found[found["scene"] == "shelf"].set_index("levels chosen by")
    assert lines.loc["uniform levels by distance", "faces that ours saves, %"] == "40 [30, 50]"
    assert lines.loc["ours", "faces a frame"] == 1000 and lines.loc["ours", "frames within, %"] == "100"
    assert lines.loc["ours, limited", "frame error, mean"] == 1.5
    assert lines.loc["ours, the limit shared equally", "frame error, mean"] == 2.5


def test_what_is_to_be_reached_is_said_of_each_scene(root, results):
    notes = table(root, results, scene("shelf"), scene("table", saved=0.29), scene("hall", held=0.9)).notes
    assert "8 objects (5 different), 24 frames" in notes[0]
    assert [note.count("equal mean displacement of all pixels it saves 7 [-10, 20] %") for note in notes[:3]] == [1] * 3
    assert [note.count("reached") for note in notes[:3]] == [2, 0, 0]
    assert [note.count("missed") for note in notes[:3]] == [0, 2, 2]


def test_a_way_that_was_not_asked_has_no_line(root, results):
    rows = [row for row in scene("shelf") if row["method"] != "network"]
    rows.append({"scene": "shelf", "kind": "pixels", "tolerance": None, "method": "network", "metric": "faces"})
    found = table(root, results, rows).shown
    assert len(found) == len(scenes.WAYS) - 1 and "the thesis's network" not in set(found["levels chosen by"])


def test_without_the_benchmark_it_is_not_run(results):
    with pytest.raises(NotRun, match="bench/scenes"):
        scenes.build(results)
