"""The plan of trainings: networks, splits, and trainings that are left out."""

import numpy as np
import pandas as pd
import pytest
import torch

from haptic_glance.base.fetch import FetchError
from haptic_glance.mesh.mesh import Mesh
from stages.engine.statistics import stratified_split
from stages.transfer import plan as planning
from stages.transfer.imprint_images import choose_vertices
from stages.transfer.plan import Trial, by_objects, by_touches, check, plan, printed_rate
from tests.shapes import flat_grid

pytestmark = pytest.mark.slow

CLASSES = {"animal": ["dog", "horse", "cow"], "chair": ["stool", "bench"], "vase": ["urn"]}
ENOUGH = dict.fromkeys([name for objects in CLASSES.values() for name in objects], 100)
LABELS = np.repeat([0, 1], [30, 40])  # of three and four objects of ten touches
RANKS = np.r_[np.repeat([0, 1, 2], 10), np.repeat([0, 1, 2, 3], 10)]


def rng(seed=3):
    return np.random.default_rng(seed)


@pytest.fixture
def weights(monkeypatch):
    """Nothing is fetched; there are weights for all networks but GoogLeNet."""

    def fetched(network, source):
        if network == "googlenet":
            raise FetchError("no registry has it")
        return "complete"

    monkeypatch.setattr(planning, "available_weights", fetched)
    monkeypatch.setattr(planning, "imagenet_state", fetched)


def test_a_trials_name_is_its_file_and_gives_it_back():
    trial = Trial("imprints128", "mobilenet_v2", "imagenet", "18:139", "objects", 2)
    name = "imprints128.mobilenet_v2.imagenet.18-139.objects.2"
    for entry, expected in ((trial, name), (trial._replace(passes="converged"), f"{name}.converged")):
        assert entry.name == expected and Trial.parse(expected) == entry


def test_passes_are_a_dimension_and_initial_statistics_are_for_frozen_networks_with_a_normalisation(small, weights):
    networks = {"mobilenet_v2": ["frozen", "finetuned"], "alexnet": ["frozen"]}
    changes = {"weights": ["random", "random_initial"], "passes": ["printed", "converged"], "splits": {"random": 1}}
    trials = plan(CLASSES, ENOUGH, small.settings(networks=networks, coarse_cells=[], **changes)).trials
    for passes in ("printed", "converged"):
        assert [(entry.network, entry.weights, entry.mode) for entry in trials if entry.passes == passes] == [
            ("mobilenet_v2", "random", "frozen"), ("mobilenet_v2", "random", "finetuned"),
            ("mobilenet_v2", "random_initial", "frozen"), ("alexnet", "random", "frozen"),
        ]  # fmt: skip


@pytest.mark.parametrize(
    ("data", "file"), [("imprints32", "5_4_simulated_fsr_128x128"), ("imprints8", "5_3_fsr_16x16")]
)
def test_printed_rates_are_those_of_the_thesis_s_tables(small, data, file):
    table = pd.read_csv(f"data/reference/thesis/table_{file}.csv").set_index("network")
    for name, row in table.rename(index=lambda name: name.lower().replace("netv2", "net_v2")).iterrows():
        for mode in ("frozen", "finetuned"):
            trial = Trial(data, str(name), "imagenet", mode, "random", 0, "printed_rate")
            assert printed_rate(trial, small.settings()) == row[f"lr_{mode}"]


def test_controls_and_ranges_have_no_printed_rate(small, weights):
    changes = {"weights": ["imagenet", "random"], "passes": ["printed_rate"], "splits": {"random": 1}}
    networks = {"mobilenet_v2": ["frozen", "18:139"], "efficientnet_lite0": ["frozen"]}
    trials = plan(CLASSES, ENOUGH, small.settings(networks=networks, coarse_cells=[], **changes)).trials
    assert [trial.name for trial in trials] == ["imprints32.mobilenet_v2.imagenet.frozen.random.0.printed_rate"]


