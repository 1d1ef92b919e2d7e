"""Networks for photographs on recorded touches: `python -m benchmarks.transfer IMAGES GRASPS [--networks NAME,...]`

IMAGES: the pressure images of Gandarias and others (a zip file or folder), GRASPS: BTS3 v2; --vitac, --vt60, --bigs:
folders of those data sets, where they are at hand. Each network learns from ImageNet's weights and from random ones,
frozen and fine-tuned, on random splits and on splits by runs, objects or recordings. Writes
reports/transfer/recorded.csv: every training, the k-nearest-neighbour classifier of reports/touch on the same splits,
and a row for each network and data set that was not run. What a killed start has finished stays in build/transfer.
Frozen networks: 20 minutes on two cores; --finetuned names those trained whole.
"""

import argparse
import functools
import sys
from pathlib import Path

import pandas as pd

from benchmarks import _transfer_trials as trials
from benchmarks._transfer_data import SOURCES
from benchmarks._transfer_neighbours import nearest_neighbours
from stages.kit.fetch import FetchError
from stages.kit.files import write_table
from stages.kit.parallel import parallel_map, progress
from stages.networks.device import DEVICES, choose
from stages.networks.weights import SOURCES as ORIGINS

OUT = Path("reports/transfer")
NETWORKS = ("mobilenet_v2", "alexnet", "efficientnet_lite0", "resnet50", "vgg16")  # from quick to slow
THESIS = ("alexnet", "googlenet", "vgg16", "resnet50", "mobilenet_v2")
SIZES = {"frozen": 96, "finetuned": 64}  # pixels a side; the thesis's 224 takes six and twelve times as long
COLUMNS = [
    "dataset", "object", "data", "method", "weights", "had", "mode", "size", "split", "repetition", "metric", "value",
    "seconds", "seed", "note",
]  # fmt: skip


def main():
    """Runs what is asked for and not yet done; writes the table, of all that is done, after every network anew."""
    given = options()
    paths = {source.argument: vars(given)[source.argument] for source in SOURCES.values()}
    rows = [*nearest_neighbours(), *not_at_hand(paths)]
    for mode, methods in (("frozen", given.networks), ("finetuned", given.finetuned)):
        for method in methods:
            rows += one_network(method, mode, paths, given)
            write([*rows, *trials.done(given.source)])


def options():
    """The arguments, by name."""
    first, _, rest = __doc__.partition("\n")
    form = argparse.RawDescriptionHelpFormatter
    parser = argparse.ArgumentParser("python -m benchmarks.transfer", None, first, rest, formatter_class=form)
    for name in ("images", "grasps"):
        parser.add_argument(name)
    for name in ("vitac", "vt60", "bigs"):
        parser.add_argument(f"--{name}", metavar="FOLDER")
    parser.add_argument("--networks", type=names, default=NETWORKS, metavar="NAME,...", help="to run frozen")
    parser.add_argument("--finetuned", type=names, default=NETWORKS[:1], metavar="NAME,...", help="to train whole")
    parser.add_argument(
        "--data", type=names, default=tuple(SOURCES), metavar="NAME,...", help=f"of {', '.join(SOURCES)}"
    )
    parser.add_argument("--weights", type=names, default=("imagenet", "random"), metavar="imagenet,random")
    parser.add_argument("--size", type=int, help=f"pixels a side, if not {SIZES}")
    parser.add_argument("--repetitions", type=int, default=5, help="of the frozen; fine-tuned are three at most")
    parser.add_argument("--device", choices=DEVICES, default="auto")
    parser.add_argument("--source", choices=ORIGINS, default="package", help="of ImageNet's weights")
    return parser.parse_args()


def names(text):
    """A list of names from a text with commas."""
    return tuple(name for name in text.split(",") if name)


def one_network(method, mode, paths, given):
    """Runs all trainings of a network in a mode; rows of what could not be run."""
    size, rows = given.size or SIZES[mode], []
    repetitions = given.repetitions if mode == "frozen" else min(given.repetitions, 3)
    for weights in given.weights:
        for data, source in SOURCES.items():
            if data not in given.data or not paths[source.argument]:
                continue
            work = functools.partial(trials.process, paths=paths, source=given.source, device=given.device)
            wanted = [
                trials.Trial(data, method, weights, mode, size, split, repetition)
                for split in source.splits
                for repetition in range(repetitions)
            ]
            try:
                run(work, wanted, f"{method} {weights} {mode} {data}", given.device)
            except FetchError as error:
                print(f"{method}: {error}", file=sys.stderr)
                rows.append(absent(data, method, weights, mode, "not run: weights not at hand"))
    return rows


def run(work, wanted, desc, device):
    """The first alone, since it caches the features; then the others, side by side where the processor works."""
    work(wanted[0])
    if wanted[0].mode == "frozen" or choose(device).type == "cpu":
        parallel_map(work, wanted[1:], desc)
    else:
        for trial in progress(wanted[1:], desc):
            work(trial)


def not_at_hand(paths):
    """Rows of the thesis's networks on the data sets that were not given."""
    for data, source in SOURCES.items():
        if not paths[source.argument]:
            for method in THESIS:
                for mode in SIZES:
                    yield absent(data, method, "imagenet", mode, "not run: data set not at hand")


def absent(data, method, weights, mode, note):
    """A row without a value."""
    known = {"dataset": SOURCES[data].dataset, "object": "all", "data": data, "method": method}
    return known | {"weights": weights, "mode": mode, "metric": "accuracy", "note": note}


def write(rows):
    """The table of all that is done."""
    frame = pd.DataFrame(rows).reindex(columns=COLUMNS)
    whole = ["repetition", "size", "seed"]
    frame[whole] = frame[whole].astype("Int64")
    write_table(OUT / "recorded.csv", frame)
    print(f"{OUT / 'recorded.csv'}: {len(frame):,} rows", flush=True)


if __name__ == "__main__":
    main()
