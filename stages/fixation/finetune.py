"""Mode `finetuned`: one network per task with every layer trained (T3.3.3), costlier than frozen networks."""

from collections.abc import Mapping
from pathlib import Path

import numpy as np
import torch
from kornia import augmentation

from stages.kit import Stopwatch
from stages.kit.files import write_arrays
from stages.kit.repeatable import repeatable
from stages.kit.rng import rng
from stages.networks import Network, build, normalise, recalibrate, train_model
from stages.networks.device import choose_device, device_of, explain_out_of_memory
from stages.networks.modes import Task

from .backbone import BATCH, last_maps, read_state, write_state
from .cam import grad_cam
from .heads import majority_accuracy, scores
from .options import MODES, Method
from .pictures import network_inputs, read_pictures, to_images
from .schema import Params
from .split import random_views

DEGREES, SCALE = 20, (0.8, 1.2)  # random rotation and rescaling; T3.3.2 gives no range


@explain_out_of_memory()
def train_network(
    task: str,
    folder: Path,
    made: Path,
    method: Method,
    settings: Params,
    tasks: Mapping[str, Mapping[str, str]],
    seed: int,
) -> list[dict]:
    """Trains the network of one task on the training views; returns rows of its accuracy on the test views.

    made: the folder of the pictures. The split of views is that of the frozen heads. The learning rate is fixed, so the
    validation views are not used.
    """
    known = tasks[task]
    stacks = [read_pictures(made, name)[0] for name in known]
    pictures = np.concatenate(stacks)
    classes = np.repeat(list(known.values()), [len(stack) for stack in stacks])
    names, labels = np.unique(classes, return_inverse=True)
    part, _, test = random_views(len(labels), rng(seed, "fixation views"))
    with repeatable(seed), Stopwatch() as watch:
        network = build(method.network, len(names), MODES[method.mode], seed, settings.source)
        training = training_task(network.to(choose_device(settings.device)), pictures)
        options = {name: getattr(settings, name) for name in ("rate", "epochs", "batch", "momentum")}
        model = train_model(training, labels, part, **options, checkpoint=folder / "training.pt")
    write_state(folder, f"{method.name}-{task}", model)
    with repeatable(seed):
        maps = last_maps(model, pictures[test])
    found = scores(maps.mean(axis=(2, 3)), *head_of(model)).argmax(axis=1)
    row = {"method": method.name, "task": task, "split": "views"}
    return [
        row | {"metric": "accuracy", "value": float((found == labels[test]).mean()), "seconds": watch.seconds},
        row | {"metric": "chance", "value": majority_accuracy(labels, part, test)},
    ]


def training_task(network: Network, pictures: np.ndarray) -> Task:
    """The Task to train every layer on grey pictures (k, h, w) u1, rotated and rescaled at random."""
    network.requires_grad_(True)
    augment, device = augmentation.RandomAffine(degrees=DEGREES, scale=SCALE, p=1.0), device_of(network)

    def plain(ids):
        return network_inputs(pictures[np.asarray(ids)], device)

    def augmented(ids):
        return normalise(augment(to_images(pictures[np.asarray(ids)], device)))

    def finish(model, ids):
        recalibrate(model, plain, ids, BATCH)

    return Task(network, augmented, plain, finish, lambda images: normalise(images.to(device)))


def head_of(network: Network) -> tuple[np.ndarray, np.ndarray]:
    """(weights (k, C), bias (k,)) of a network's linear head."""
    layer = network.head[-1]
    assert isinstance(layer, torch.nn.Linear)
    return layer.weight.detach().cpu().numpy(), layer.bias.detach().cpu().numpy()


def compute_cams(
    name: str,
    folder: Path,
    made: Path,
    method: Method,
    settings: Params,
    tasks: Mapping[str, Mapping[str, str]],
    seed: int,
) -> list[dict]:
    """Stores the Grad-CAM maps of one object by each task's network; returns a row with their cost.

    made: the folder of the pictures and networks.
    """
    found, (pictures, _) = {}, read_pictures(made, name)
    with repeatable(seed), Stopwatch() as watch:
        for task, known in tasks.items():
            network = build(method.network, len(set(known.values())), MODES[method.mode], seed, settings.source)
            read_state(made, f"{method.name}-{task}", network.to(choose_device(settings.device)))
            maps, (weights, bias) = last_maps(network, pictures), head_of(network)
            winners = scores(maps.mean(axis=(2, 3)), weights, bias).argmax(axis=1)
            found[task] = grad_cam(maps, weights, winners)
    write_arrays(folder / ".cams" / method.name / f"{name}.npz", **found, seconds=watch.seconds)
    row = {"item": name, "method": method.name, "metric": "views"}
    return [row | {"value": len(pictures), "seconds": watch.seconds}]