def test_initial_statistics_are_left_out_on_a_card_with_a_note(small, weights, monkeypatch):
    monkeypatch.setattr(planning, "choose_device", lambda name: torch.device("cuda"))
    settings = small.settings(weights=["random", "random_initial"])
    check(settings)
    planned = plan(CLASSES, ENOUGH, settings)
    assert {trial.weights for trial in planned.trials} == {"random"}
    [note] = [note for about, note in planned.notes if about == {"weights": "random_initial"}]
    assert "transfer.device=cpu" in note


def test_controls_and_ranges_are_trained_on_the_fine_array_alone_and_of_some_networks(small, weights):
    networks = {"mobilenet_v2": ["frozen", "finetuned", "18:139"], "vgg16": ["frozen"]}
    changes = {"weights": ["imagenet", "random"], "splits": {"random": 1}, "uncontrolled": ["vgg16"]}
    kinds = [trial[:4] for trial in plan(CLASSES, ENOUGH, small.settings(networks=networks, **changes)).trials]
    assert sorted(kinds) == [
        ("imprints32", "mobilenet_v2", "imagenet", "18:139"), ("imprints32", "mobilenet_v2", "imagenet", "finetuned"),
        ("imprints32", "mobilenet_v2", "imagenet", "frozen"), ("imprints32", "mobilenet_v2", "random", "finetuned"),
        ("imprints32", "mobilenet_v2", "random", "frozen"), ("imprints32", "vgg16", "imagenet", "frozen"),
        ("imprints8", "mobilenet_v2", "imagenet", "finetuned"), ("imprints8", "mobilenet_v2", "imagenet", "frozen"),
        ("imprints8", "vgg16", "imagenet", "frozen"),
    ]  # fmt: skip


def test_a_class_with_one_object_is_trained_but_not_left_out(small):
    planned = plan(CLASSES, ENOUGH, small.settings())
    assert list(planned.members["random"]) == ["animal", "chair", "vase"]
    assert list(planned.members["objects"]) == ["animal", "chair"]
    assert ({"split": "objects"}, "class vase has one object alone: it cannot be left out") in planned.notes
    assert {trial.split for trial in planned.trials} == {"random", "objects"}
    planned = plan({"chair": ["stool"], "vase": ["urn"]}, ENOUGH, small.settings())
    assert {trial.split for trial in planned.trials} == {"random"}
    assert "fewer than two classes have a second object" in planned.notes[-1][1]


@pytest.mark.parametrize(
    ("change", "reason"),
    [
        ({"networks": {"mobilenet_v2": ["frozen", "boiled"]}}, "transfer.networks.mobilenet_v2: boiled not known"),
        ({"networks": {"mobilenet_v2": []}}, "transfer.networks.mobilenet_v2: none not known"),
        ({"networks": {"mobilenet_v2": ["18:200"]}}, "layers are 1 to 154"),
        ({"networks": {"alexnet": ["18:139"]}}, "transfer.networks.alexnet: 18:139 not known"),
        ({"weights": []}, "transfer.weights must name at least one"),
        ({"splits": {"random": 0, "objects": 0}}, "must be 1 or more"),
        ({"touches": 1}, "touches 2"),
        ({"size": 16}, "transfer.size: 16 is too small"),
        ({"hybrid_size": 16}, "transfer.hybrid_size: 16 is too small"),
        ({"device": "abacus"}, "unknown device"),
        ({"new_object_touches": [1, 8]}, "less than transfer.touches"),
        ({"new_object_touches": []}, "less than transfer.touches"),
        ({"passes": ["all"]}, "transfer.passes: all not known, choose from printed, converged, printed_rate"),
        ({"patience": 0}, "patience and most_epochs must be 1 or more"),
    ],
)
def test_settings_that_cannot_be_run_are_named(small, change, reason):
    with pytest.raises(ValueError, match=reason):
        check(small.settings(**change))


