"""Timings of the pipeline and its parts; each writes a table below reports/bench."""

import argparse
import sys
from pathlib import Path


def arguments(doc, *wanted, **optional):
    """The arguments of a benchmark, by name; answers --help with its docstring.

    wanted: names of those that must be given, in order; optional: further ones that may be, with what they are else.
    """
    first, _, rest = doc.partition("\n")
    program, form = f"python -m benchmarks.{Path(sys.argv[0]).stem}", argparse.RawDescriptionHelpFormatter
    parser = argparse.ArgumentParser(prog=program, description=first, epilog=rest, formatter_class=form)
    for name in wanted:
        parser.add_argument(name)
    for name, default in optional.items():
        parser.add_argument(name, nargs="?", default=default)
    return parser.parse_args()
