"""The tables of scenes: what was measured, and what it leaves open."""

import pandas as pd
import pytest

from haptic_glance.base.files import write_table
from stages.report import scene as topic
from stages.report.results import NotRun
from stages.report.scene import scene as scenes
from stages.report.scene.random import left_of
from stages.report.topics import build_one

VALUES = {"full": 9000, "uniform": 1600, "uniform_size": 1250, "network": 1500, "ours": 1000, "online": 1040}


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
        spread = {"method": "ours", "matched": "displacement", "metric": f"saved_{rival}"}
        rows.append(spread | {"value": 0.07, "low": -0.1, "high": 0.2})
    common = {"scene": name, "kind": "pixels", "tolerance": 1.0, "objects": 8, "shapes": 5, "frames": 24}
    return [common | changes | row for row in rows]


def table(root, results, *groups):
    write_table(root / "reports/bench/scenes.csv", pd.DataFrame([row for group in groups for row in group]))
    return build_one(topic, "tables", "scenes", results)


def test_every_scene_has_a_line_a_way(root, results):
    found = table(root, results, scene("shelf"), scene("hall"), scene("hall", kind="ssim", tolerance=0.05)).shown
    assert len(found) == 3 * len(scenes.WAYS)
    assert found["tolerance"].unique().tolist() == ["1 pixel", "0.05 1 − SSIM"]
    lines = found[found["scene"] == "shelf"].set_index("levels chosen by")
    assert lines.loc["uniform levels by distance", "faces that ours saves, %"] == "40 [30, 50]"
    assert lines.loc["ours", "faces a frame"] == "1,000" and lines.loc["ours", "frames within, %"] == "100"
    assert lines.loc["ours, limited", "frame error, mean"] == "1.50"
    assert lines.loc["ours, the limit shared equally", "frame error, mean"] == "2.50"


def test_what_is_saved_is_said_of_each_scene(root, results):
    notes = table(root, results, scene("shelf"), scene("table", saved=0.29)).notes
    assert "8 objects (5 different), 24 frames" in notes[0]
    assert [note.count("equal mean displacement of all pixels it saves 7 [-10, 20] %") for note in notes[:2]] == [2, 2]
    assert notes[0].count("saves 40 [30, 50] % at an equal mean error") == 2
    assert notes[1].count("saves 29 [19, 39] % at an equal mean error") == 2


@pytest.mark.parametrize(
    ("spread", "said"),
    [([0.07, -0.02], "most of the saving vanishes: -2 to 7 %"), ([0.2, 0.3], "part of the saving vanishes: 20 to 30 %"),
     ([0.5, 0.5], "the saving is no smaller: 50 %")],
)  # fmt: skip
def test_what_the_matching_leaves_open_is_said_with_figures(spread, said):
    shares = {"error": [0.4, 0.3], "displacement": spread}
    saved = pd.DataFrame({"rival": "uniform", "matched": matched, "value": share}
                         for matched, found in shares.items() for share in found)  # fmt: skip
    assert f"{said} instead of 30 to 40 % against uniform levels by distance." in left_of(saved)
    assert left_of(saved[saved["matched"] == "error"]) == left_of(saved[:0]) == ""


def test_both_tables_say_what_they_leave_open(root, results):
    every, notes = table(root, results, scene("shelf")).notes, staged(root, results).notes
    planned, factor, resampled = (note for note in notes if note in every)
    assert planned.startswith("The error made equal") and "most of the saving vanishes: 7 % instead of 40 %" in planned
    assert factor.startswith("Each rival has one number") and resampled.startswith("The intervals resample the objects")
    pair = "7 [-10, 20] % against uniform levels by {} (mean displacement)"
    assert pair.format("distance") in notes[0] and pair.format("size on the screen") in notes[0]


def staged(root, results, *more):
    """The table of the scene that the stage did."""
    common = {"dataset": "test", "frame": "all", "factor": 1.0, "item": None, "seconds": 1.0, "note": None}
    rows = pd.DataFrame([common | row for row in (*scene("shelf"), *more)]).rename(columns={"scene": "group"})
    write_table(root / "reports/measurements/test/scene.csv.gz", rows)
    return build_one(topic, "tables", "scene", results)


ABSENT = {"scene": "shelf", "kind": "pixels", "tolerance": 1.0, "method": "network", "matched": "error",
          "metric": "faces", "value": None, "note": "no object to learn from"}  # fmt: skip


def test_both_tables_say_why_there_is_no_network(root, results):
    rows = [row for row in scene("shelf") if row["method"] != "network"]
    found = table(root, results, [*rows, ABSENT], scene("hall"))
    assert found.notes[0].endswith(" The thesis's network: no object to learn from.")
    assert "no object" not in "".join(found.notes[1:]) and "network" not in set(found.frame["method"][:6])
    assert "the thesis's network: no object to learn from." in staged(root, results, ABSENT).notes


def test_a_way_that_was_not_asked_has_no_line(root, results):
    rows = [row for row in scene("shelf") if row["method"] != "network"]
    rows.append({"scene": "shelf", "kind": "pixels", "tolerance": None, "method": "network", "metric": "faces"})
    found = table(root, results, rows).shown
    assert len(found) == len(scenes.WAYS) - 1 and "the thesis's network" not in set(found["levels chosen by"])


def test_without_the_benchmark_it_is_not_run(results):
    with pytest.raises(NotRun, match="bench/scenes"):
        scenes.scenes(results)
