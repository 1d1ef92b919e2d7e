"""What is trained, and what has to be left out."""

import pytest
import torch

from haptic_glance.base.fetch import FetchError
from stages.transfer import plan as planning
from stages.transfer.plan import Trial, check, plan

CLASSES = {"animal": ["dog", "horse", "cow"], "chair": ["stool", "bench"], "vase": ["urn"]}
ENOUGH = dict.fromkeys([name for objects in CLASSES.values() for name in objects], 100)


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
    assert trial.name == "imprints128.mobilenet_v2.imagenet.18-139.objects.2"
    assert Trial.parse(trial.name) == trial


def test_a_training_to_convergence_has_a_name_of_its_own():
    trial = Trial("imprints128", "mobilenet_v2", "imagenet", "18:139", "objects", 2, "converged")
    assert trial.name == "imprints128.mobilenet_v2.imagenet.18-139.objects.2.converged"
    assert Trial.parse(trial.name) == trial


def test_passes_are_a_dimension_and_initial_statistics_are_for_frozen_networks_with_a_normalisation(small, weights):
    networks = {"mobilenet_v2": ["frozen", "finetuned"], "alexnet": ["frozen"]}
    changes = {"weights": ["random", "random_initial"], "passes": ["printed", "converged"], "splits": {"random": 1}}
    trials = plan(CLASSES, ENOUGH, small.settings(networks=networks, coarse_cells=[], **changes)).trials
    kinds = [(one.network, one.weights, one.mode) for one in trials if one.passes == "converged"]
    assert kinds == [(one.network, one.weights, one.mode) for one in trials if one.passes == "printed"]
    assert kinds == [
        ("mobilenet_v2", "random", "frozen"), ("mobilenet_v2", "random", "finetuned"),
        ("mobilenet_v2", "random_initial", "frozen"), ("alexnet", "random", "frozen"),
    ]  # fmt: skip


def test_initial_statistics_are_refused_in_half_precision(small, monkeypatch):
    monkeypatch.setattr(planning, "choose_device", lambda name: torch.device("cuda"))
    check(small.settings())
    with pytest.raises(ValueError, match="too small for a card's half precision"):
        check(small.settings(weights=["random_initial"]))


@pytest.mark.parametrize(("key", "value", "said"), [
    ("passes", ["all"], "transfer.passes: all not known, choose from printed, converged"),
    ("patience", 0, "patience and most_epochs must be 1 or more"),
])  # fmt: skip
def test_passes_that_cannot_be_made_are_named(small, key, value, said):
    with pytest.raises(ValueError, match=said):
        check(small.settings(**{key: value}))


def test_controls_and_ranges_are_trained_on_the_fine_array_alone(small, weights):
    networks = {"mobilenet_v2": ["frozen", "finetuned", "18:139"], "alexnet": ["frozen", "finetuned"]}
    both = small.settings(weights=["imagenet", "random"], networks=networks, splits={"random": 1})
    trials = plan(CLASSES, ENOUGH, both).trials
    kinds = {trial[:4] for trial in trials}
    assert len(kinds) == len(trials) == 2 * 4 + 1 + 2 * 2
    assert {kind for kind in kinds if kind[3] == "18:139"} == {("imprints32", "mobilenet_v2", "imagenet", "18:139")}
    assert {kind[2] for kind in kinds if kind[0] == "imprints8"} == {"imagenet"}


def test_large_networks_and_coarse_arrays_can_be_left_out(small, weights):
    networks = {"mobilenet_v2": ["frozen"], "vgg16": ["frozen"]}
    some = {"weights": ["imagenet", "random"], "networks": networks, "splits": {"random": 1}, "uncontrolled": ["vgg16"]}
    trials = plan(CLASSES, ENOUGH, small.settings(**some, coarse_cells=[])).trials
    assert {trial[:3] for trial in trials} == {
        ("imprints32", "mobilenet_v2", "imagenet"), ("imprints32", "mobilenet_v2", "random"),
        ("imprints32", "vgg16", "imagenet"),
    }  # fmt: skip


