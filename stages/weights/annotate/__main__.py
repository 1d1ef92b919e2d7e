"""Opens a web page on this machine on which a person marks the points of a mesh that matter to them.

The points go to FOLDER/NAME.csv: annotator, time (UTC), vertex, x, y, z on the normalised mesh (bounding-box centre 0,
bounding sphere of radius 0.5). Several people may mark one mesh; saving replaces the rows of one of them.
"""

import argparse
import os
import sys
import webbrowser
from pathlib import Path

from stages.kit import Mesh
from stages.kit.command import errors_in_one_line
from stages.kit.files import read_mesh
from stages.kit.run import object_names
from stages.kit.workspace import Workspace
from stages.meshes import load, normalise, rotate_to_z_up
from stages.meshes.up import add_up, upright_by

from .server import HOST, open_server

PORT = 8062


def find_mesh(text: str, workspace: Workspace, up: str | None = None) -> tuple[str, Mesh]:
    """(name, upright normalised mesh) of a mesh file or of an object; ValueError names the objects there are.

    up: the axis that points up in a file, None for its own; the objects of a data set are upright.
    """
    known, path, meshes = object_names(workspace), Path(text), workspace.data / "meshes"
    if text in known:
        if up:
            raise ValueError(f"--up {up} is for files: the object {text!r} is upright, z up")
        return text, read_mesh(meshes / f"{text}.npz")
    if not path.is_file():
        there = ", ".join(known) or f"none; `dvc repro meshes@{workspace.dataset}` fills {meshes}"
        raise ValueError(f"{text!r} is neither a mesh file nor an object; objects: {there}")
    mesh, note = upright_by(load(path), path, up)
    print(f"{path.stem}: {note}", file=sys.stderr)
    return path.stem, normalise(rotate_to_z_up(mesh))


def main() -> None:
    """Serves the page of the mesh that the command line names."""
    first, _, rest = (__doc__ or "").partition("\n")
    form = argparse.RawDescriptionHelpFormatter
    parser = argparse.ArgumentParser(
        "python -m stages.weights.annotate", description=first, epilog=rest, formatter_class=form
    )
    parser.add_argument("dataset", metavar="SET", help="the data set of the object")
    parser.add_argument("mesh", metavar="MESH", help="the name of an object in data/SET/meshes, or a mesh file")
    parser.add_argument("--annotator", metavar="NAME", default="", help="who marks (default: the page asks)")
    parser.add_argument("--port", type=int, default=PORT, help=f"default {PORT}; 0 takes any free one")
    parser.add_argument("--folder", default="data/annotations", help="where the points go (default: %(default)s)")
    add_up(parser)
    chosen = parser.parse_args()
    errors_in_one_line("annotate")
    name, mesh = find_mesh(chosen.mesh, Workspace(Path("."), chosen.dataset), chosen.up)
    server = open_server(name, mesh, chosen.folder, chosen.annotator, chosen.port)
    address = f"http://{HOST}:{server.server_port}/"
    try:
        print(f"{name}: mark points at {address} ; Ctrl+C here ends it", flush=True)
        # Without a screen the standard library would open a text browser in this terminal.
        if sys.platform in ("darwin", "win32") or {"DISPLAY", "WAYLAND_DISPLAY", "BROWSER"} & set(os.environ):
            webbrowser.open(address)
        server.serve_forever()
    except KeyboardInterrupt:
        print("ended")


if __name__ == "__main__":
    main()
