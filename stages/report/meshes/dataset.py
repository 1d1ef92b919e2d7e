"""What the run was made of: the objects, their size, and what was refused."""

from stages.report.items import Table
from stages.report.results import Results

COLUMNS = ["object", "vertices", "faces", "parts", "watertight", "repairs", "licence"]


def build(results: Results) -> Table:
    """One row per object of the first data set."""
    manifest, refused = (results.table("meshes", f"{name}.csv") for name in ("manifest", "refused"))
    frame = manifest[[column for column in COLUMNS if column in manifest]]
    named = "; ".join(f"{row.object} ({row.reason})" for row in refused.itertuples())
    words = {
        "count": len(frame), "least": frame["faces"].min(), "most": frame["faces"].max(),
        "closed": frame["watertight"].sum(), "refused": f"Refused: {named}." if named else "No mesh was refused.",
    }  # fmt: skip
    return Table(frame, frame.fillna("").assign(watertight=frame["watertight"].map({True: "yes", False: "no"})), words)