def test_a_class_with_one_object_is_trained_but_not_left_out(small):
    planned = plan(CLASSES, ENOUGH, small.settings())
    assert list(planned.members["random"]) == ["animal", "chair", "vase"]
    assert list(planned.members["objects"]) == ["animal", "chair"]
    assert ({"split": "objects"}, "class vase has one object alone: it cannot be left out") in planned.notes
    assert {trial.split for trial in planned.trials} == {"random", "objects"}


def test_without_a_class_to_spare_an_object_touches_are_still_drawn(small):
    planned = plan({"chair": ["stool"], "vase": ["urn"]}, ENOUGH, small.settings())
    assert {trial.split for trial in planned.trials} == {"random"}
    assert "fewer than two classes have a second object" in planned.notes[-1][1]


def test_objects_with_too_few_vertices_and_empty_classes_are_named(small):
    planned = plan(CLASSES | {"cup": []}, ENOUGH | {"cow": 7, "urn": 3}, small.settings())
    said = [note for _, note in planned.notes]
    assert planned.members["random"] == {"animal": ["dog", "horse"], "chair": ["stool", "bench"]}
    assert "class animal: cow left out, 7 vertices can be touched, not 8" in said
    assert {"class vase left out: no object of it is left", "class cup left out: no object of it is left"} <= set(said)


def test_one_class_alone_gives_a_note_and_no_training(small):
    planned = plan({"animal": CLASSES["animal"]}, ENOUGH, small.settings())
    assert planned.trials == []
    assert planned.notes == [({}, "two classes or more are needed, got animal: add some to meshes.classes")]


def test_a_network_without_weights_is_a_note_and_the_others_run(small, weights):
    planned = plan(
        CLASSES,
        ENOUGH,
        small.settings(weights=["imagenet"], networks={"googlenet": ["frozen"], "mobilenet_v2": ["frozen"]}),
    )
    about = {"method": "googlenet"}, "googlenet left out, no weights: no registry has it"
    assert about in planned.notes and planned.pretrained == {"mobilenet_v2": "complete"}
    assert {trial.network for trial in planned.trials} == {"mobilenet_v2"}


@pytest.mark.slow
@pytest.mark.parametrize(
    ("change", "reason"),
    [
        ({"networks": {"mobilenet_v2": ["frozen", "boiled"]}}, "transfer.networks.mobilenet_v2: boiled not known"),
        ({"networks": {"mobilenet_v2": []}}, "transfer.networks.mobilenet_v2: none not known"),
        ({"networks": {"mobilenet_v2": ["18:200"]}}, "layers are 1 to 154"),
        ({"networks": {"alexnet": ["18:139"]}}, "transfer.networks.alexnet: 18:139 not known"),
        ({"weights": []}, "transfer.weights: none not known"),
        ({"networks": {"lenet": ["frozen"]}}, "transfer.networks: lenet not known"),
        ({"splits": {"half": 1}}, "transfer.splits: half not known"),
        ({"splits": {"random": 0, "objects": 0}}, "must be 1 or more"),
        ({"touches": 1}, "touches 2"),
        ({"size": 16}, "transfer.size: 16 is too small"),
        ({"uncontrolled": ["lenet"]}, "transfer.uncontrolled: lenet not known"),
        ({"device": "abacus"}, "unknown device"),
        ({"new_object_touches": [1, 8]}, "less than transfer.touches"),
        ({"new_object_touches": []}, "less than transfer.touches"),
        ({"severities": {"rain": [1.0]}}, "transfer.severities: rain not known"),
    ],
)
def test_settings_that_cannot_be_run_are_named(small, change, reason):
    with pytest.raises(ValueError, match=reason):
        check(small.settings(**change))
    check(small.settings())
