"""The objects of a data set."""

from stages.charts.items import Table
from stages.charts.results import Results


def objects_table(results: Results) -> Table:
    """The objects of the run: one row per object of the first data set, and what was refused."""
    manifest, refused = (results.table("meshes", f"{name}.csv") for name in ("manifest", "refused"))
    frame = manifest.filter(["object", "vertices", "faces", "parts", "watertight", "repairs", "licence"])
    refusals = "; ".join(f"{row.object} ({row.reason})" for row in refused.itertuples())
    words = {
        "count": len(frame), "least": frame["faces"].min(), "most": frame["faces"].max(),
        "closed": frame["watertight"].sum(), "refused": f"Refused: {refusals}." if refusals else "No mesh was refused.",
    }  # fmt: skip
    text_table = frame.fillna("").assign(watertight=frame["watertight"].map({True: "yes", False: "no"}))
    return Table(frame, text_table, words)  # no ranking: objects do not compete


PAGE = "simplify"
TABLES = {
    "dataset": objects_table,
}
FIGURES = {}
CHARTS = {}
