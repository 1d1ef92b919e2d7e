"""Which simplified meshes say something about the points that they keep."""

import pandas as pd

PLAIN, QSLIM = "qem", "qslim"  # plain simplification: with and without the fit of ours
UNIT = ["item", "method", "target"]
NO_POINT, AS_PLAIN, NO_RING = "no point found", "equal to plain simplification", "less than one ring kept"


def invalid_units(rows: pd.DataFrame) -> pd.Series:
    """The cause of each invalid unit, indexed by item, method and target: its error says nothing about its points.

    rows: those of the lod stage on one set, plain QEM among them. A unit is invalid where its method found no point,
    where all its errors equal plain QEM's, or where the kept points have less than one ring in the mean. Units without
    a mesh, and those of plain simplification, are neither valid nor invalid.
    """
    made = rows[rows["value"].notna() & ~rows["method"].isin([PLAIN, QSLIM])]
    units = made.drop_duplicates(UNIT).set_index(UNIT)
    keeps = ~units.index.get_level_values("method").str.endswith("-soft")  # the others weigh the error
    causes = {
        NO_POINT: keeps & (units["points"] == 0),
        AS_PLAIN: units.index.isin(as_plain(rows)),
        NO_RING: keeps & (units["rings"].fillna(0) < 1),
    }
    found = pd.Series(pd.NA, units.index, dtype="object", name="cause")
    for cause, invalid in causes.items():
        found = found.mask(found.isna() & invalid, cause)
    return found.dropna()


def as_plain(rows: pd.DataFrame) -> pd.MultiIndex:
    """The units, item, method and target, whose errors all equal plain QEM's."""
    keys = ["item", "target", "metric"]
    errors = rows[rows["value"].notna() & (rows["metric"] != "faces")]
    plain = errors.loc[errors["method"] == PLAIN, [*keys, "value"]]
    both = errors[~errors["method"].isin([PLAIN, QSLIM])].merge(plain, on=keys, suffixes=("", "_plain"))
    same = (both["value"] == both["value_plain"]).groupby([both[key] for key in UNIT]).all()
    return pd.MultiIndex.from_frame(same.index[same].to_frame())
