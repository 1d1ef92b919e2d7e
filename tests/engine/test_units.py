"""What counts once: copies, classes and draws, and the coverage of the interval over them."""

from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from haptic_glance.base.files import read_mesh
from stages.engine.rows import by_unit, unit
from stages.engine.statistics import interval, p_value

MESHES = Path("data/household/meshes")
SIZES = ("small", "medium", "large")
PRIMITIVES = ("cube", "cylinder", "pyramid", "sphere", "torus")


def over(names, values):
    """A Series over items."""
    return pd.Series(values, index=pd.Index(names, name="item"), dtype=float)


@pytest.mark.parametrize(
    ("item", "name"),
    [("cubesmall", "cube"), ("toruslarge", "torus"), ("cube", "cube"), ("Airplane_61", "Airplane"), ("mug", "mug"),
     ("FourLeg_381", "FourLeg"), ("round_table", "round_table"), ("alien2", "alien2"), ("small", "small")],
)  # fmt: skip
def test_copies_are_of_one_shape_and_the_benchmark_s_names_tell_the_class(item, name):
    assert unit(item) == name


@pytest.mark.skipif(not MESHES.is_dir(), reason="no meshes of the household here")
def test_the_copies_are_those_that_normalisation_makes_equal():
    names = [path.stem for path in MESHES.glob("*.npz")]
    radii = {
        name: np.quantile(np.linalg.norm(read_mesh(MESHES / f"{name}.npz").vertices, axis=1), [0.1, 0.5, 0.9])
        for name in names
    }
    alike = {
        frozenset((a, b)) for a in names for b in names if a != b and np.abs(radii[a] - radii[b]).max() < 0.005
    }  # fmt: skip
    copies = {frozenset((a, b)) for a in names for b in names if a != b and unit(a) == unit(b)}
    assert copies and copies <= alike
    if len(names) == 50:
        assert len(set(map(unit, names))) == 40


def test_copies_give_the_same_interval_as_the_shapes_alone():
    values = np.random.default_rng(0).normal(1, 1, 10)
    shapes = [*PRIMITIVES, *"abcde"]
    alone = over(shapes, values)
    names = [f"{shape}{size}" for shape in PRIMITIVES for size in SIZES] + list("abcde")
    copied = over(names, [*np.repeat(values[:5], 3), *values[5:]])
    assert interval(copied) == pytest.approx(interval(alone))
    assert p_value(copied) == pytest.approx(p_value(alone))
    plain = interval(copied.to_numpy())
    assert plain[2] - plain[1] < 0.9 * (interval(copied)[2] - interval(copied)[1])  # as if they were fifteen shapes


def test_one_level_without_copies_is_the_plain_bootstrap():
    values = np.random.default_rng(1).normal(size=12)
    assert interval(over([f"object_{k}x" for k in range(12)], values)) == interval(values)


def test_levels_are_averaged_from_the_innermost_and_weigh_the_same():
    index = pd.MultiIndex.from_tuples(
        [("a", "x", 0), ("a", "x", 1), ("a", "y", 0), ("b", "z", 0)], names=["group", "object", "seed"]
    )
    found = by_unit(pd.Series([1.0, 3.0, 8.0, 10.0], index=index))
    assert found.to_dict() == {"a": 5.0, "b": 10.0}  # ((1 + 3) / 2 + 8) / 2, not (1 + 3 + 8) / 3


def test_items_within_classes_are_one_value_a_class():
    index = pd.MultiIndex.from_tuples([("p", "cubesmall"), ("p", "cubelarge"), ("p", "mug"), ("q", "cup")],
                                      names=["group", "item"])  # fmt: skip
    assert by_unit(pd.Series([1.0, 3.0, 6.0, 5.0], index=index)).to_dict() == {"p": 4.0, "q": 5.0}


def test_unknown_values_are_left_out():
    assert by_unit(over(["cubesmall", "cubelarge", "mug"], [1, np.nan, np.nan])).to_dict() == {"cube": 1.0}


@pytest.mark.slow
@pytest.mark.parametrize(("units", "inside", "between", "within"), [(8, 3, 1, 1), (20, 5, 0.3, 1), (19, 2, 1, 0.2)])
def test_intervals_over_units_cover_as_often_as_they_say(units, inside, between, within):
    draw, hits, plain = np.random.default_rng(5), [], []
    index = pd.MultiIndex.from_product([range(units), range(inside)], names=["group", "repetition"])
    for _ in range(500):
        values = draw.normal(0, between, (units, 1)) + draw.normal(0, within, (units, inside))
        found = pd.Series(values.ravel(), index=index)
        hits.append(np.sign(interval(by_unit(found))[1:]).sum() == 0)
        plain.append(np.sign(interval(found.to_numpy())[1:]).sum() == 0)
    assert 0.92 < np.mean(hits) < 0.98
    if between >= within:
        assert np.mean(plain) < 0.9  # all values as if each were a unit
