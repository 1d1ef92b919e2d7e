"""Every scene of conf/scene, by every way to choose the levels of its objects: `python -m benchmarks.scenes`

Reads data/ of the finished run, whose scene stage does one scene alone, and does what that stage does for each scene:
LOD chains, plans, rendered frames, and GLB files that are loaded back. One scene is done again with a perceptual
tolerance. Writes reports/bench/scenes.csv: a row a scene, method and metric over all frames, as the scene stage writes
them, with how many objects (`objects`), different ones (`shapes`) and frames there are. Files of each scene are left in
build/scenes.
"""

import time
from pathlib import Path

import pandas as pd
from omegaconf import OmegaConf

from benchmarks import arguments
from stages.compose import compose
from stages.kit.files import write_table
from stages.kit.parallel import progress
from stages.kit.params import check_section, load_params
from stages.kit.run import object_names
from stages.scene.__main__ import levels_of
from stages.scene.export import export
from stages.scene.measure import measure
from stages.scene.read import report_missing, scene_of

OUT, FOLDER = Path("reports/bench/scenes.csv"), Path("build/scenes")
SCENES = sorted(path.stem for path in Path("conf/scene").glob("*.yaml"))
# A twentieth of the structure of each object may be lost: finer than the pixel of the same scene.
CASES = {name: [f"scene={name}"] for name in SCENES} | {
    "table_ssim": ["scene=table", "scene.kind=ssim", "scene.tolerance=0.05"]
}
COLUMNS = ["dataset", "scene", "kind", "tolerance", "objects", "shapes", "frames", "method", "matched", "metric",
           "value", "low", "high", "seconds", "note"]  # fmt: skip


def measured(case, names, seed):
    """(rows of a case, its Scene)."""
    settings = check_section("scene", OmegaConf.to_container(compose(CASES[case]))["scene"])
    scene, missing = scene_of(settings, names)
    report_missing(settings, scene, missing)
    shapes = sorted({placed.name for placed in scene.objects})
    for name in shapes:
        levels_of(name, FOLDER / case, settings, seed)
    rows = measure(case, FOLDER / case, settings, {case: 1.0}, names, seed)
    export(FOLDER / case, settings, names)
    counts = {"objects": len(scene.objects), "shapes": len(shapes), "frames": len(scene.cameras)}
    return [row | counts for row in rows if row["frame"] == "all" and row.get("item") is None]


def main():
    """Measures every case and writes the table, anew after each."""
    arguments(__doc__)
    params, names, rows = load_params(), object_names(), []
    for case in progress(list(CASES), "scenes"):
        start = time.perf_counter()
        found = measured(case, names, params["seed"])
        rows += [{"dataset": params["meshes"]["source"]} | row for row in found]
        write_table(OUT, pd.DataFrame(rows).reindex(columns=COLUMNS))
        print(f"{case}: {time.perf_counter() - start:.0f} s", flush=True)


if __name__ == "__main__":
    main()
