"""Opens a page on which a mesh can be looked at, simplified, touched and marked.

The page is on this machine alone. The studio reads only the files and folders on the command line (STL, OBJ, PLY, OFF,
GLB, glTF, point clouds, scans, and .npz meshes of the pipeline) and the files that you upload in the page. With --mark,
a click marks what matters to a person: annotator, time (UTC), vertex, x, y, z on the mesh with z up, bounding-box
centre 0, bounding sphere of radius 0.5. Several people may mark one mesh; saving replaces only the rows of the
annotator who saves.

examples:
  haptic-glance studio bunny.stl
  haptic-glance studio scans --up y
  haptic-glance studio data/folder/meshes/vase.npz --mark data/annotations
  haptic-glance studio
"""

import argparse
import os
import sys
import time
import webbrowser
from collections.abc import Sequence
from pathlib import Path

from haptic_glance.base.extras import from_extra
from haptic_glance.cli.arguments import command_parser
from haptic_glance.mesh.up import add_up

from .specimen import files_at

PORT, MOST_PORT = 8062, 65535


def parser() -> argparse.ArgumentParser:
    """The parser of the command line."""
    command = command_parser("studio", __doc__ or "")
    command.add_argument("meshes", metavar="MESH", nargs="*", type=Path, help="a mesh file, or a folder of them")
    command.add_argument("--port", type=port, default=PORT, help="port (default: %(default)s or the next free; 0: any)")
    command.add_argument("--no-browser", action="store_true", help="print the address alone")
    command.add_argument("--mark", metavar="FOLDER", type=Path, help="mark points, to FOLDER/MESH.csv")
    command.add_argument("--annotator", metavar="NAME", default="", help="who marks (default: the page asks)")
    add_up(command)
    return command


def port(text: str) -> int:
    """A port from its number; the server would not end on one out of range."""
    if not text.isdecimal() or int(text) > MOST_PORT:
        raise argparse.ArgumentTypeError(f"{text!r}: give a number of 0..{MOST_PORT}")
    return int(text)


def run(argv: Sequence[str]) -> None:
    """Runs the command line `argv`, without the program's name, until Ctrl-C."""
    options = parser().parse_args(argv)
    files = [file for place in options.meshes for file in files_at(place)]
    with from_extra():
        from .app import Studio
        from .session import Settings
    marking = {"marks": options.mark, "panel": "Mark"} if options.mark else {}
    studio = Studio(Settings(files, options.up, annotator=options.annotator, **marking), options.port)
    print(f"studio: open {studio.address} ; Ctrl-C here ends it", flush=True)
    # Without a screen the standard library would open a text browser in this terminal.
    screen = sys.platform in ("darwin", "win32") or {"DISPLAY", "WAYLAND_DISPLAY", "BROWSER"} & set(os.environ)
    if screen and not options.no_browser:
        webbrowser.open(studio.address)
    try:
        while True:
            time.sleep(3600)
    except KeyboardInterrupt:
        print("ended")
    finally:
        studio.stop()
