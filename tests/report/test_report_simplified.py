"""Units that say nothing about kept points, and the table of points and rings, on made rows."""

from time import perf_counter
from typing import Any

import numpy as np
import pandas as pd
import pytest

from stages.report import meshes
from stages.report.meshes import tables
from stages.report.pareto import AS_PLAIN, NO_POINT, NO_RING, UNIT, invalid_units
from stages.report.results import SECTION_3_1
from stages.report.topics import build_one

ERRORS = ("metro_mean", "ssim_error")


def unit(item, method, target="1500", points=10, kept=10, rings=3.0, errors=(0.2, 0.3), shrunk=None):
    """The rows of one mesh: the number of faces and two errors."""
    common = {"item": item, "method": method, "target": target, "points": points, "kept": kept, "rings": rings}
    common |= {"shrunk": points > 0 and rings < 3 if shrunk is None else shrunk, "infeasible": False, "note": ""}
    values = {"faces": int(target)} | dict(zip(ERRORS, errors, strict=True))
    return [common | {"metric": metric, "value": value} for metric, value in values.items()]


PLAIN: dict[str, Any] = {"points": 0, "kept": 0, "rings": np.nan, "errors": (0.1, 0.15)}
QEM = unit("a", "qem", **PLAIN) + unit("a", "qslim", **PLAIN)


def cause(method, **fields):
    """The cause for which one unit beside plain QEM is invalid, None for a valid one."""
    found = invalid_units(pd.DataFrame(QEM + unit("a", method, **fields)))
    assert set(found.index) <= {("a", method, fields.get("target", "1500"))}
    return found.get(("a", method, "1500"))


def test_a_mesh_that_keeps_three_rings_is_valid():
    assert cause("itti") is None


def test_a_method_without_a_point_is_invalid_whatever_its_error():
    assert cause("SymRad", points=0, kept=0, rings=np.nan) == NO_POINT
    assert cause("SymRad", **PLAIN) == NO_POINT


def test_plain_simplification_and_weights_keep_nothing_by_design():
    assert not len(invalid_units(pd.DataFrame(QEM)))
    assert cause("glance-soft", points=0, kept=0, rings=np.nan) is None


def test_a_mesh_with_all_errors_of_plain_is_invalid_and_with_one_other_it_is_not():
    assert cause("itti", errors=PLAIN["errors"]) == AS_PLAIN
    assert cause("glance-soft", points=0, kept=0, rings=np.nan, errors=PLAIN["errors"]) == AS_PLAIN
    assert cause("itti", errors=(PLAIN["errors"][0], 0.2)) is None


def test_less_than_one_ring_in_the_mean_is_invalid():
    assert cause("harris", rings=0.9) == NO_RING
    assert cause("harris", rings=1.0) is None
    assert cause("harris", kept=0, rings=np.nan) == NO_RING


def test_plain_of_the_same_object_and_target_alone_is_compared():
    rows = pd.DataFrame(
        QEM + unit("b", "qem", **PLAIN | {"errors": (0.5, 0.6)}) + unit("b", "itti", errors=(0.1, 0.15))
    )
    assert not len(invalid_units(rows))


def test_units_without_a_mesh_are_left_out():
    rows = pd.DataFrame(QEM + unit("a", "SymRad", points=0, rings=np.nan, errors=(np.nan, np.nan)))
    rows.loc[rows["method"] == "SymRad", "value"] = np.nan
    assert not len(invalid_units(rows))


def test_causes_of_a_set_of_many_objects_take_a_moment():
    base = pd.DataFrame(QEM + [row for k in range(30) for row in unit("a", f"m{k}", rings=k / 10)])
    rows = pd.concat([base.assign(item=f"o{k}") for k in range(500)], ignore_index=True)
    begin = perf_counter()
    found = invalid_units(rows)
    assert perf_counter() - begin < 2 and found.eq(NO_RING).sum() == len(found) == 500 * 10


@pytest.fixture
def made():
    """Four objects: SymRad finds a point on one, harris keeps 0 to 1.5 rings, itti three on all but one."""
    rows = []
    for k, item in enumerate("abcd"):
        for target in ("3000", "1500"):
            rows += unit(item, "qem", target, **PLAIN)
            radial = {"points": 4, "kept": 4} if k == 0 else PLAIN
            rows += unit(item, "SymRad", target, **radial)
            rows += unit(item, "harris", target, points=100, kept=50, rings=k / 2 if target == "1500" else 2.5)
            rows += unit(item, "itti", target, points=20 + k, rings=2.0 if k == 3 else 3.0)
            rows += unit(item, "itti-area", target, points=20, rings=7.0)
    return pd.DataFrame(rows)


def test_the_numbers_of_points_and_rings(made):
    found = tables.counted(made).set_index(["method", "target"])
    assert list(dict.fromkeys(found.index.get_level_values("method"))) == ["harris", "itti", "SymRad"]
    assert found.loc[("SymRad", "1500")].to_dict() == {
        "objects": 4, "points": 0.0, "rings": 3.0, "without_points": 0.75, "three_rings": 0.25, "as_plain": 0.75,
    }  # fmt: skip
    assert found.loc[("harris", "1500"), ["points", "rings", "three_rings", "as_plain"]].tolist() == [100, 0.75, 0, 0]
    assert found.loc[("harris", "3000"), "rings"] == 2.5
    assert found.loc[("itti", "1500"), ["points", "rings", "three_rings"]].tolist() == [21.5, 3, 0.75]


def test_the_table_shows_the_printed_set_and_holds_all(made, bare, small):
    for name in ("test", "a", SECTION_3_1):
        small.write(bare, "lod", made.assign(dataset=name, asked=1, faces=1, seconds=np.nan))
    table = build_one(meshes, "tables", "lod_points", small.results(bare))
    assert list(table.frame["data"].unique()) == ["household as in T3.1", "test", "a"]
    shown = table.shown.set_index("kept points")
    assert list(shown.index) == ["3DH", "VisAtt", "SymRad"]
    assert float(shown.loc["SymRad", "without a point, %"]) == 75
    assert float(shown.loc["3DH", "rings, 3,000 faces"]) == 2.5 and shown.loc["3DH", "rings, 1,500 faces"] == "0.8"
    assert float(shown.loc["SymRad", "as plain, %, 1,500 faces"]) == 75


def test_every_unit_is_named_once(made):
    found = invalid_units(made)
    assert found.index.names == UNIT and found.index.is_unique
    assert found.value_counts().to_dict() == {NO_POINT: 6, NO_RING: 2}
