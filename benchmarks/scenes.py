"""Every scene of conf/scene, by every way to choose the levels of its objects: `python -m benchmarks.scenes`

Reads data/ of the finished run, and runs its scene stage, which does one scene alone, on each. One scene is done again
with a perceptual tolerance. Writes reports/bench/scenes.csv: a row a scene, method and metric over all frames, as the
scene stage writes them, with how many objects (`objects`), different ones (`shapes`) and frames there are. What the
stage writes for a scene is left in build/scenes.
"""

import time
from pathlib import Path

import pandas as pd
from omegaconf import OmegaConf

from benchmarks import arguments
from haptic_glance.base.files import write_table, write_text
from stages.compose import compose
from stages.engine.parallel import progress
from stages.engine.rows import SUFFIX, read_rows
from stages.engine.run import object_names
from stages.engine.settings import FILE, Workspace, load_params
from stages.scene import Params
from stages.scene.__main__ import run
from stages.scene.measure import scene_of

OUT, FOLDER = Path("reports/bench/scenes.csv"), Path("build/scenes")
SCENES = sorted(path.stem for path in Path("conf/scene").glob("*.yaml"))
# A twentieth of the structure of each object may be lost: finer than the pixel of the same scene.
CASES = {name: [f"scene={name}"] for name in SCENES} | {
    "table_ssim": ["scene=table", "scene.kind=ssim", "scene.tolerance=0.05"]
}
INPUTS = ("meshes", "salient_points", "lod")
COLUMNS = ["dataset", "scene", "kind", "tolerance", "objects", "shapes", "frames", "method", "matched", "metric",
           "value", "low", "high", "seconds", "note"]  # fmt: skip


def workspace_of(case, dataset, data):
    """The Workspace of a case: its own params.yaml beside links to the inputs in data/SET."""
    workspace = Workspace(FOLDER / case, dataset)
    values = compose([f"sets=[{dataset}]", *CASES[case], "scene.factors=[1.0]"])
    write_text(workspace.root / FILE, OmegaConf.to_yaml(OmegaConf.create(values)))
    workspace.data.mkdir(parents=True, exist_ok=True)
    for stage in INPUTS:
        (workspace.data / stage).unlink(missing_ok=True)
        (workspace.data / stage).symlink_to((data / stage).resolve())
    return workspace


def measured(workspace):
    """The rows of a case over all frames."""
    run(workspace)
    rows = read_rows(workspace.measurements / f"scene{SUFFIX}")
    rows = rows[(rows["frame"] == "all") & rows["item"].isna() & rows["group"].notna()]
    scene, _ = scene_of(workspace.settings(Params), object_names(workspace))
    shapes = {placed.name for placed in scene.objects}
    counts = {"objects": len(scene.objects), "shapes": len(shapes), "frames": len(scene.cameras)}
    return rows.rename(columns={"group": "scene"}).assign(**counts)


def main():
    """Measures every case and writes the table, anew after each."""
    arguments(__doc__)
    dataset, tables = load_params()["graph"]["scene"][0], []
    for case in progress(list(CASES), "scenes"):
        start = time.perf_counter()
        tables.append(measured(workspace_of(case, dataset, Path("data") / dataset)))
        write_table(OUT, pd.concat(tables).reindex(columns=COLUMNS))
        print(f"{case}: {time.perf_counter() - start:.0f} s", flush=True)


if __name__ == "__main__":
    main()
