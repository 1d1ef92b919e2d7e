"""Timings of the pipeline and its parts; each writes a table below reports/bench."""

import argparse
import statistics
import sys
import time
from pathlib import Path


def arguments(doc, *wanted, **optional):
    """The arguments of a benchmark, by name; answers --help with its docstring.

    wanted: names of those that must be given, in order; optional: further ones that may be, with what they are else;
    False for one that takes no value.
    """
    first, _, rest = doc.partition("\n")
    program, form = f"python -m benchmarks.{Path(sys.argv[0]).stem}", argparse.RawDescriptionHelpFormatter
    parser = argparse.ArgumentParser(prog=program, description=first, epilog=rest, formatter_class=form)
    for name in wanted:
        parser.add_argument(name)
    for name, default in optional.items():
        parser.add_argument(name, default=default, **{"action": "store_true"} if default is False else {"nargs": "?"})
    return parser.parse_args()


def reference_seconds():
    """Processor seconds of a fixed loop, plain Python and numpy, the median of nine: how fast this machine is now.

    Machines differ by two to three; seconds over these differ by less.
    """
    import numpy as np  # here: some benchmarks set the threads of its library first

    taken = []
    for _ in range(9):
        start = time.process_time()
        sum(k * k % 7 for k in range(300_000))
        np.sort(np.sin(np.arange(500_000.0)))
        taken.append(time.process_time() - start)
    return statistics.median(taken)
