"""The cost of an image for each network: `python -m benchmarks.networks`

Untrained networks with ten classes, images of 96 and 224 pixels a side; weights change none of this. Writes
reports/bench/networks.csv: a row a network and size, with parameters, multiply-adds and milliseconds of one image on
one thread (the median of nine passes, the thread's own time).
"""

import platform
from pathlib import Path

import pandas as pd

from benchmarks import arguments
from haptic_glance.base.files import write_table
from haptic_glance.deep.device import cost
from haptic_glance.deep.network import NETWORKS, build
from stages.engine.parallel import progress

OUT = Path("reports/bench/networks.csv")
SIZES = (96, 224)  # pixels a side: of the recorded touches here, of the thesis
CLASSES = 10


def main():
    """Measures and writes the table."""
    arguments(__doc__)
    rows = [
        {"network": name, "size": size} | cost(build(name, CLASSES, "random", 0), size)
        for name in progress(NETWORKS, "networks")
        for size in SIZES
    ]
    frame = pd.DataFrame(rows).assign(machine=f"{platform.machine()}, Python {platform.python_version()}")
    write_table(OUT, frame)
    print(frame.to_string(index=False))


if __name__ == "__main__":
    main()
