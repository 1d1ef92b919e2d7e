"""The chart of kernels over commits."""

import pandas as pd

from stages.lod.kernel_history import kernels


def row(commit, hour, kernel, ratio, machine="here"):
    """A row of the history; ratio None for the reference loop."""
    ends = {} if ratio is None else {"low": 0.9 * ratio, "high": 1.1 * ratio, "limit": 1.5 * ratio}
    date = f"2026-11-21T{hour:02}:00:00+00:00"
    return {"commit": commit, "date": date, "what": kernel, "peer": f"peer of {kernel}", "ratio": ratio, **ends,
            "machine": machine}  # fmt: skip


def test_lines_are_those_of_the_machine_that_measured_last_by_date(measure):
    rows = [row("b", 2, "maps", 0.2), row("a", 1, "maps", 0.1), row("a", 1, "old", 5.0, "elsewhere")]
    rows.append(row("b", 2, "loop", None))
    made = kernels(measure("bench/history", pd.DataFrame(rows)))
    (bars,) = made.drawing.axes[0].containers
    assert bars.get_label() == "maps / peer of maps"
    assert bars.lines[0].get_xydata().tolist() == [[0, 0.1], [1, 0.2]]
    assert made.words == {"kernels": 1, "commits": 2, "machine": "here", "names": "maps (peer of maps)"}
