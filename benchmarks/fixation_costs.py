"""What training every layer costs and gains where networks look: `python -m benchmarks.fixation_costs FOLDER`

FOLDER: a working tree in which `dvc repro fixation` ran on meshes with human gaze, with fine-tuned networks beside the
frozen (`make fixation` leaves one in build/fixation). Writes reports/fixation/costs.csv: of its measurements the rows
of seconds and of what EWIGC agrees with people in each view, values to four digits, for the chart of accuracy against
cost.
"""

from pathlib import Path

from benchmarks import arguments
from benchmarks.fixation import write
from stages.fixation.judge import WHOLE
from stages.kit.files import read_table

MODEL = "ewigc"


def costs(rows):
    """The rows that the chart reads."""
    agreement = (rows["metric"] == "pcc") & (rows["task"] == MODEL) & (rows["view"].astype(str) != WHOLE)
    return rows[agreement | rows["metric"].isin(["views", "accuracy"])].drop(columns=["dataset", "seed"])


def main():
    """Writes the table."""
    folder = Path(arguments(__doc__, "folder").folder)
    write("costs", costs(read_table(folder / "reports/measurements/fixation.csv")))


if __name__ == "__main__":
    main()
