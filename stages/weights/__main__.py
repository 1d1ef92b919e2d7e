"""Writes the weight of each conspicuity channel in the saliency map (T3.2.1, T3.2.2).

Reads nothing but its settings. Writes data/weights/weights.csv: method, channel, weight, chosen.
"""

from stages.kit import StageRun, arguments, params
from stages.kit.files import write_table

from . import weight_table


def main():
    arguments(__doc__)
    settings = params("weights")
    table = weight_table(settings.methods, settings.method)
    with StageRun("weights") as run:
        write_table(run.folder / "weights.csv", table)
    channels = table.channel.nunique()
    print(f"weights: {len(settings.methods)} methods of {channels} channels, {settings.method} chosen")


if __name__ == "__main__":
    main()
