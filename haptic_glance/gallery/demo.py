"""Looks at a sample mesh, simplifies it where nobody looks, touches it, and shows all of that on one page.

Needs no data and no network. Writes index.html, and the files that it shows, into the folder of --out. The sample is a
dromedary; `haptic-glance gallery FOLDER` makes the same page of meshes of your own.

examples:
  haptic-glance demo
  haptic-glance demo --out page --json
"""

import argparse
from collections.abc import Sequence
from pathlib import Path

from haptic_glance.base.files import check_folder
from haptic_glance.cli.arguments import command_parser
from haptic_glance.lod.export import levels

from .command import COUNT, LEVELS, commands, show

SAMPLE = "dromedary.glb"


def parser() -> argparse.ArgumentParser:
    """The parser of the command line."""
    command = command_parser("demo", __doc__ or "")
    text = "output folder (default: %(default)s)"
    command.add_argument("--out", metavar="FOLDER", type=Path, default=Path("haptic_glance_demo"), help=text)
    command.set_defaults(meshes=sample(), up=None, count=COUNT, levels=levels(LEVELS))
    command.add_argument("--json", action="store_true", help="print what was made as JSON")
    return command


def run(argv: Sequence[str]) -> int:
    """Runs the command line `argv`, without the program's name; returns the exit status."""
    options = parser().parse_args(argv)
    check_folder(options.out, f"--out {options.out}")
    status = show("demo", "Haptic Glance: a demo", options, options.out)
    if not options.json:
        print("\n".join(["the same with a mesh of your own:", *(f"  {line}" for line in commands(options))]))
    return status


def sample() -> Path:
    """The sample mesh: inside this package where a wheel is installed, in samples/ of a checkout."""
    package = Path(__file__).parents[1]
    installed = package / "samples" / SAMPLE
    return installed if installed.is_file() else package.parent / "samples" / SAMPLE
