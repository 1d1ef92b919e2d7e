"""The last block on cached maps is the network's own; fully connected layers are published or random, and named."""

import numpy as np
import pytest
import torch

from haptic_glance.base.files import write_arrays
from haptic_glance.deep.architectures import fully_connected
from haptic_glance.deep.network import build, recalibrate
from stages.fixation import Params, backbone, finetune
from stages.fixation.backbone import Method, network_inputs
from stages.fixation.finetune import divided, labels_of

pytestmark = pytest.mark.slow

SETTINGS = Params(
    parallels=1, azimuths=3, size=64, projection="camera", methods=[], source="package", device="cpu",
    penalties=[], folds=2,
    rate=0.01, rates=[0.01], epochs=1, batch=4, momentum=0.9,
)  # fmt: skip


PICTURES = np.random.default_rng(0).integers(0, 256, (5, 64, 64)).astype(np.uint8)


def some_network(*_):
    """A MobileNetV2 of random weights, whose maps are not as small as an untrained one's are."""
    network = build("mobilenet_v2", 3, "random", 0)
    recalibrate(network, lambda ids: network_inputs(PICTURES[ids]), np.arange(5))
    return network


def test_the_last_block_on_cached_maps_gives_the_scores_of_the_network(tmp_path, monkeypatch):
    monkeypatch.setattr(backbone, "build", some_network)
    method = Method("mobilenet_v2-last_block", "mobilenet_v2", "last_block")
    for name in ("a", "b"):
        write_arrays(tmp_path / ".pictures" / f"{name}.npz", pictures=PICTURES, seconds=1.0)
        backbone.cache_trunk(name, tmp_path, tmp_path, method, SETTINGS, 0)
    maps, once, again = backbone.read_trunk(tmp_path, method.name, ["a", "b"])
    assert maps.shape[:2] == (2, 10) and once > 0 and again > 0
    assert torch.equal(maps[0, :5], maps[0, 5:]) and not torch.equal(maps[1, :5], maps[1, 5:])
    network = some_network()
    with torch.no_grad():
        expected = network.classify(network.convolutions(network_inputs(PICTURES)))
        task = backbone.cached_task(network, method, maps)
        scores = task.model(task.inputs(torch.arange(5)))
    assert (scores - expected).abs().max() < 0.01 * expected.abs().max()
    drawn = task.training_inputs(torch.zeros(64, dtype=torch.long)).half()
    assert {int((sample == maps[0, 0]).all()) for sample in drawn} == {0, 1}


def test_an_object_without_a_class_is_looked_at_but_neither_trains_nor_tests():
    labels = labels_of(["a", "b", "c"], {"a": "x", "c": "y"}, SETTINGS)
    assert labels.tolist() == [0] * 5 + [-1] * 5 + [1] * 5
    ids = np.concatenate(divided(labels, 0))
    assert sorted(ids) == [*range(5), *range(10, 15)]


def test_a_picture_is_in_the_same_part_for_tasks_that_name_other_objects():
    """The rate is chosen on validation pictures of the task with most classes; no other task may test on them."""
    objects = [f"object {number}" for number in range(40)]
    whole, part = ({name: name[-1] for name in objects[::step]} for step in (1, 3))
    parts = [divided(labels_of(objects, classes, SETTINGS), 0) for classes in (whole, part)]
    assert all(set(few) < set(all_of_them) for all_of_them, few in zip(*parts, strict=True))
    assert [len(ids) for ids in parts[0]] == [120, 40, 40]


def test_heads_and_networks_are_trained_on_the_same_pictures(tmp_path, monkeypatch):
    objects, classes = ["a", "b", "c", "d"], {"a": "x", "c": "y", "d": "x"}
    for number, name in enumerate(objects):
        write_arrays(tmp_path / f".pooled/some/{name}.npz", pooled=5.0 * number + np.arange(5)[:, None])
    seen, head = [], (np.zeros((2, 1)), np.zeros(2))
    monkeypatch.setattr(finetune, "fit_head", lambda features, *_: seen.append(features) or head)
    monkeypatch.setattr(finetune, "unseen_object_rows", lambda *_: [])
    method, settings = Method("some", "mobilenet_v2", "frozen"), Params(**vars(SETTINGS) | {"penalties": [1.0]})
    finetune.train_head("kind", tmp_path, tmp_path, method, settings, objects, {"kind": classes}, 0)
    train = divided(labels_of(objects, classes, settings), 0)[0]
    assert all(features[:, 0].tolist() == train.tolist() for features in seen) and len(seen) == 2


def test_fully_connected_layers_are_those_of_the_state_or_random():
    shapes = {"0.weight": (4096, 25088), "0.bias": (4096,), "3.weight": (4096, 4096), "3.bias": (4096,)}
    state = {f"classifier.{key}": torch.tensor(0.5).expand(shape) for key, shape in shapes.items()}
    assert all(bool((value == 0.5).all()) for value in fully_connected(state).state_dict().values())
    layers = fully_connected({"features.0.weight": torch.zeros(1)})
    linear = layers[0]
    assert isinstance(linear, torch.nn.Linear) and not linear.bias.any()
    assert linear.weight.detach().numpy().std() == pytest.approx(np.sqrt(2 / 25088), rel=0.01)
    assert layers(torch.rand(2, 25088)).shape == (2, 4096)
