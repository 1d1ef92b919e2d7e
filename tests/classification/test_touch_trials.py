"""The further experiments: what each trains and tests on, and random sets of objects."""

from collections import Counter

import numpy as np
import pytest

from stages.classification.multi_touch import MultiTouchTrials, evaluate_variants
from stages.classification.touch_readers import alike
from stages.classification.touch_trials import (
    TouchSet,
    drawn_sets,
    least_alike,
    selection_trials,
    set_of,
    single_touch_trials,
)
from stages.imprints.imprints import Imprints, write_imprints


def touched(bumps, count=24, jitter=0.5):
    """Three objects; the place of a touch is its number along a line, so that samples can be told from one another."""
    images = np.concatenate(list(bumps(count=count, jitter=jitter).values()))
    samples = np.hstack([np.arange(len(images))[:, None], np.random.default_rng(1).normal(size=(len(images), 40))])
    places = np.arange(float(len(images)))[:, None] * [1, 0, 0]
    return TouchSet.from_images(samples, images, np.repeat([0, 1, 2], count), places, 1.5)


def by_name(trials):
    return {(trial.variant, trial.split): trial for trial in trials}


def test_first_are_the_first_fifteen_of_each_object(bumps):
    few = touched(bumps).first_of_each()
    assert np.array_equal(few.samples[:, 0] % 24, np.tile(np.arange(15), 3)) and few.similarities.shape == (45, 45)
    assert np.array_equal(np.diag(few.similarities).round(9), np.ones(45))


def test_locations_are_the_last_three_columns(bumps):
    data = touched(bumps)
    located = by_name(single_touch_trials(data, 7))["locations", "random"]
    assert np.array_equal(located.samples[:, -3:], data.places) and located.kind == "located"


def test_selection_removes_before_the_split_or_from_training_alone_and_its_control_as_many_others(bumps):
    data = touched(bumps, jitter=2.5)
    trials = by_name(selection_trials(data, 3))
    left = data.samples[~data.confusable, 0]
    assert 0 < len(left) < 72 and np.array_equal(trials["selected", "random"].samples[:, 0], left)
    train, test = trials["selected_train", "random"].parts
    assert len(test) == 18 and (np.bincount(data.truth[test]) == 6).all()
    similar = data.similarities[np.ix_(train, train)] >= 0.85
    assert not (similar & (data.truth[train][:, None] != data.truth[train])).any()
    for variant in ("selected", "first_15_selected"):
        kept, control = (trials[name, "random"] for name in (variant, f"{variant}_control"))
        assert np.array_equal(kept.truth, control.truth) and not np.array_equal(kept.samples, control.samples)


@pytest.mark.slow
def test_scalings_are_run_of_plain_few_and_joined_touches(bumps):
    data = touched(bumps)
    few = MultiTouchTrials((2,), 1, True)
    rows = evaluate_variants(data, ["knn"], 1, multi_touch=few, with_selection=True)
    scalings = {}
    for row in rows:
        scalings.setdefault((row["variant"], row["split"]), []).append((row["scaling"], row["metric"]))
    all_scalings, valid = ("training", "beforehand", "min_max"), ("accuracy", "train_accuracy", "commonest_share")
    further = [(scaling, metric) for scaling in ("beforehand", "components", "min_max") for metric in valid]
    assert scalings["plain", "random"] == further  # `evaluate_prepared` has those of the scaling `training`
    assert scalings["plain", "regions"] == [(scaling, "accuracy") for scaling in all_scalings[1:]]
    assert scalings["first_15", "random"] == [(scaling, "accuracy") for scaling in all_scalings]
    for variant in ("touches_2", "first_15_touches_2_mixed"):
        assert scalings[variant, "random"] == [(scaling, metric) for scaling in all_scalings for metric in valid[::2]]
    assert scalings["touches_2_ordered", "random"] == [("training", "accuracy")]
    assert scalings["touches_2_mixed", "random"] == [("training", metric) for metric in valid[::2]]
    for variant in ("selected", "selected_control"):
        assert {row["metric"] for row in rows if row["variant"] == variant} == {"accuracy", "recall"}
    shares = [row["value"] for row in rows if row["metric"] == "commonest_share"]
    assert min(shares) >= 1 / 3 - 1e-9 and all(row.get("seconds") is None for row in rows if row["metric"] in valid[1:])
    rows = evaluate_variants(touched(bumps, jitter=2.5), ["naive_bayes", "svm"], 1)
    narrow = [row["classifier"] for row in rows if (row["variant"], row["scaling"]) == ("first_15", "min_max")]
    assert narrow == ["svm"]
    rows = [row for row in rows if row["classifier"] == "svm"]
    values = {
        row["scaling"]: row["value"] for row in rows if (row["variant"], row["metric"]) == ("first_15", "accuracy")
    }
    assert values["training"] < values["min_max"]


@pytest.mark.slow
def test_selection_that_leaves_too_little_says_so_once(bumps):
    images = bumps(names=("cup",), count=24)["cup"]
    same = TouchSet.from_images(
        np.zeros((48, 41)), np.tile(images, (2, 1, 1)), np.repeat([0, 1], 24), np.zeros((48, 3)), 1.0
    )
    rows = [row for row in evaluate_variants(same, ["knn"], 3, with_selection=True) if row["variant"] == "selected"]
    assert len(rows) == 1 and rows[0]["value"] is None and "fewer than 4 of its 48" in rows[0]["note"]


