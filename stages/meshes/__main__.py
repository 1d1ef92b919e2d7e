"""Collects a data set of meshes, repairs or refuses each one, centres and scales it.

Reads the source named by meshes.source (household: fetched by hash once; folder: a person's own files).
Writes data/meshes/NAME.npz, manifest.csv (what each mesh is) and refused.csv (what was left out and why).
"""

import hashlib
import sys

import numpy as np
import pandas as pd
from scipy.sparse.csgraph import connected_components

from stages.kit import StageRun, Stopwatch, arguments, params
from stages.kit.fetch import FetchError
from stages.kit.files import write_mesh, write_table

from .clean import clean
from .load import MeshError, parse
from .normalise import normalise, turn_up
from .sources import SOURCES

REFUSED = ["object", "file", "reason"]


def collect(item, folder):
    """Reads, repairs and stores one item; returns (manifest row, None), or (None, refusal) with the reason."""
    try:
        content = item.content()
        raw, notes = clean(parse(content, item.suffix))
        mesh = normalise(turn_up(raw, item.up))
    except (MeshError, FetchError, ValueError, OSError) as error:
        return None, {"object": item.name, "file": item.file, "reason": str(error)}
    write_mesh(folder / f"{item.name}.npz", mesh)
    used = np.unique(mesh.faces)
    counts = mesh.edge_counts[1]
    parts = connected_components(mesh.adjacency[used][:, used])[0]
    row = {
        "object": item.name, "file": item.file, "licence": item.licence, "unit": item.unit, "up": item.up,
        "size": float(np.ptp(raw.vertices[np.unique(raw.faces)], axis=0).max()),
        "vertices": len(mesh.vertices), "faces": len(mesh.faces), "parts": int(parts), "watertight": mesh.watertight,
        "open_edges": int((counts == 1).sum()), "nonmanifold_edges": int((counts > 2).sum()),
        "colors": mesh.colors is not None, "repairs": "; ".join(notes), "sha256": hashlib.sha256(content).hexdigest(),
    }  # fmt: skip
    return row, None


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
            with Stopwatch() as watch:
                row, refusal = collect(item, run.folder)
            if refusal:
                print(f"meshes: refused {item.file}: {refusal['reason']}", file=sys.stderr)
                refused.append(refusal)
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
