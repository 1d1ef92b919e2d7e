"""Works out the conspicuity maps of every view: what stands out, channel by channel (T3.1.1, T3.2).

Reads data/meshes/NAME.npz and data/views/NAME/*.npz. Writes data/conspicuity/NAME.npz (maps, mask, viewpoints,
channels) and reports/measurements/conspicuity.csv. Settings: section `conspicuity` of params.yaml.
"""

import functools

import cv2
import numpy as np

from stages.kit import StageRun, arguments, params
from stages.kit.files import read_mesh, read_table, write_arrays
from stages.kit.run import DATA
from stages.views import read_view

from .channels import coverage, known_channels
from .measure import background_rows, measured_maps


def process(name, folder, settings):
    """Maps all views of one object; returns what each channel cost and how much of it lies along the silhouette."""
    cv2.setNumThreads(1)  # a worker is one core, and `seconds` are of one core
    mesh = read_mesh(DATA / "meshes" / f"{name}.npz")
    channels, size = list(settings.channels), tuple(settings.size)
    viewpoints = list(read_table(DATA / "views" / "viewpoints.csv")["viewpoint"])
    maps = np.zeros((len(viewpoints), len(channels), *size), dtype=np.float16)
    mask = np.zeros((len(viewpoints), *size), dtype=bool)
    rows = []
    for k, viewpoint in enumerate(viewpoints):
        view = read_view(DATA / "views" / name / f"{viewpoint}.npz")
        found, measured = measured_maps(mesh, view, channels, size)
        maps[k] = [found[channel] for channel in channels]
        mask[k] = coverage(view.mask, size)
        rows += measured
        if k == 0 and settings.compare_background:
            rows += background_rows(mesh, view, channels, size)
    write_arrays(folder / f"{name}.npz", maps=maps, mask=mask, viewpoints=viewpoints, channels=channels)
    return [{"object": name} | row for row in rows]


def main():
    arguments(__doc__)
    settings = params("conspicuity")
    known_channels(settings.channels)
    with StageRun("conspicuity", inputs=("meshes", "views")) as run:
        rows = run.each(functools.partial(process, settings=settings), run.objects)
        maps = [row for row in rows if row["metric"] == "silhouette_share"]
        share = float(np.mean([row["value"] for row in maps if row["value"] is not None] or [0]))
        run.metrics({"maps": len(maps), "silhouette_share": round(share, 6)})
    seconds = sum(row["seconds"] for row in maps)
    print(
        f"conspicuity: {len(run.objects)} objects, {len(maps)} maps in {seconds:.0f} s of one core, "
        f"{share:.2f} of an even share along the silhouette"
    )


if __name__ == "__main__":
    main()
