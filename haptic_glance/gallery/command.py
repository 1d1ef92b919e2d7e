"""Shows a folder of meshes on one page: where people look, fewer faces, what a pressure array feels.

Reads every STL, OBJ, PLY, OFF, GLB and glTF of FOLDER, with the extra `pipeline` also point clouds, or one file. Writes
into the folder of --out:
  index.html    all meshes on a page that needs no network: turnable, with their points, imprints and levels
  NAME/         of each mesh: saliency.ply (a coloured copy), points.csv, its levels, imprints.npz and places.csv
A file that holds no usable mesh is named, and the others go on; the exit status is then 1.

examples:
  haptic-glance gallery scans
  haptic-glance gallery scans --up y --levels 5000,1000 --count 10 --out page
  haptic-glance gallery chair.glb --json
"""

import argparse
import json
import os
from collections.abc import Sequence
from pathlib import Path

from haptic_glance.base.errors import DEBUG
from haptic_glance.base.files import write_text
from haptic_glance.base.progress import report
from haptic_glance.base.timing import WallClock
from haptic_glance.cli.arguments import check_output_folder, command_parser
from haptic_glance.lod.export import levels
from haptic_glance.lod.task import number
from haptic_glance.mesh.files import mesh_files, names_of
from haptic_glance.mesh.up import add_up

from .exhibit import Exhibit, exhibit
from .page import build_page

LEVELS, COUNT, PAGE = "50%,25%,10%", 6, "index.html"


def parser() -> argparse.ArgumentParser:
    """The parser of the command line."""
    command = command_parser("gallery", __doc__ or "")
    command.add_argument("meshes", metavar="FOLDER", type=Path, help="the folder of the meshes, or one file")
    command.add_argument("--out", metavar="FOLDER", type=Path, help="output folder (default: FOLDER_gallery)")
    add_up(command)
    help_levels = "face counts or shares (default: 50%%,25%%,10%%)"
    command.add_argument("--levels", metavar="N,N,...", type=levels, default=levels(LEVELS), help=help_levels)
    command.add_argument("--count", metavar="N", type=int, default=COUNT, help="places a mesh (default: %(default)s)")
    command.add_argument("--json", action="store_true", help="print what was made as JSON")
    return command


def run(argv: Sequence[str]) -> int:
    """Runs the command line `argv`, without the program's name; returns the exit status."""
    options = parser().parse_args(argv)
    if options.count < 1:
        raise ValueError(f"--count {options.count}: give 1 or more")
    place = options.meshes.resolve()
    name = place.name if place.is_dir() else place.stem
    out = options.out or Path(f"{name}_gallery")
    check_output_folder(out, options.meshes)
    return show("gallery", f"Gallery of {name}", options, out)


def show(name: str, title: str, options: argparse.Namespace, out: Path) -> int:
    """Makes the page and the files of meshes, prints what was made, returns the exit status.

    options: meshes (a file or a folder), up, count, levels, json. Where a person stops it (Ctrl-C), the page shows what
    is done.
    """
    files = mesh_files(options.meshes)
    exhibits: list[Exhibit] = []
    failures: dict[str, str] = {}
    try:
        for number, (file, label) in enumerate(zip(files, names_of(files), strict=True), 1):
            report(name, f"{number} of {len(files)}: {file.name}")
            try:
                with WallClock() as watch:
                    exhibits.append(exhibit(file, label, out / label, options.up, options.count, options.levels))
                report(name, f"{file.name}: {watch.seconds:.1f} s")
                for target, reason in exhibits[-1].missing.items():
                    report(name, f"{file.name} has no level {target}: {reason}")
            except Exception as error:  # one mesh must not cost the others theirs
                if os.environ.get(DEBUG):
                    raise
                failures[file.name] = " ".join(str(error).split()) or type(error).__name__
                report(name, f"{file.name} is left out: {failures[file.name]}")
    finally:
        if exhibits:
            write_text(out / PAGE, build_page(title, exhibits, failures, commands(options), out))
    if exhibits or options.json:
        print(json.dumps(figures(exhibits, failures)) if options.json else listing(exhibits, out))
    if failures:  # their reasons stand far above the last lines
        report(name, f"{len(failures)} of {len(files)} are left out: {', '.join(failures)}")
    return 1 if failures else 0


def commands(options: argparse.Namespace) -> list[str]:
    """The three commands that do the same with one mesh."""
    mesh = f"YOUR_MESH.stl{f' --up {options.up}' if options.up else ''}"
    return [
        f"haptic-glance saliency {mesh} --count {options.count} --out saliency.ply --points points.csv",
        f"haptic-glance simplify {mesh} --levels {','.join(options.levels)} --out levels",
        f"haptic-glance touch {mesh} --count {options.count} --out touched",
    ]


def figures(exhibits: Sequence[Exhibit], failures: dict[str, str]) -> list[dict[str, object]]:
    """The results, a dict per mesh; of a failure its file and the reason."""
    rows: list[dict[str, object]] = [
        {
            "mesh": str(item.file), "folder": str(item.folder), "faces": len(item.touched.mesh.faces),
            "points": len(item.points), "levels": [len(level.mesh.faces) for level in item.levels],
            "touches": len(item.touches), "missing": item.missing,
        }
        for item in exhibits
    ]  # fmt: skip
    return rows + [{"mesh": name, "error": reason} for name, reason in failures.items()]


def listing(exhibits: Sequence[Exhibit], out: Path) -> str:
    """The results, for people."""
    lines = [
        f"{item.folder}: {number(len(item.points), 'place')}, {number(len(item.levels), 'level')}, "
        f"{number(len(item.touches), 'imprint')}"
        for item in exhibits
    ]
    return "\n".join([*lines, f"open {out / PAGE}"])
