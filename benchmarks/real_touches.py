"""Recognition of real touches, and by simulated ones: `python -m benchmarks.real_touches IMAGES GRASPS [MESHES]`

IMAGES: the pressure images of Gandarias and others (a zip file or folder), GRASPS: BTS3 v2, MESHES: the folder of
normalised household meshes, data/meshes of `dvc repro meshes` if not given. Writes what was measured, never the
data, to reports/touch: real.csv (recognition, T table 4.4), grasps.csv (slip of objects never grasped before) and
simulated_to_real.csv (trained on simulated imprints, on real ones, on both). One core, about five minutes.
"""

from pathlib import Path

import pandas as pd
from threadpoolctl import threadpool_limits

from benchmarks import arguments
from benchmarks._grasps import drift_rows, grasp_rows
from benchmarks._recorded import neighbours, recognition
from benchmarks._simulated import transfer_rows
from stages.classification.recorded import read_grasps, read_pressure_images
from stages.kit.files import write_table

OUT = Path("reports/touch")


def main():
    """Writes the three tables, each as soon as it is known."""
    given = arguments(__doc__, "images", "grasps", meshes="data/meshes")
    images, grasps = read_pressure_images(given.images), read_grasps(given.grasps)
    parts = {
        "real": lambda: [*recognition(images), *neighbours(images)],
        "grasps": lambda: [*grasp_rows(grasps), *drift_rows(grasps)],
        "simulated_to_real": lambda: transfer_rows(images, given.meshes),
    }
    for name, rows in parts.items():
        with threadpool_limits(1):  # equal sums on any number of cores
            frame = pd.DataFrame(rows())
        write_table(OUT / f"{name}.csv", frame)
        print(f"{OUT / name}.csv: {len(frame):,} rows", flush=True)


if __name__ == "__main__":
    main()
