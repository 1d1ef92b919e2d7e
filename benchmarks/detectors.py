"""Takes the errors of a lod run over into reports/simplification: `python -m benchmarks.detectors FOLDER NAME`

FOLDER: a working tree in which `dvc repro lod` ran on another data set; NAME: what the table is called, princeton or
gaze. Writes reports/simplification/NAME.csv: the rows of reports/measurements/lod.csv without seconds, seed, notes and
what never changes, values to four digits.
"""

from pathlib import Path

from benchmarks import arguments
from stages.kit.files import read_table, whole_file

OUT = Path("reports/simplification")
COLUMNS = ["object", "method", "target", "faces", "points", "kept", "rings", "shrunk", "infeasible", "metric", "value"]


def main():
    """Writes the table."""
    given = arguments(__doc__, "folder", "name")
    rows = read_table(Path(given.folder) / "reports/measurements/lod.csv")[COLUMNS]
    for column in ("faces", "points", "kept"):
        rows[column] = rows[column].astype("Int64")
    with whole_file(OUT / f"{given.name}.csv") as part:
        rows.to_csv(part, index=False, float_format="%.4g")
    print(f"{OUT / given.name}.csv: {len(rows):,} rows of {rows['object'].nunique()} objects")


if __name__ == "__main__":
    main()
