"""What the run was made of: the objects, their size, and what was refused."""

from stages.report.items import Table
from stages.report.results import Results

COLUMNS = ["object", "vertices", "faces", "parts", "watertight", "repairs", "licence"]


def build(results: Results) -> Table:
    """One row per object of the first data set."""
    manifest = results.table("meshes", "manifest.csv")
    refused = results.table("meshes", "refused.csv")
    frame = manifest[[column for column in COLUMNS if column in manifest]].copy()
    faces = f"{frame['faces'].min():,} to {frame['faces'].max():,} faces"
    closed = int(frame["watertight"].sum())
    notes = [f"{len(frame)} objects, {faces}, {closed} of them watertight. Open ones take part in everything."]
    named = "; ".join(f"{row.object} ({row.reason})" for row in refused.itertuples())
    notes.append(f"Refused: {named}." if named else "No mesh was refused.")
    shown = frame.fillna("").assign(watertight=frame["watertight"].map({True: "yes", False: "no"}))
    return Table("The data set", frame, notes, shown)
