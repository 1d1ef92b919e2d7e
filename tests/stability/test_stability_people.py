"""What people looked at, beside what is found again: rows of the stage, and the table made of them."""

import numpy as np
import pytest

from haptic_glance.look.agreement import GroundTruth
from haptic_glance.look.points.options import Options
from haptic_glance.mesh.mesh import Mesh
from stages.report import stability
from stages.report.parts import build_item
from stages.stability.disturbance import Disturbance
from stages.stability.subject import Subject

from .test_stability_report import results


@pytest.fixture(scope="module")
def looked_at(pear):
    """A Subject whose people look at its top."""
    seen = np.exp(-(((pear.vertices - pear.vertices[pear.vertices[:, 2].argmax()]) / 0.1) ** 2).sum(axis=1))
    truth = GroundTruth(seen, seen, pear.vertex_areas)
    return Subject(pear, ["height", "random"], Options(name="pear"), 8, (60, 80), truth)


@pytest.fixture(scope="module")
def rows(looked_at):
    cases = [Disturbance((step,)) for step in (("winding", 1.0), ("noise", 0.001), ("tilt", 90.0))]
    return looked_at.unperturbed_rows() + [
        row for case in cases for row in looked_at.rows(case, looked_at.disturbed(case))
    ]


def agreement(rows, perturbation, metric="nss", method="height"):
    values = [row["value"] for row in rows if (row["method"], row["perturbation"], row["metric"])
             == (method, perturbation, metric)]  # fmt: skip
    assert len(values) == 1
    return values[0]


@pytest.mark.slow
def test_a_height_agrees_with_who_looks_at_the_top_until_it_is_tilted(rows, disturbed):
    assert agreement(rows, "none") > 1
    assert agreement(rows, "noise") == pytest.approx(agreement(rows, "none"), abs=0.05)
    assert agreement(rows, "tilt") < agreement(rows, "none") - 0.5
    assert 0.5 < agreement(rows, "none", "auc") <= 1
    without = [row for row in rows if row["method"] == "random"] + disturbed.rows  # no saliency, and no known gaze
    assert not any(row["metric"] in ("nss", "auc") for row in without)


def test_faces_that_point_inwards_are_turned_first(looked_at):
    """As `saliency` does it: an inverted mesh is the same object."""
    turned = looked_at.disturbed(Disturbance((("winding", 1.0),))).perturbed.mesh
    crosses = Mesh(turned.vertices, turned.faces).face_crosses
    assert (np.einsum("ij,ij->i", crosses, turned.vertices[turned.faces].mean(axis=1)) > 0).mean() > 0.95


def test_the_table_has_what_is_found_again_and_what_agreement_is_lost(tmp_path, rows, monkeypatch):
    monkeypatch.setattr(stability.people, "GAZED", ("test",))
    kept = [row | {"item": item} for item in ("pear", "apple") for row in rows if row["method"] == "height"]
    built = build_item(stability, "tables", "stability_people", results(tmp_path, kept))
    shown = built.shown.set_index("disturbance")
    assert list(shown.index) == ["winding", "noise", "tilt"]
    assert shown.loc["winding", "height, %"] == "100" and shown.loc["winding", "height, NSS"].lstrip("+-") == "0.00"
    lost = agreement(rows, "tilt") - agreement(rows, "none")
    assert float(shown.loc["tilt", "height, NSS"]) == pytest.approx(lost, abs=0.01)
    assert f"{agreement(rows, 'none'):.2f}" in " ".join(built.notes)
