"""T table 3.2: errors of the simplified meshes."""

import numpy as np
import pandas as pd

from stages.report.intervals import summary
from stages.report.items import Table
from stages.report.lod_cells import cells
from stages.report.markdown import number, with_interval
from stages.report.style import label

METRICS = {"metro_mean": "Metro mean", "ssim_error": "SSIM error"}
KEY = ["target", "method", "metric"]
NOTES = [
    "Metro mean is the mean distance between the two surfaces over the bounding-box diagonal; SSIM error is one minus "
    "the structural similarity of renders. Each figure: mean over the objects [95 % interval over the objects].",
    "A target that leaves too few faces to tile the gaps between the kept islands is infeasible and has no error. So "
    "each row is over the objects that its method reaches (`objects`), with plain QEM on those same objects beside it: "
    "compare within a row, not down a column. The claims compare in pairs as well.",
    "The thesis's figures stand beside our run of its SSIM weights. They are means over the 43 models of the 3D "
    "interest point benchmark, cut to 3,000 and 1,500 faces; ours are everyday objects with fewer "
    "faces (see the data set). The same count is a gentler cut here, so shares of the original are measured too.",
    "Seconds: the simplification alone, of the median object; finding the points comes on top (see the chart of cost).",
]


def build(results):
    rows = cells(results, list(METRICS))
    found = pd.DataFrame(summary(rows, KEY)).rename(columns={"values": "objects"})
    plain = rows.groupby(KEY)["plain"].mean().reset_index()
    frame = _asked(results).merge(found, on=KEY, how="left").merge(plain, on=KEY, how="left")
    frame["objects"] = frame["objects"].fillna(0).astype(int)
    thesis = results.thesis("table_3_2_lod_errors").set_index(["method", "faces"])
    frame["thesis"] = [_printed(thesis, row) for row in frame.itertuples()]
    title = "Table 3.2: errors of simplified meshes, beside the thesis"
    return Table(title, frame, NOTES, _wide(frame))


def _asked(results):
    """Every target, method and metric that was asked for, in the order to show."""
    asked = results.measurements("lod", metric="faces")[["target", "method"]].astype(str).drop_duplicates()
    asked = asked.sort_values("target", key=lambda column: column.map(_size), kind="stable")
    return asked.merge(pd.DataFrame({"metric": list(METRICS)}), how="cross")


def _printed(thesis, row):
    """The thesis's figure, beside the run of its SSIM weights."""
    key = ("ssim", int(row.target) if row.target.isdigit() else 0)
    return thesis.loc[key, row.metric] if row.method == "thesis_ssim" and key in thesis.index else np.nan


def _size(target):
    """Shares before counts, large before small."""
    return (not target.endswith("%"), -float(target.rstrip("%")))


def _wide(frame):
    lines = []
    for (target, method), group in frame.groupby(["target", "method"], sort=False):
        line = {"target": f"{int(target):,} faces" if target.isdigit() else target, "kept points": label(method)}
        for row in group.itertuples():
            name = METRICS[row.metric]
            line[name] = with_interval(row.mean, row.low, row.high) if row.objects else "infeasible"
            line[f"plain QEM's {name}"] = number(row.plain)
            line[f"thesis's {name}"] = number(row.thesis)
        first = group.iloc[0]
        lines.append(line | {"objects": first["objects"], "seconds": number(first["seconds"])})
    return pd.DataFrame(lines)
