"""Collects a data set of meshes, repairs or refuses each one, centres and scales it.

Reads the source that meshes.source names (household and furniture are fetched by hash; folder: your own files).
Writes data/SET/meshes: NAME.npz, manifest.csv (what each mesh is), refused.csv (what was left out and why) and, where
the settings name classes, classes.csv (the class of each object). A class that is left with fewer than two objects has
a note among the rows: no object of it can be held out.
"""

import dataclasses
import functools
import hashlib
import sys
from collections import defaultdict
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from haptic_glance.base.files import write_mesh, write_table
from haptic_glance.base.lazy import pandas as pd
from haptic_glance.base.timing import Stopwatch
from haptic_glance.mesh.axes import AUTO
from haptic_glance.mesh.headers import MeshError
from stages.engine.run import Rows, StageRun
from stages.engine.settings import Workspace, workspace_of_arguments

from . import Params
from .collect import CLASSES, chosen_objects, prepare_mesh, reads_beside, small_classes
from .sources import SOURCES, MeshFile

REFUSED = ["object", "file", "reason"]


def process(item: MeshFile, folder: Path, without_plane: bool, colours: str) -> Rows:
    """Prepares one mesh. Its row holds its line of the manifest or, where it is refused, the reason as `note`."""
    row = {"item": item.name, "metric": "faces", "value": None}
    try:
        with Stopwatch() as watch:
            mesh, entry = prepare_mesh(item, without_plane, colours)
            write_mesh(folder / f"{item.name}.npz", mesh)
    except MeshError as error:
        return [row | {"note": str(error)}]
    return [row | {"value": entry["faces"], "seconds": watch.seconds, "_manifest": entry}]


def content_hash(item: MeshFile, colours: str) -> str:
    """The hash of what a mesh is made of: its file, what the source says of it, and the files beside it in use.

    Unreadable files have one, too.
    """
    beside = {}
    try:
        content = item.content()
        beside = item.beside() if reads_beside(item, colours) else {}
    except (OSError, ValueError, RuntimeError) as error:
        content = str(error).encode()
    parts = (item.name, item.file, item.suffix, item.up, item.unit, item.licence, item.creator)
    digest = hashlib.sha256(repr(parts).encode() + content)
    for name, data in sorted(beside.items()):
        digest.update(name.encode() + data)
    return digest.hexdigest()


def up_axes(manifest: Sequence[Mapping[str, Any]]) -> str:
    """`z for 6, y for 1 (cup)`: the axes that point up in the files, the commonest first; names for the others."""
    names: dict[str, list[str]] = defaultdict(list)
    for entry in manifest:
        names[str(entry["up"])].append(entry["object"])
    first, *others = sorted(names.items(), key=lambda item: -len(item[1]))
    return ", ".join(
        [f"{first[0]} for {len(first[1])}", *(f"{axis} for {len(rest)} ({', '.join(rest)})" for axis, rest in others)]
    )


def run(workspace: Workspace) -> None:
    """Runs the stage on the data set of a workspace."""
    settings = workspace.settings(Params)
    source_settings = dataclasses.replace(settings, objects=chosen_objects(settings.objects, settings.classes))
    items = {item.name: item for item in SOURCES[settings.source](source_settings)}
    with StageRun(workspace, "meshes") as stage:
        work = functools.partial(process, without_plane=settings.remove_plane, colours=settings.colours)
        made_of = {name: content_hash(item, settings.colours) for name, item in items.items()}
        rows = stage.each(work, items, made_of=made_of)
        manifest = [row["_manifest"] for row in rows if "_manifest" in row]
        refused = [(row["item"], items[row["item"]].file, row["note"]) for row in rows if row["value"] is None]
        for _, file, reason in refused:
            print(f"meshes: refused {file}: {reason}", file=sys.stderr)
        if refused and settings.strict:
            raise ValueError("stopped: meshes.strict is set, and a mesh was refused")
        if not manifest:
            raise ValueError("every mesh was refused; none is left to work on")
        if settings.up == AUTO:
            print(f"meshes: {workspace.dataset}, up axes: {up_axes(manifest)}", file=sys.stderr)
        write_table(stage.folder / "manifest.csv", pd.DataFrame(manifest))
        write_table(stage.folder / "refused.csv", pd.DataFrame(refused, columns=REFUSED))
        if settings.classes:
            accepted = {entry["object"]: None for entry in manifest}  # quickly looked up, in order
            pairs = [
                (name, member) for name, objects in settings.classes.items() for member in objects if member in accepted
            ]
            write_table(stage.folder / CLASSES, pd.DataFrame(pairs, columns=["class", "object"]))
            stage.rows += small_classes(settings.classes, list(accepted))
        closed = sum(entry["watertight"] for entry in manifest)
        stage.metrics({"objects": len(manifest), "refused": len(refused), "watertight": closed})
    print(f"meshes: {workspace.dataset}, {len(manifest)} objects, {closed} watertight, {len(refused)} refused")


if __name__ == "__main__":
    run(workspace_of_arguments(__doc__, "meshes"))
