"""The table of a scene."""

import pandas as pd

from stages.report.parts import build_item
from stages.scene import Params, online
from stages.scene import report as topic
from stages.scene.report import COMMON, planning

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
    common = {"scene": name, "kind": "pixels", "tolerance": 1.0, "objects": 8, "shapes": 5, "frames": 24}
    return [common | changes | row for row in rows]


@pytest.fixture
def table(measure):
    """A function of the rows of scenes to their table."""

    def build(*groups):
        results = measure("bench/scenes", pd.DataFrame([row for group in groups for row in group]))
        return build_item(topic, "tables", "scenes", results)

    return build


ABSENT = {"scene": "shelf", "kind": "pixels", "tolerance": 1.0, "method": "network", "matched": "error",
          "metric": "faces", "value": None, "note": "no object to learn from"}  # fmt: skip


def test_both_tables_say_why_there_is_no_network(measure, table):
    rows = [row for row in scene("shelf") if row["method"] != "network"]
    built = table([*rows, ABSENT], scene("hall"))
    assert built.notes[0].endswith(" The thesis's network: no object to learn from.")
    assert "no object" not in "".join(built.notes[1:]) and "network" not in set(built.frame["method"][:6])
    common = {"dataset": "test", "frame": "all", "factor": 1.0, "item": None, "seconds": 1.0, "note": None}
    staged = pd.DataFrame([common | row for row in (*scene("shelf"), ABSENT)]).rename(columns={"scene": "group"})
    built = build_item(topic, "tables", "scene", measure("scene", staged))
    assert "the thesis's network: no object to learn from." in built.notes


def rows_of(group, faces):
    """Rows of a scene; faces: {(method, matched): faces}."""
    common = {"dataset": "household_scenes", "group": group, "frame": "all", "factor": 1.0, "item": None, "seed": 0}
    common |= {"kind": "pixels", "tolerance": 1.0, "note": None}
    rows = []
    for (method, matched), count in faces.items():
        values = {"faces": count, "displacement_mean": 0.2, "error": 0.9, "held": 1.0, "switches_per_object": 3.0}
        values |= {"step_worst": 1.0, "planning_ms": 20.0}
        rows += [common | {"method": method, "matched": matched or None, "metric": name, "value": value}
                  for name, value in values.items()]  # fmt: skip
    return rows


ABSENT = {"method": "network", "matched": "error", "metric": "faces", "value": None, "note": "no object to learn from"}
COMMON = {"dataset": "test", "group": "shelf", "kind": "pixels", "tolerance": 1.0, "frame": "all", "factor": 1.0,
          "item": None, "seconds": 1.0, "note": None}  # fmt: skip


@pytest.mark.slow
def test_the_time_of_drawing_stands_beside_the_faces(measure, measured):
    rivals = [f"{name}__{matched}" for name in ("uniform", "uniform_size") for matched in ("displacement", "error")]
    ways = {"online": lambda k: 1000, "online_unrendered": lambda k: 1800 + k}
    ways |= {"beforehand__displacement": lambda k: 1195 + k, "every_level__displacement": lambda k: 900 + 10 * k}
    results = measured(**ways, **dict.fromkeys(rivals, lambda k: 1500))
    ways = {"full": (50_000, 1.0), "ours": (1000, 0.25), "uniform": (1500, 0.3), "online": (1000, 0.25)}
    ways["beforehand"] = (1200, 0.275)
    bench = [{"scene": f"random_{k:02d}", "method": name, "rows": 270, "faces": faces, "ms": 40 * ratio + 0.1 * k,
              "ratio": ratio + 0.001 * k, "device": "llvmpipe (LLVM 15)"}
             for k in range(12) for name, (faces, ratio) in ways.items()]  # fmt: skip
    results = measure("bench/frame_times", pd.DataFrame(bench), results=results)
    less = build_item(topic, "tables", "random_scenes", results).frame.set_index("method")["less"]
    assert less["beforehand"] == pytest.approx(0.2, abs=0.001) and 0.3 < less["every_level"] < 0.4
    assert less["full"] != less["full"]  # not at an equal displacement
    text = planning(results)  # 40 ms times 0.3 - 0.25 are saved by 20 ms of planning
    assert "costs 20 ms a frame, and drawing them is 2.0 ms faster" in text
    assert "beforehand costs 20 ms, and drawing these levels is 1.0 ms faster" in text
    assert "renders nothing costs 20 ms and saves -20 [" in text


@pytest.fixture
def needs(measure):
    """Results of nine objects that need 100 faces to be seen, 1,000 to be felt and 300 to be recognised, about."""
    ways = {("full", None): 5000, ("seen", 0.5): 200, ("seen", 1.0): 100, ("felt", 0.05): 1000, ("felt", 0.02): 3000,
            ("recognised", 0.02): 300}  # fmt: skip
    common = {"dataset": "household_scenes", "seed": 0}
    faces = common | {"metric": "faces"}
    rows = [faces | {"item": f"object {k}", "task": task, "condition": condition, "value": count + k}
            for k in range(9) for (task, condition), count in ways.items()]  # fmt: skip
    rows += [common | {"item": f"object {k}", "task": "recognised", "metric": "accuracy", "value": 0.7 + 0.01 * k}
             for k in range(9)]  # fmt: skip
    together = {"item": None, "task": "recognised", "condition": 0.02, "metric": "faces_together", "value": 250}
    return measure("face_needs", pd.DataFrame([*rows, common | together]))


def test_a_task_has_the_median_of_its_objects_from_few_faces_to_many(needs):
    assert build_item(topic, "tables", "faces_by_task", needs).frame["median"].tolist() == [104, 204, 1004, 3004, 304]


def test_random_scenes_share_objects_as_is_said():
    params = load_params(conf_folder() / "data/household_scenes.yaml")
    names = params["meshes"]["objects"]
    shared, random = (load_params(conf_folder() / path)["scene"] for path in ("config.yaml", "scene/random.yaml"))
    scene = check_section(Params, shared | random)
    boxes, sizes = {name: (-np.ones(3), np.ones(3)) for name in names}, dict.fromkeys(names, 0.2)
    scenes = [{item.name for item in online.draw_scene(scene, k, boxes, sizes, 0).objects} for k in range(30)]
    shares = [len(first & second) / np.sqrt(len(first) * len(second)) for first, second in combinations(scenes, 2)]
    assert np.mean(shares) == pytest.approx(COMMON, abs=5e-4)
