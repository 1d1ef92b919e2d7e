"""The checks that a simplified mesh must pass find every kind of ruin; outcomes and rows."""

import numpy as np
import pandas as pd
import pytest
import trimesh

from haptic_glance.base.rng import rng
from haptic_glance.mesh.mesh import Mesh
from stages.stability import simplification
from stages.stability.broken import DAMAGES
from stages.stability.simplification import run_case, run_cases, summarise_simplification
from stages.stability.surface import KEPT, Case, QemErrorCurve, Specimen, Surface, find_faults, surface_error

BALL = trimesh.creation.icosphere(subdivisions=3)
SOUND = Mesh(BALL.vertices * [0.3, 0.4, 0.5], BALL.faces)
COARSE = trimesh.creation.icosphere(subdivisions=2)
FEWER = Mesh(
    COARSE.vertices * [0.3, 0.4, 0.5], COARSE.faces
)  # the icosphere's coarse vertices are vertices of the fine

pytestmark = pytest.mark.slow
NONE = np.zeros(0, dtype=int), np.zeros((0, 3), dtype=int)
CURVE = QemErrorCurve(SOUND)  # it keeps the errors that it was asked for


def faults_text(after, before=SOUND, faces=320, kept=NONE):
    return "; ".join(find_faults(Surface(before), after, faces, *kept))


def changed(vertex=None, place=None, faces=None):
    """FEWER with one vertex elsewhere, or with other faces."""
    vertices = FEWER.vertices.copy()
    if vertex is not None:
        vertices[vertex] = place
    return Mesh(vertices, FEWER.faces if faces is None else faces)


def test_a_sound_result_has_no_complaint():
    assert faults_text(FEWER) == "" and faults_text(SOUND, faces=1280) == ""
    kept = BALL.faces[0][:1], BALL.faces[:5]
    assert faults_text(SOUND, faces=1280, kept=kept) == ""


def folded():
    """FEWER with a corner of its first face laid upon the face on the other side of an edge."""
    tip, a, b = FEWER.faces[0]
    other = next(face for face in FEWER.faces[1:] if {a, b} <= set(face))
    across = FEWER.vertices[next(corner for corner in other if corner not in (a, b))]
    return changed(tip, 0.8 * across + 0.1 * (FEWER.vertices[a] + FEWER.vertices[b]))


TWO = np.r_[FEWER.faces, FEWER.faces + len(FEWER.vertices)]
RUINS = {
    "320 faces, 100 asked": (FEWER, {"faces": 100}),
    "no face left": (Mesh(FEWER.vertices, np.zeros((0, 3), dtype=int)), {}),
    "kept faces lost": (FEWER, {"kept": (NONE[0], SOUND.faces[:7])}),
    "kept vertices lost": (FEWER, {"kept": (np.arange(len(SOUND.vertices)), NONE[1])}),
    "boundary changed in 3 edges": (changed(faces=FEWER.faces[1:]), {}),
    "no longer closed": (changed(faces=FEWER.faces[1:]), {}),
    "inside out": (changed(faces=FEWER.faces[:, ::-1]), {}),
    "2 connected components instead of 1": (Mesh(np.r_[FEWER.vertices, 3 + FEWER.vertices], TWO), {"faces": 640}),
    "new folds": (folded(), {}),
    "new faces without area": (changed(FEWER.faces[0, 0], FEWER.vertices[FEWER.faces[0, 1]]), {}),
    "new non-manifold edges": (
        changed(faces=np.r_[FEWER.faces, FEWER.faces[:1], FEWER.faces[:1, ::-1]]),
        {"faces": 322},
    ),
}


@pytest.mark.parametrize("name", RUINS)
def test_every_kind_of_ruin_is_named(name):
    mesh, more = RUINS[name]
    assert name in faults_text(mesh, **more)


def test_a_new_pinch_is_named_where_two_corners_become_one():
    faces = FEWER.faces.copy()
    far = int(np.argmin(FEWER.vertices @ FEWER.vertices[0]))
    faces[faces == far] = 0
    assert "1 new non-manifold vertices" in faults_text(changed(faces=faces))


def test_faults_that_were_there_before_are_no_complaint_nor_is_throwing_copies_out():
    before = Mesh(SOUND.vertices, np.r_[SOUND.faces, SOUND.faces[:9], SOUND.faces[:4, [0, 1, 1]]])
    assert faults_text(before, before, 2000) == "" and faults_text(SOUND, before, 2000) == ""


def test_a_fold_that_a_zero_edge_hid_is_no_new_one_and_a_face_laid_upon_a_face_is():
    hidden = DAMAGES["zero_area"].make(folded(), rng(0, "hidden"))
    assert faults_text(folded(), hidden, 2000) == ""
    pillow = Mesh(np.r_[FEWER.vertices, 2 + np.eye(3)], np.r_[FEWER.faces, [[162, 163, 164], [162, 164, 163]]])
    assert "1 new duplicate faces" in faults_text(pillow, faces=400)


def test_moving_a_rim_is_a_change_of_the_boundary():
    half = Mesh(SOUND.vertices, SOUND.faces[SOUND.vertices[SOUND.faces][:, :, 2].mean(axis=1) > 0])
    edges = b"".join(Surface(half).boundary_edges)
    rim = np.flatnonzero([row.tobytes() in edges for row in half.vertices])
    moved = half.vertices.copy()
    moved[rim[0]] *= 1.01
    assert faults_text(half, half, 2000) == "" and "boundary changed" in faults_text(
        Mesh(moved, half.faces), half, 2000
    )


