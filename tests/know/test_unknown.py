"""Objects that were never learned: the answer that an object is none of the known ones."""

from dataclasses import replace

import numpy as np
import pytest

from haptic_glance.base.rng import rng
from haptic_glance.know import NONE, Exploration, Library, learn, primitives
from haptic_glance.know.belief import Calibration
from haptic_glance.know.unknown import (
    Sequences,
    Verification,
    Verifier,
    _discrepancies,
    _mean_of_pairs,
    _pooled_without,
    fit_verification,
    log_pooled,
    similarity,
)


@pytest.fixture(scope="module")
def shapes():
    return primitives()


@pytest.fixture(scope="module")
def library(shapes):
    """Five of the six shapes; the torus stays unknown."""
    return learn({name: mesh for name, mesh in shapes.items() if name != "torus"}, unknown=True)


def explored(library, mesh, draw=0):
    exploration = Exploration(library, mesh, rng(draw, "explored"))
    exploration.finish()
    return exploration


@pytest.mark.slow
def test_an_object_that_was_never_learned_is_none_of_these_and_learned_ones_have_their_names(library, shapes):
    for draw in range(3):
        belief = explored(library, shapes["torus"], draw).belief
        assert belief.known == NONE and belief.none >= 0.95
    beliefs = {
        (name, draw): explored(library, shapes[name], draw).belief for name in library.names for draw in range(3)
    }
    answers = [(name, belief.known) for (name, _), belief in beliefs.items()]
    assert sum(name == known for name, known in answers) >= 13  # of 15
    assert all(known in (name, NONE, "") for name, known in answers)
    assert min(belief.probabilities[belief.known] for belief in beliefs.values() if belief.known) >= 0.95


def test_without_the_option_the_stranger_has_a_sure_wrong_name_and_nothing_else_changes(library, shapes):
    closed = learn({name: shapes[name] for name in library.names})
    belief = explored(closed, shapes["torus"]).belief
    assert belief.known in closed.names and belief.none == 0 and NONE not in belief.probabilities
    assert closed.calibration == library.calibration
    np.testing.assert_array_equal(belief.values, belief.among_known)


def test_the_belief_sums_to_one_with_the_answer_none_and_begins_even(library, shapes):
    exploration = explored(library, shapes["cone"])
    for belief in exploration.beliefs:
        assert sum(belief.probabilities.values()) == pytest.approx(1) and belief.none == belief.probabilities[NONE]
        assert belief.values == pytest.approx(belief.among_known * (1 - belief.none))
    assert [belief.none for belief in exploration.beliefs[:2]] == [0.5, 0.5]  # one touch says nothing of it


def test_once_the_name_is_sure_among_the_known_the_next_place_is_the_first_fresh_one(library, shapes):
    exploration = Exploration(library, shapes["cylinder"], rng(0, "places"))
    while exploration.belief.among_known.max() < 0.95:
        exploration.touch(exploration.next_place())
    fresh = np.flatnonzero(np.isfinite(exploration.gains()))[0]
    np.testing.assert_array_equal(exploration.next_place().positions, exploration.candidate(fresh).positions)
    exploration.positions = exploration.candidates.positions
    assert exploration.next_place() is None


def clusters(objects, touches=40, spread=0.3):
    """Components (objects, touches, 2) of objects on a circle, and the log likelihoods of the touches."""
    random, turns = np.random.default_rng(0), 2 * np.pi * np.arange(objects) / objects
    centres = 5 * np.c_[np.cos(turns), np.sin(turns)]
    components = centres[:, None] + spread * random.standard_normal((objects, touches, 2))
    return components, -np.linalg.norm(components[:, :, None] - centres, axis=-1), centres


def test_touches_of_an_object_are_verified_and_touches_between_objects_are_not():
    components, evidence, centres = clusters(8)
    verifier = Verifier(evidence, components, Calibration(1.0, 0.0), 0.95, np.random.default_rng(1))

    def probability(touches):
        scores = -np.linalg.norm(touches[:, None] - centres, axis=-1)
        return verifier.probability(scores.sum(axis=0), log_pooled(scores).sum(), touches)

    random = np.random.default_rng(2)
    of_first, between = (middle + 0.3 * random.standard_normal((10, 2)) for middle in (centres[0], [0.5, 0]))
    assert probability(of_first) > 0.95 and probability(between) < 0.05
    assert probability(of_first[:1]) == 0.5


def test_the_excess_is_relative_to_the_own_touches_of_the_likeliest_object():
    components, evidence, _ = clusters(5, spread=1.0)
    verifier = Verifier(evidence, components, Calibration(1.0, 0.0), 0.95, np.random.default_rng(1))
    verifier.verification = Verification(0, 1, 0, 0)  # the log odds are the excess
    for own, scores in zip(components, evidence, strict=True):
        assert verifier.probability(scores.sum(axis=0), log_pooled(scores).sum(), own) == pytest.approx(0.5)


