"""Is a kernel slower than it was? `python -m benchmarks.kernels [--check]`, on one core, about a minute and a half.

Times each kernel and a named peer in turns, in one process: the ratio of both is nearly the same on a busy machine.
Appends to reports/bench/history.csv a row a kernel: commit (HEAD, or HEAD+DIGEST of changed code), its date, what,
peer, ratio (ours over the peer's processor time, the median of the pairs), low and high (their quartiles), limit (what
the ratio may be from here on), seconds (of ours) and machine. Rows of the same commit and machine are replaced. The row
`reference loop` has processor seconds alone, of a fixed loop: seconds over these can be compared between machines.

--check writes nothing: it compares with the last committed rows of this model of machine, or, with a wider band, of
others, measures again what looks slow, and exits 1 with the names of the kernels that became slower.
"""

import os
import sys
import time

import cv2
import numpy as np
from threadpoolctl import threadpool_limits

from benchmarks import arguments, reference_seconds
from haptic_glance.base.files import write_table

from ._history import HISTORY, TOLERANCE, committed, machine, slower, updated, version
from ._kernel_cases import CASES

SECONDS = 1.0  # of the processor for the pairs of a kernel
PAIRS = (7, 25)  # but at least and at most so many


def measured(kernel: str) -> dict:
    """The row of one kernel, without commit and machine."""
    peer, case = CASES[kernel]
    ours, theirs = case()
    with threadpool_limits(1):  # after the case has loaded its libraries
        seconds = in_pairs(ours, theirs)
    low, ratio, high = np.quantile(seconds[:, 0] / seconds[:, 1], [0.25, 0.5, 0.75])
    print(f"kernels: {kernel}: {ratio:.3g} [{low:.3g}, {high:.3g}] of the time of {peer}", flush=True)
    row = {"what": kernel, "peer": peer, "ratio": ratio, "low": low, "high": high, "limit": TOLERANCE * high}
    return row | {"seconds": np.median(seconds[:, 0])}


def in_pairs(*calls) -> np.ndarray:
    """(pairs, 2) processor seconds of two calls in turns, which goes first alternating; kernels are compiled before."""
    for call in 2 * calls:
        call()
    pairs = []
    while len(pairs) < PAIRS[0] or (np.sum(pairs) < SECONDS and len(pairs) < PAIRS[1]):
        pair = np.empty(2)
        for place in (0, 1) if len(pairs) % 2 else (1, 0):
            start = time.process_time()
            calls[place]()
            pair[place] = time.process_time() - start
        pairs.append(pair)
    return np.array(pairs)


def main() -> None:
    """Writes the rows, or checks against the committed ones."""
    check = arguments(__doc__, **{"--check": False}).check
    os.sched_setaffinity(0, {min(os.sched_getaffinity(0))})
    cv2.setNumThreads(1)
    if check:
        lines = slower(committed(), machine(), CASES, measured)
        if lines:
            sys.exit("\n".join(f"kernels: {line}" for line in lines))
        print(f"kernels: none is slower than in {HISTORY}")
        return
    where = version() | {"machine": machine()}
    rows = [*map(measured, CASES), {"what": "reference loop", "seconds": reference_seconds()}]
    write_table(HISTORY, updated([where | row for row in rows]))


if __name__ == "__main__":
    main()
