"""Collects a data set of meshes, repairs or refuses each one, centres and scales it.

Reads the source named by meshes.source (household, furniture: fetched by hash once; folder: a person's own files).
Writes data/meshes/NAME.npz, manifest.csv (what each mesh is) and refused.csv (what was left out and why).
"""

import sys

import pandas as pd

from stages.kit import StageRun, Stopwatch, arguments, params
from stages.kit.fetch import FetchError
from stages.kit.files import write_mesh, write_table

from .collect import prepare
from .load import MeshError
from .sources import SOURCES

REFUSED = ["object", "file", "reason"]


def main():
    arguments(__doc__)
    settings = params("meshes")
    if settings.source not in SOURCES:
        sys.exit(f"meshes.source={settings.source!r} is not known: {', '.join(SOURCES)}")
    try:
        items = {item.name: item for item in SOURCES[settings.source](settings)}
    except (MeshError, FetchError) as error:
        sys.exit(f"meshes: {error}")
    with StageRun("meshes") as run:
        manifest, refused = [], []
        for item in run.progress(items.values()):
            try:
                with Stopwatch() as watch:
                    mesh, row = prepare(item, settings.remove_plane)
                    write_mesh(run.folder / f"{item.name}.npz", mesh)
            except MeshError as error:
                print(f"meshes: refused {item.file}: {error}", file=sys.stderr)
                refused.append({"object": item.name, "file": item.file, "reason": str(error)})
                if settings.strict:
                    sys.exit("meshes: stopped at the first refusal, as meshes.strict asks")
                continue
            manifest.append(row)
            run.rows.append({"object": item.name, "metric": "faces", "value": row["faces"], "seconds": watch.seconds})
        if not manifest:
            sys.exit("meshes: every mesh was refused; nothing is left to work on")
        write_table(run.folder / "manifest.csv", pd.DataFrame(manifest))
        write_table(run.folder / "refused.csv", pd.DataFrame(refused, columns=REFUSED))
        closed = sum(row["watertight"] for row in manifest)
        run.metrics({"objects": len(manifest), "refused": len(refused), "watertight": closed})
    print(f"meshes: {len(manifest)} objects, {closed} watertight, {len(refused)} refused")


if __name__ == "__main__":
    main()