def test_every_class_is_split_by_the_share_and_by_the_seed():
    labels = np.repeat([0, 1, 2], [40, 20, 8])
    first, second = stratified_split(labels, 0.75, rng())
    assert sorted([*first, *second]) == list(range(len(labels)))
    assert np.bincount(labels[first]).tolist() == [30, 15, 6]
    again, other = (stratified_split(labels, 0.75, rng(seed))[0] for seed in (3, 4))
    assert np.array_equal(first, again) and not np.array_equal(first, other)
    for share, counts in ((0.99, [4, 2]), (0.01, [2, 4])):  # small classes lie on both sides
        assert [len(part) for part in stratified_split(np.array([0, 0, 0, 1, 1, 1]), share, rng())] == counts


@pytest.mark.parametrize(
    ("labels", "share", "reason"),
    [([0, 0, 1], 0.5, "class 1 has one item alone"), ([0, 0], 1.0, "between 0 and 1"), ([0.5, 0.5], 0.5, "integers")],
)
def test_what_cannot_be_split_is_refused(labels, share, reason):
    with pytest.raises(ValueError, match=reason):
        stratified_split(labels, share, rng())


def check_parts(split):
    """Train and test are disjoint and hold all, and validation lies within train."""
    assert sorted([*split.train, *split.test]) == list(range(len(LABELS)))
    assert sorted([*split.fit, *split.validation]) == list(split.train)
    assert set(split.validation) < set(split.train)


def test_touches_of_every_object_lie_on_both_sides():
    objects = LABELS * 4 + RANKS
    split = by_touches(objects, 0.8, 0.25, rng())
    check_parts(split)
    for part, count in ((split.train, 8), (split.test, 2), (split.validation, 2)):
        assert set(np.bincount(objects[part])) <= {0, count}


@pytest.mark.parametrize("number", range(4))
def test_an_object_left_out_is_in_no_other_part(number):
    split = by_objects(LABELS, RANKS, number, 0.2, rng())
    check_parts(split)
    for label, count in enumerate((3, 4)):
        parts = [set(RANKS[part[LABELS[part] == label]]) for part in (split.test, split.validation, split.fit)]
        assert parts[0] == {number % count} and parts[1] == {(number + 1) % count}
        assert not parts[2] & (parts[0] | parts[1]) and len(parts[2]) == count - 2


def test_of_two_objects_the_check_is_a_share_of_the_touches_that_train_and_one_cannot_be_left_out():
    two = RANKS < 2
    labels, ranks = LABELS[two], RANKS[two]
    split = by_objects(labels, ranks, 1, 0.2, rng())
    assert set(ranks[split.test]) == {1} and set(ranks[split.train]) == {0}
    assert np.bincount(labels[split.validation]).tolist() == [2, 2]
    with pytest.raises(ValueError, match="class 1 has one object alone"):
        by_objects(np.array([0, 0, 1]), np.array([0, 1, 0]), 0, 0.2, rng())


def test_salient_points_come_first_and_blind_ones_fill_up():
    grid = flat_grid(6, 6)
    chosen = choose_vertices(grid, np.array([7, 3]), 20, rng())
    assert chosen[:2].tolist() == [7, 3] and len(set(chosen.tolist())) == 20
    assert choose_vertices(grid, np.array([7, 3, 9]), 2, rng()).tolist() == [7, 3]
    with pytest.raises(ValueError, match="only 36 vertices"):
        choose_vertices(grid, np.array([7, 3]), 37, rng())
    stretched = Mesh(flat_grid(40, 40).vertices ** [2, 1, 1], flat_grid(40, 40).faces)
    places = stretched.vertices[choose_vertices(stretched, np.array([], dtype=int), 100, rng())]
    assert (places[:, 0] < 39**2 / 2).mean() == pytest.approx(0.5, abs=0.1)  # half of the area, 70 % of the vertices
