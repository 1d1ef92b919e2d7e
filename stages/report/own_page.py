"""The front page of a run on a person's own folder: that of `haptic-glance gallery`, from the pipeline's data."""

import shlex
import shutil
from collections.abc import Sequence
from contextlib import suppress
from pathlib import Path

import numpy as np

from haptic_glance.base.files import write_text
from haptic_glance.cli.saliency import as_csv, points_of
from haptic_glance.gallery.exhibit import Exhibit, Level
from haptic_glance.gallery.page import build_page
from haptic_glance.lod import vertex_errors
from haptic_glance.lod.export import write_any
from haptic_glance.lod.mesh_pictures import coloured, look
from haptic_glance.look.points import Detection
from haptic_glance.look.points.find import scores_of
from haptic_glance.touch.places import UserMesh
from stages.charts.results import NotRun, Results
from stages.imprints.imprints import read_imprints
from stages.lod.levels import levels_of
from stages.salient_points.measure import read_points, read_saliency

from .topics import TOPICS

MODEL, COUNT = "glance", 6  # whose places and levels are shown, else those of the first method; and how many places
UNITS = "units of the object's diameter"


def write_own_page(results: Results, pages: Sequence[str], out: Path) -> None:
    """Writes OUT/index.html and a folder of files a mesh below OUT/site; pages: the names of the site's other pages."""
    for path in filter(Path.is_dir, (out / "site").iterdir()):
        shutil.rmtree(path)
    exhibits, missing = [], dict(_refused(results))
    for name in results.objects:
        try:
            exhibits.append(exhibit_of(results, name, out / "site" / name))
        except NotRun as error:
            missing[name] = str(error)
    links = " ".join(f'<a href="site/{page}.html">{TOPICS[page].title}</a>' for page in pages)
    section = f'<section id="tables"><h2>Tables and charts</h2><p>{links}</p></section>' if links else ""
    folder = results.workspace.params[results.sets[0]]["meshes"].get("folder", "FOLDER")
    text = build_page("Your meshes", exhibits, missing, [f"haptic-glance gallery {shlex.quote(folder)}"], out, section)
    write_text(out / "index.html", text)


def exhibit_of(results: Results, name: str, folder: Path) -> Exhibit:
    """The findings of the pipeline on one object; its files are written into a folder. NotRun where it has no places.

    Levels and imprints that were not made are named among the missing.
    """
    mesh, by_method = results.mesh(name), results.by_method("salient_points", read_saliency, name)
    model = MODEL if MODEL in by_method else by_method.those_of(list(by_method))[0]
    saliency, vertices = by_method[model], results.by_method("salient_points", read_points, name)[model][:COUNT]
    points = points_of(mesh, Detection(vertices, None, saliency, scores_of(mesh, vertices, saliency)))
    folder.mkdir(parents=True)
    write_any(folder / "saliency.ply", coloured(mesh, saliency))
    write_text(folder / "points.csv", as_csv(points, mesh))
    levels, touches, images, missing = [], [], [], {}
    try:
        for target, level in levels_of(results, name, f"{model}-soft"):
            path = folder / f"{name}_{target.replace('%', 'pct')}.ply"
            write_any(path, level)
            levels.append(Level(level, 100 * vertex_errors(level, mesh) / mesh.diagonal, path))
    except NotRun as error:
        missing["levels"] = str(error)
    with suppress(NotRun, KeyError):
        touched = read_imprints(results.folder("imprints") / f"{name}.npz")[model]
        images_by_vertex = dict(zip(touched.vertices.tolist(), touched.images, strict=True))
        ranks = [rank for rank, vertex in enumerate(vertices.tolist(), 1) if vertex in images_by_vertex]
        touches, images = [{"index": rank} for rank in ranks], [images_by_vertex[vertices[rank - 1]] for rank in ranks]
    return Exhibit(
        name, folder, folder, UserMesh(mesh, name), _axis(results, name), saliency, points, levels, missing, touches,
        np.array(images), look(mesh, saliency, vertices), UNITS,
    )  # fmt: skip


def _axis(results, name):
    """Which axis of the object's file was taken to point up. The manifest does not tell whether the shape decided."""
    return f"{results.table('meshes', 'manifest.csv').set_index('object')['up'][name]} is up in the file"


def _refused(results):
    """(file, why) of each file that the stage meshes refused."""
    with suppress(NotRun):
        for row in results.table("meshes", "refused.csv").itertuples():
            yield str(row.file), str(row.reason)
