"""Names of version 1 that went in 2.0, and what to use. A later version drops this table."""

from collections.abc import Mapping

SUMMED = (
    "VisAtt", "VisAttCon", "VisAttCurv", "VisAttSym", "VisAttCurvSym", "VisAttCurvSymCon", "VisAttEnt", "VisAttAll",
    "VisAttNoColour", "VisAttAllNoColour", "VisAttCurvP", "VisAttSymP",
)  # fmt: skip
GRID = "use press_forces, whose array is a grid"
GONE = {
    **{f"{name}Summed": f"use {name}+sums" for name in SUMMED},
    **{f"random_{draw}": f"use random+{draw}" for draw in range(2, 6)},
    **{f"svm_{kind}": f"use svm+{kind}" for kind in ("nearest", "seen", "object", "viewpoint")},
    "guided_ssim_object": "use guided_ssim+object",
    "guided_ssim_seen": "use guided_ssim+seen",
    "guided_ed_seen": "use guided_ed+seen",
    "layout_forces": GRID,
    "read_layout": GRID,
}


def went(name: str, table: Mapping[str, str] = GONE) -> str:
    """`NAME went in 2.0; use ...` for a name of the table, in capitals or not; empty for any other."""
    known = {key.lower(): key for key in table}
    key = known.get(name.lower())
    return f"{key} went in 2.0; {table[key]}" if key else ""