@pytest.mark.parametrize(("scale", "offset"), [(1e-12, 1e3), (1e12, 0.0)])
def test_the_verdict_does_not_depend_on_unit_or_origin(scale, offset):
    def moved(mesh):
        return Mesh(scale * (mesh.vertices + offset), mesh.faces)

    assert faults_text(moved(FEWER), moved(SOUND)) == ""
    assert "new folds" in faults_text(moved(folded()), moved(SOUND))
    assert surface_error(moved(SOUND), moved(FEWER)) == pytest.approx(surface_error(SOUND, FEWER), rel=1e-3)


def test_error_is_zero_of_itself_and_known_of_parallel_squares():
    square = Mesh([[0, 0, 0], [3, 0, 0], [3, 4, 0], [0, 4, 0]], [[0, 1, 2], [0, 2, 3]])
    assert surface_error(square, square) == pytest.approx(0, abs=1e-9)
    assert surface_error(square, Mesh(square.vertices + [0, 0, 1], square.faces)) == pytest.approx(0.2)
    flat = Mesh([[0, 0, 0], [1, 0, 0], [2, 0, 0]], [[0, 1, 2]])
    assert surface_error(flat, flat) == 0


def specimen(damage="sound"):
    return Specimen(SOUND, CURVE, damage, "ball", 0)


@pytest.mark.parametrize("kept", KEPT)
def test_kept_sets_are_nested_and_as_large_as_they_say(kept):
    ball = specimen("unreferenced")
    ids = ball.kept(Case("50%", kept))
    used = len(SOUND.vertices)
    assert len(ids) == {"none": 0, "1": 1, "5": 5, "60": 60, "half": used // 2, "all": used}[kept]
    assert np.isin(ids, ball.mesh.faces).all() and np.array_equal(ids, ball.kept(Case("50%", "all"))[: len(ids)])


def test_kept_faces_are_those_three_rings_around():
    ball = specimen()
    near = np.flatnonzero(SOUND.rings([5], 3))
    assert len(ball.kept_faces(np.array([5]))) == np.isin(SOUND.faces, near).all(axis=1).sum()
    assert len(ball.kept_faces(np.zeros(0, dtype=int))) == 0


@pytest.mark.parametrize(
    ("work", "outcome", "note"),
    [
        (lambda *_, **__: FEWER, "valid", ""),
        (lambda *_, **__: changed(faces=FEWER.faces[1:]), "ruined", "boundary"),
        (lambda *_, **__: changed(0, [9.0, 9.0, 9.0]), "ruined", "mean error"),
        (lambda *_, **__: [][0], "crash", "IndexError"),
        (lambda *_, **__: np.zeros(3).reshape(2, 2), "crash", "ValueError"),
    ],
)
def test_outcomes(monkeypatch, work, outcome, note):
    monkeypatch.setattr(simplification, "simplify", work)
    answer = run_case(specimen(), Case("320"), "pymeshlab")
    assert answer.outcome == outcome and note in answer.note


def test_another_mesh_on_the_second_run_is_a_ruin_and_a_refusal_is_no_crash(monkeypatch):
    assert run_case(specimen("soup"), Case("4"), "pymeshlab").outcome == "refused"
    meshes = iter([FEWER, Mesh(FEWER.vertices, FEWER.faces[::-1])])
    monkeypatch.setattr(simplification, "simplify", lambda *_, **__: next(meshes))
    assert "second run" in run_case(specimen(), Case("50%"), "pymeshlab").note


def test_the_smallest_count_that_a_refusal_names_is_asked_for_once():
    outcomes = list(run_cases(specimen("wide_holes"), "pymeshlab", [Case("4"), Case("8")]))
    assert [case.budget for case, _ in outcomes] == ["4", "smallest", "8"]
    assert outcomes[0][1].outcome == "refused" and outcomes[1][1].asked == outcomes[0][1].smallest > 8


def test_rows_say_what_was_asked_and_what_came(simplified):
    frame = pd.DataFrame(simplified)
    cases = frame[frame["metric"] == "faces"]
    assert not cases["value"].isna().any() and (cases["outcome"] != "crash").all()
    assert set(frame.loc[frame["metric"] == "error", "outcome"]) <= {"valid", "ruined"}
    refused = cases[cases["outcome"] == "refused"]
    assert len(refused) and (refused["note"] != "").all() and (refused["value"] == 0).all()
    sound = cases[(cases["perturbation"] == "sound") & (cases["kept"] == "none") & (cases["soft"] == "")]
    assert (sound.loc[sound["severity"] >= 64, "outcome"] == "valid").all()


def test_the_gate_gets_shares_that_sum_to_one(simplified):
    shares = summarise_simplification(simplified)["pymeshlab"]
    assert (
        shares["valid"] + shares["refused"] + shares["ruined"] == pytest.approx(1, abs=1e-5) and shares["crashes"] == 0
    )
    assert shares["smallest_had"] > 0.5
    assert summarise_simplification([{"metric": "repeatability"}]) == {}