def test_touches_that_are_likely_but_all_alike_are_another_object():
    """Each touch is like one of the object; together they are not, which only their discrepancy shows."""
    components, evidence, _ = clusters(8, spread=1.0)
    verifier = Verifier(evidence, components, Calibration(1.0, 0.0), 0.95, np.random.default_rng(1))
    sums, pooled = evidence[0, :15].sum(axis=0), log_pooled(evidence[0, :15]).sum()
    verifier.verification = Verification(0.1, 0, 2, 1)
    varied, alike = components[0, :15], components[0, :1] + np.zeros((15, 1))
    assert verifier.probability(sums, pooled, varied) > 0.7 > 0.1 > verifier.probability(sums, pooled, alike)


def test_discrepancy_and_pools_are_those_of_their_definition():
    random = np.random.default_rng(0)
    felt, (first, second) = random.random((6, 3)), random.random((2, 9, 3))
    near = np.stack([similarity(felt, own).mean(axis=1) for own in (first, second)], axis=1)
    within = _mean_of_pairs(np.stack([similarity(own, own) for own in (first, second)]))
    assert within[0] == pytest.approx(
        np.mean([similarity(first, first)[i, j] for i in range(9) for j in range(9) if i != j])
    )
    values = _discrepancies(similarity(felt, felt), near, within)
    pairs = np.mean([similarity(felt, felt)[i, j] for i in range(4) for j in range(4) if i != j])
    expected = 1 - 2 * similarity(felt[:4], second).mean() / (pairs + within[1])
    assert values.shape == (6, 2) and values[3, 1] == pytest.approx(expected)
    evidence = random.normal(size=(4, 5, 4))
    evidence[0, 0] = [0, -60, -61, -62]  # the other objects are next to nothing
    expected = np.log(np.exp(np.delete(evidence, 2, axis=2)).mean(axis=2))
    assert _pooled_without(evidence)[..., 2] == pytest.approx(expected)
    assert log_pooled(evidence) == pytest.approx(np.log(np.exp(evidence).mean(axis=2)))


def sequences(excess, right, known):
    excess = np.tile(np.asarray(excess, dtype=float)[:, None], (1, 9))
    is_right = np.tile(np.asarray(right)[:, None], (1, 9))
    return Sequences(excess, np.zeros_like(excess), np.ones_like(excess), is_right, np.asarray(known))


def test_the_odds_follow_the_features_and_are_scaled_down_where_sure_names_are_wrong():
    random = np.random.default_rng(0)
    known = np.arange(400) < 200
    excess = np.where(known, 1.0, -1.0) + random.normal(size=400)
    fair = sequences(excess, known, known)
    fitted = fit_verification(fair, 0.95)
    assert fitted.scale == 1 and 1 < fitted.fit * 5**fitted.growth < 4  # 2 for unit variances, whatever the touches
    wrong = replace(fair, right=fair.right & (np.arange(400) % 5 > 0)[:, None])  # a fifth of the names
    assert 0.1 < fit_verification(wrong, 0.95).scale < 0.8
    unsure = replace(fair, belief=np.full_like(fair.belief, 0.5))
    assert fit_verification(replace(unsure, right=wrong.right), 0.95).scale == 1


def test_too_few_objects_or_touches_and_the_name_of_the_answer_are_refused(shapes):
    with pytest.raises(ValueError, match="needs 3 objects or more, .* got 2 with 128: each object is left out in turn"):
        learn({name: shapes[name] for name in ("ball", "box")}, unknown=True)
    with pytest.raises(ValueError, match="at least two"):
        learn({"ball": shapes["ball"]}, unknown=True)
    with pytest.raises(ValueError, match="called 'none of these', which is the answer .* rename it"):
        learn({"ball": shapes["ball"], "box": shapes["box"], NONE: shapes["cone"]}, unknown=True)
    names, random = ("a", "b", "c"), np.random.default_rng(0)
    with pytest.raises(ValueError, match="4 touches or more of each, got 3 with 3"):
        Library(names, 0.1 * random.random((3, 3, 41)), random.random((3, 3, 3)), False, unknown=True)
    least = Library(names, 0.1 * random.random((3, 4, 41)), random.random((3, 4, 3)), False, unknown=True)
    assert 0 < least.belief().none < 1


@pytest.mark.slow
def test_an_unknown_pose_leaves_strangers_undecided_or_none(shapes):
    """Five of the shapes are learned for any pose; a torus has none of their names."""
    anyhow = learn({name: mesh for name, mesh in shapes.items() if name != "torus"}, False, turned=True, unknown=True)
    answers = {explored(anyhow, shapes["torus"], draw).belief.known for draw in range(5)}
    assert answers <= {NONE, ""}
