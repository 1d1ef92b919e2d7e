"""Hold-out and five folds, and the five classifiers in them."""

import numpy as np
import pytest

from haptic_glance.know import CLASSIFIERS, classifier, evaluate, features, protocol
from haptic_glance.know.protocol import Prepared


def mean(rows, split):
    return np.mean([row["value"] for row in rows if (row["metric"], row["split"]) == ("accuracy", split)])


def noise(*shape):
    """(samples of this shape, labels): two classes that nothing tells apart."""
    return np.random.default_rng(0).normal(size=shape), np.repeat([0, 1], shape[0] // 2)


def test_classifiers_are_the_thesis_s_behind_twelve_components():
    assert set(CLASSIFIERS) >= {"knn", "svm", "decision_tree", "naive_bayes", "deep_learning"}
    assert classifier("deep_learning", 5)[-1].get_params() == {"hidden": (50, 50), "epochs": 10, "seed": 5}
    assert classifier("knn")[-2].n_components == 12


@pytest.mark.slow
def test_rows_are_equal_from_run_to_run_but_for_the_seconds(bumps):
    def rows_of(images, seed):
        rows = evaluate(images, "decision_tree", 2, seed=seed)
        return [{key: value for key, value in row.items() if key != "seconds"} for row in rows]

    images = bumps(jitter=3.0)
    rows = rows_of(images, 4)
    assert rows == rows_of(dict(reversed(images.items())), 4) != rows_of(images, 5)
    assert [row["repetition"] for row in rows] == [0, 0, 1, 1]


def test_every_object_gives_as_many_as_the_poorest(bumps):
    images = bumps(count=20)
    images["cup"] = images["cup"][:12]
    rows = evaluate(images, "knn", 1)
    cut = evaluate({name: stack[:12] for name, stack in images.items()}, "knn", 1)
    assert [row["value"] for row in rows] == [row["value"] for row in cut]


def test_hold_out_is_a_quarter_and_never_trained_on():
    truth = np.repeat([0, 1, 2], 32)
    splits = protocol.draw_splits(truth, 5)
    ((train, test),), folds = splits["random"], splits["folds"]
    assert list(splits) == ["random", "folds"] and np.array_equal(np.sort(np.r_[train, test]), np.arange(96))
    assert (np.bincount(truth[train]) == 24).all() and len(folds) == 5
    for fit, check in folds:
        assert not np.isin(fit, check).any() and np.array_equal(np.sort(np.r_[fit, check]), np.sort(train))
    assert np.array_equal(np.sort(np.concatenate([check for _, check in folds])), np.sort(train))


@pytest.mark.parametrize(("kind", "width"), [("features", 12), ("located", 15), ("reduced", 44), ("joined", 44)])
def test_preparation_is_fitted_to_the_training_part_alone_and_answers_as_the_pipeline_does(kind, width):
    samples, truth = noise(80, 44)
    samples[:, :6] += truth[:, None]
    train, test = protocol.random_holdout(truth, 3)
    far = samples.copy()
    far[test] += 100
    prepared, other = (Prepared.from_split(values, truth, (train, test), kind) for values in (samples, far))
    assert prepared.train.shape == (60, width) and np.array_equal(prepared.train, other.train)
    assert not np.allclose(prepared.test, other.test) and np.array_equal(prepared.test_truth, truth[test])
    for name in ("knn", "naive_bayes", "decision_tree"):
        model = classifier(name, 3, kind).fit(samples[train], truth[train])
        assert np.array_equal(prepared.predict(name, 3)[0], model.predict(samples[test]))


def test_other_scalings_are_of_all_data():
    samples, truth = noise(80, 45)
    samples = 5 * samples + 3
    train, test = protocol.random_holdout(truth, 3)

    def both(kind, scaling):
        prepared = Prepared.from_split(samples, truth, (train, test), kind, scaling)
        return np.concatenate([prepared.train, prepared.test]), samples[np.concatenate([train, test])]

    standard = (samples - samples.mean(axis=0)) / samples.std(axis=0)
    largest = np.linalg.svd(standard, compute_uv=False)[:12] ** 2 / 80
    assert both("features", "beforehand")[0].var(axis=0) == pytest.approx(largest)
    assert both("features", "components")[0].var(axis=0) == pytest.approx(np.ones(12))
    ranged = (samples - samples.min(axis=0)) / np.ptp(samples, axis=0)
    largest = np.linalg.svd(ranged - ranged.mean(axis=0), compute_uv=False)[:12] ** 2 / 80
    assert both("features", "min_max")[0].var(axis=0) == pytest.approx(largest)
    for scaling in ("beforehand", "components", "min_max"):
        features_alone = Prepared.from_split(samples[:, :-3], truth, (train, test), "features", scaling)
        assert both("located", scaling)[0][: len(train), :12] == pytest.approx(features_alone.train)
    joined, raw = both("joined", "beforehand")
    assert joined[:, :27].std(axis=0) == pytest.approx(np.ones(27))  # the positions of nine touches
    assert joined[:, 27:] == pytest.approx(raw[:, [column for column in range(45) if column % 5 < 2]])
    assert np.ptp(both("joined", "min_max")[0], axis=0) == pytest.approx(np.ones(45))


def test_a_dead_classifier_shows_in_its_rows():
    near, truth = 100 * np.eye(12), np.repeat([0, 1, 2], 4)
    dead = Prepared(near, truth, -near, truth, 0.0).predict("svm", 0, with_training=True)  # all far from each other
    assert dead.validity == [{"metric": "train_accuracy", "value": 1.0}, {"metric": "commonest_share", "value": 1.0}]
    alive = Prepared(near, truth, near[:6], truth[:6], 0.0).predict("knn", 0)
    assert [row["value"] for row in alive.validity] == [None, pytest.approx(4 / 6)]


def test_splits_depend_on_nothing_but_the_repetition(monkeypatch):
    drawn = []
    monkeypatch.setattr(
        protocol.Prepared, "from_split", lambda samples, truth, parts: drawn.append(np.concatenate(parts))
    )
    for samples in (np.zeros((40, 2)), np.ones((40, 3))):
        protocol.prepare(samples, np.repeat([0, 1], 20), 2, 0)
    assert len(drawn) == 24 and not np.array_equal(drawn[0], drawn[6])
    assert all(np.array_equal(first, other) for first, other in zip(drawn[:12], drawn[12:], strict=True))


def test_confusion_counts_the_hold_outs_and_regions_are_none_where_all_touches_overlap(bumps):
    images = bumps(count=16)
    samples, truth = np.concatenate([features(stack) for stack in images.values()]), np.repeat([0, 1, 2], 16)
    prepared = protocol.prepare(samples, truth, 3, 0, np.zeros((48, 3)), 0.16)
    rows, confusion = protocol.evaluate_prepared(prepared, 3, "knn", 0)
    assert (confusion.sum(axis=1) == 3 * 4).all()
    assert confusion.trace() / confusion.sum() == pytest.approx(mean(rows, "random"))
    last = [(row["split"], row["value"]) for row in rows[-2:]]
    assert last == [("regions", None), ("random_fewer", None)]


def test_apart_holds_out_a_region_far_from_all_training():
    places, truth = np.tile(np.arange(16.0)[:, None] * [1, 0, 0], (3, 1)), np.repeat([0, 1, 2], 16)
    for random_state in range(4):
        splits = protocol.draw_splits(truth, random_state, places, min_distance=2.5)
        ((train, test),), ((few, other_test),) = splits["regions"], splits["random_fewer"]
        assert len(test) == 12 and len(train) >= 3 * 8
        for first_of_each in (0, 16, 32):
            parts = [part[(part >= first_of_each) & (part < first_of_each + 16)] for part in (train, test)]
            assert np.ptp(parts[1]) == 3 and np.abs(parts[0][:, None] - parts[1]).min() == 3
        assert np.array_equal(np.bincount(truth[train]), np.bincount(truth[few]))
        assert not np.isin(few, other_test).any()


def test_side_is_held_out_of_all_objects_alike():
    places, truth = np.random.default_rng(0).uniform(-1, 1, size=(120, 3)), np.repeat([0, 1], 60)
    train, test = protocol.region_holdout(truth, places, 0.1, 5, side=True)
    centre = places[test].mean(axis=0)
    for label in (0, 1):
        known, side = (places[part[truth[part] == label]] for part in (train, test))
        assert len(side) == 15 and side.mean(axis=0) @ centre > 0.5 * np.linalg.norm(centre) ** 2
        assert np.linalg.norm(known[:, None] - side, axis=2).min() > 0.1


def test_located_samples_keep_the_place_behind_the_components():
    samples, labels = noise(120, 41)
    places = np.random.default_rng(1).normal(size=(120, 3)) * 1e-3
    places[:, 2] += 1e-2 * labels
    located = classifier("decision_tree", 0, "located").fit(np.hstack([samples, places])[::2], labels[::2])
    components = located[0].transform(np.hstack([samples, places]))
    plain = classifier("knn").fit(samples[::2], labels[::2])[:-1]
    assert components.shape == (120, 15) and np.allclose(components[:, :12], plain.transform(samples))
    assert located.score(np.hstack([samples, places])[1::2], labels[1::2]) > 0.9
