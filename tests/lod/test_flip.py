"""What a person sees of a simplified mesh: FLIP over the right pixels, its differences, and their table."""

import flip_evaluator
import numpy as np
import pandas as pd
import pytest

from benchmarks import flip
from haptic_glance.look.views import View, Viewpoint
from stages.engine.statistics import interval
from stages.lod import report
from stages.report.parts import build_item


def view(face, seed):
    """A View of noise that shows the faces (rows, columns), -1 for none."""
    rgb = np.random.default_rng(seed).integers(0, 256, (*face.shape, 3)).astype(np.uint8)
    return View(rgb, np.zeros(face.shape), face, Viewpoint(0, 0))


def sides(where, faces=(0, 1)):
    """(40, 60) i4 face ids: the two given on the left and right half of the columns `where`, -1 elsewhere."""
    face = np.full((40, 60), -1, np.int32)
    face[10:30, where] = np.where(np.arange(where.stop - where.start) < 10, *faces)
    return face


def test_flip_counts_the_pixels_of_the_mesh_before_or_after_and_gaze_those_before():
    before, after = view(sides(slice(10, 30)), 0), view(sides(slice(15, 35)), 1)
    whole = [side.rgb.astype(np.float32) / 255 for side in (before, after)]
    expected = flip_evaluator.evaluate(*whole, "LDR", applyMagma=False)[0][..., 0]
    errors = flip.seen_errors([before], [after], np.array([1.0, 3.0]))
    assert errors["flip"] == pytest.approx(expected[10:30, 10:35].mean(), rel=1e-6)
    left, right = expected[10:30, 10:20], expected[10:30, 20:30]
    assert errors["flip_gaze"] == pytest.approx((left.mean() + 3 * right.mean()) / 4, rel=1e-6)
    assert errors["flip"] > 0.1


def test_equal_pictures_have_no_error_and_a_mesh_without_gaze_no_error_of_gaze():
    same = view(sides(slice(10, 30)), 0)
    assert flip.seen_errors([same], [same], None) == {"flip": 0, "flip_gaze": None}


def test_views_are_joined_by_their_pixels():
    small, large = sides(slice(10, 12)), sides(slice(10, 50))
    before, after = [view(small, 0), view(large, 1)], [view(small, 2), view(large, 3)]
    each = [flip.seen_errors([first], [second], None)["flip"] for first, second in zip(before, after, strict=True)]
    shares = np.array([40, 800]) / 840
    assert flip.seen_errors(before, after, None)["flip"] == pytest.approx(shares @ each)


def rows(factor, **cells):
    """Rows of three meshes: `weighted` has `factor` times the errors of plain simplification, a half more or less."""
    made = []
    for k, spread in enumerate((1 / 1.5, 1, 1.5)):
        row = {"set": "gaze", "item": f"m{k}", "share": 0.05, "asked": 100, "faces": 100, "metro_mean": 1e-3 * (k + 1)}
        row |= {"flip": 0.1 * (k + 1), "flip_gaze": 0.2}
        ratio = factor * spread
        worse = {"flip": row["flip"] * ratio, "flip_gaze": 0.2 * ratio, "metro_mean": row["metro_mean"] * ratio}
        made += [row | {"method": "plain"}, row | {"method": "weighted"} | worse | cells]
    return pd.DataFrame(made)


def test_differences_are_geometric_means_of_pairs_in_per_cent():
    means = flip.means(rows(0.9)).set_index(["set", "error"])
    assert means.loc[("gaze", "flip"), "difference"] == pytest.approx(-10)
    assert means.loc[("both", "metro_mean"), "difference"] == pytest.approx(-10)
    ends = 100 * np.expm1(interval(np.log([0.6, 0.9, 1.35])))
    assert list(means.loc[("gaze", "flip"), ["difference", "low", "high"]]) == pytest.approx(list(ends))
    assert means["meshes"].eq(3).all()


def test_a_missed_number_of_faces_takes_no_part():
    assert flip.means(rows(0.9, faces=101)).empty


def test_the_table_has_all_meshes_first_and_the_lowest_error_bold(measure):
    gaze = {"set": "gaze", "share": 0.05, "method": "weighted", "than": "plain", "error": "flip_gaze", "meshes": 18}
    lines = [gaze | {"difference": -7.0, "low": -9.0, "high": -5.0}]
    for name, shift in (("both", 0.0), ("gaze", 1.0), ("princeton", 2.0)):
        for method, difference in (("weighted", -1.0), ("kept", 20.0)):
            line = {"set": name, "share": 0.05, "method": method, "than": "plain", "error": "flip", "meshes": 19}
            lines.append(line | {"difference": difference + shift, "low": -2.0, "high": 30.0})
    table = build_item(report, "tables", "flip", measure("bench/flip_means", pd.DataFrame(lines)))
    first = table.views[0].text
    assert list(first["method"]) == ["weighted by our glance", "salient regions kept"]
    assert list(first["FLIP, %"]) == ["-1.0 [-2.0, 30.0]", "+20.0 [-2.0, 30.0]"]
    assert list(first["faces"]) == ["5 %", "5 %"] and "FLIP where people looked, %" not in first
    assert "-7.0 % where people looked" in table.summary
