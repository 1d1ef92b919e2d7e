"""Prints the places of one mesh that people look at first, or that are worth touching.

The places are the same as those of `haptic-glance saliency`, most salient first: vertex, position in the file's
coordinates, score from 0 to 1. `haptic-glance touch --at` accepts these positions.

examples:
  haptic-glance points scan.stl
  haptic-glance points chair.glb --count 5 --json
  haptic-glance points scan.stl --up y --out points.csv
  haptic-glance points scan.stl --purpose touch --count 6
"""

import argparse
from collections.abc import Sequence
from pathlib import Path

from .saliency import look_at, shared_parser


def parser() -> argparse.ArgumentParser:
    """The parser of the command line."""
    command = shared_parser("points", __doc__ or "")
    command.add_argument("--out", dest="points", metavar="FILE", type=Path, help="write the points as CSV, too")
    command.set_defaults(out=None, picture=None, weights=None)
    return command


def run(argv: Sequence[str]) -> None:
    """Runs the command line `argv`, without the program's name."""
    look_at(parser().parse_args(argv))
