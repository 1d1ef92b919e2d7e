"""Attention of networks beside human gaze: `python -m benchmarks.fixation FOLDER`

FOLDER: a working tree in which `dvc repro fixation` ran on meshes with human gaze (`make fixation` leaves one in
build/fixation). Writes reports/fixation: gaze.csv (the rows of reports/measurements/fixation.csv without dataset and
seed, values to four digits), tasks.csv and elbow.csv (the classes of the meshes and how their number was found), and
the pictures of figures 3.29, 3.30 and 3.34 on these meshes, which the report then shows.
"""

from pathlib import Path

from benchmarks import arguments
from stages.kit.files import read_table, whole_file
from stages.kit.params import params
from stages.report.figures import figure_3_29, figure_3_30, figure_3_34
from stages.report.figures._kept import keep
from stages.report.results import Results

OUT = Path("reports/fixation")
FIGURES = (figure_3_29, figure_3_30, figure_3_34)


def write(name, frame):
    """Writes a table with four significant digits."""
    with whole_file(OUT / f"{name}.csv") as part:
        frame.to_csv(part, index=False, float_format="%.4g")
    print(f"{OUT / name}.csv: {len(frame):,} rows", flush=True)


def main():
    """Writes the three tables and the pictures."""
    folder = Path(arguments(__doc__, "folder").folder)
    rows = read_table(folder / "reports/measurements/fixation.csv")
    write("gaze", rows.drop(columns=["dataset", "seed"]))
    for name in ("tasks", "elbow"):
        write(name, read_table(folder / f"data/fixation/{name}.csv"))
    results = Results(params("report"), folder)
    for figure in FIGURES:
        name = figure.__name__.rpartition(".")[2]
        keep(figure.build(results), name, OUT)
        print(OUT / f"{name}.png", flush=True)


if __name__ == "__main__":
    main()