@pytest.mark.parametrize(
    ("way", "count", "kind"),
    [("", 108, "joined"), ("_unplaced", 108, "reduced"), ("_ordered", 108, "joined"), ("_disjoint", 18, "joined"),
     ("_many", 540, "joined")],
)  # fmt: skip
def test_no_touch_is_on_both_sides(bumps, way, count, kind):
    data = touched(bumps)
    trial = by_name(MultiTouchTrials((1, 3), 2, True).trials(data, 5))[f"touches_3{way}", "random"]
    assert (trial.kind, trial.samples.shape[1]) == (kind, 6 if way == "_unplaced" else 15)
    assert len(trial.parts[0]) == count and trial.skipped == (("svm",) if way == "_many" else ())
    if way != "_unplaced":
        train, test = (trial.samples[side][:, 2::5] for side in trial.parts)  # the x of each touch is its number
        assert train.shape[1] == 3 and not np.isin(train, test).any()
        assert (data.truth[train.astype(int)] == trial.truth[trial.parts[0]][:, None]).all()


def test_mixed_combinations_share_touches_and_too_many_are_left_out_with_the_reason(bumps):
    trials = by_name(MultiTouchTrials((4,), 2, True).trials(touched(bumps), 5))
    mixed = trials["touches_4_mixed", "random"]
    train, test = (mixed.samples[side][:, 2::5] for side in mixed.parts)
    assert np.isin(test, train).mean() > 0.9
    assert len(trials["first_15_touches_4_mixed", "random"].samples) == 2 * 45
    trials = by_name(MultiTouchTrials((2, 5), 1, False).trials(touched(bumps, count=16), 5))
    assert trials["touches_2", "random"].parts
    assert "4 touches on one side of the split: no combination of 5" in trials["touches_5", "random"].note
    assert {split for _, split in trials} == {"random", "regions"}


@pytest.mark.slow
def test_rows_are_the_same_from_run_to_run(bumps):
    def run():
        several = MultiTouchTrials((1, 2), 1, True)
        rows = evaluate_variants(touched(bumps), ["knn"], 1, 3, several, with_selection=True)
        return [{key: value for key, value in row.items() if key != "seconds"} for row in rows]

    assert run() == run()


GROUPS = {"six": list("abcdef"), "four": list("abcd"), "four_drawn": list("abcd")}
OBJECTS = [f"object_{k:02}" for k in range(20)]


def of_last_digit(objects):
    """Likeness that falls with the distance of two numbers, so that neighbours are alike."""
    numbers = np.array([int(name[-2:]) for name in objects])
    return 1 / (1 + np.abs(numbers[:, None] - numbers))


def test_drawn_sets_are_nested_and_dealt_like_cards_by_the_seed_alone():
    sets = drawn_sets(GROUPS, OBJECTS, 6, 0, of_last_digit)
    assert len(sets) == 18
    sixes = [sets[f"six.{number:02}"] for number in range(1, 7)]
    for number, six in enumerate(sixes, start=1):
        assert len(set(six)) == 6 and sets[f"four_drawn.{number:02}"] == six[:4] and set(six) <= set(OBJECTS)
        assert sets[f"four.{number:02}"] == least_alike(six, of_last_digit(six), 4)
    assert max(Counter(sum(sixes[:3], [])).values()) == 1  # none comes again before too few are left
    assert max(Counter(sum(sixes, [])).values()) == 2
    again, other = (drawn_sets(GROUPS, OBJECTS[::-1], 6, seed, of_last_digit) for seed in (0, 1))
    assert again == sets != other
    assert list(sets.items())[:6] == list(drawn_sets(GROUPS, OBJECTS, 2, 0, of_last_digit).items())
    assert set_of("six.07") == {"group": "six", "set": 7} and set_of("six") == {"group": "six", "set": None}
    with pytest.raises(ValueError, match="takes 6 objects, there are 5"):
        drawn_sets(GROUPS, OBJECTS[:5], 1, 0, of_last_digit)


def test_the_least_alike_have_no_two_of_the_highest_similarity():
    animals = ["cow", "dromedary", "glasses", "hand", "plane", "cup"]
    likeness = np.full((6, 6), 0.1)
    likeness[0, 1] = likeness[1, 0] = 0.9  # cow and dromedary
    likeness[2, 4] = likeness[4, 2] = 0.8  # glasses and plane
    likeness[1, 3] = likeness[3, 1] = likeness[4, 5] = likeness[5, 4] = 0.3  # what tells which of a pair goes
    assert least_alike(animals, likeness, 4) == ["cow", "glasses", "hand", "cup"]  # the thesis's four
    assert least_alike(animals, likeness, 6) == animals


def test_likeness_is_the_share_of_confusable_imprints_of_all_samplings(tmp_path):
    ramp, step = np.tile(np.arange(4.0), (4, 1)), np.repeat([0.0, 0.0, 1.0, 1.0], 4).reshape(4, 4)
    for name, first, second in (("a", (ramp, step), (ramp, ramp)), ("b", (ramp, ramp), (ramp.T, ramp.T))):
        samplings = {"first": first, "second": second}
        imprints = {
            key: Imprints(np.array(pair), np.arange(2), np.zeros((2, 3)), 0.01) for key, pair in samplings.items()
        }
        write_imprints(tmp_path / f"{name}.npz", imprints)
    # First: one of a's two imprints is like b's, both of b's are like one of a's. Second: none is alike.
    assert alike(["a", "b"], tmp_path) == pytest.approx(np.array([[1, 0.375], [0.375, 1]]))
