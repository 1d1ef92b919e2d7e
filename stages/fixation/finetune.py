"""A network a task that learns with every layer (T3.3.3), the costly way beside the frozen one."""

import numpy as np
from kornia import augmentation

from stages.kit import Stopwatch
from stages.kit.files import write_arrays
from stages.kit.repeatable import repeatable
from stages.kit.rng import rng
from stages.networks import build, learn, normalise, settle
from stages.networks.device import choose, device_of, enough_memory
from stages.networks.modes import Task

from .backbone import BATCH, maps_of, read_state, write_state
from .cam import grad_cam
from .heads import commonest, scores
from .options import MODES, method_named
from .pictures import images_of, inputs, read_pictures
from .split import random_views

DEGREES, SCALE = 20, (0.8, 1.2)  # random rotation and rescaling; T3.3.2 gives no range


@enough_memory()
def train(item, folder, settings, tasks, seed):
    """Trains one network (`METHOD@TASK`) on the training views; rows of its accuracy on the test views.

    The same split of views as the frozen heads have. No learning rate is searched: validation views stay unused.
    """
    name, task = item.split("@")
    method, known = method_named(name), tasks[task]
    stacks = [read_pictures(folder, name)[0] for name in known]
    pictures = np.concatenate(stacks)
    classes = np.repeat(list(known.values()), [len(stack) for stack in stacks])
    names, labels = np.unique(classes, return_inverse=True)
    part, _, test = random_views(len(labels), rng(seed, "fixation views"))
    with repeatable(seed), Stopwatch() as watch:
        network = build(method.network, len(names), MODES[method.mode], seed, settings.source)
        lesson = lesson_of(network.to(choose(settings.device)), pictures)
        told = {name: getattr(settings, name) for name in ("rate", "epochs", "batch", "momentum")}
        model = learn(lesson, labels, part, **told, checkpoint=folder / ".networks" / f"{name}-{task}.pt")
    write_state(folder, f"{name}-{task}", model)
    with repeatable(seed):
        maps = maps_of(model, pictures[test])
    found = scores(maps.mean(axis=(2, 3)), *linear(model)).argmax(axis=1)
    row = {"object": None, "method": name, "task": task, "view": None, "split": "views"}
    return [
        row | {"metric": "accuracy", "value": float((found == labels[test]).mean()), "seconds": watch.seconds},
        row | {"metric": "chance", "value": commonest(labels, part, test)},
    ]


def lesson_of(network, pictures):
    """The stages.networks Task to train every layer on grey pictures (k, h, w) u1, turned and rescaled at random."""
    network.requires_grad_(True)
    moved, device = augmentation.RandomAffine(degrees=DEGREES, scale=SCALE, p=1.0), device_of(network)

    def plain(ids):
        return inputs(pictures[np.asarray(ids)], device)

    def changed(ids):
        return normalise(moved(images_of(pictures[np.asarray(ids)], device)))

    def finish(model, ids):
        settle(model, plain, ids, BATCH)

    return Task(network, changed, plain, finish, lambda images: normalise(images.to(device)))


def linear(network):
    """(weights (k, C), bias (k,)) of the network's own head."""
    layer = network.head[-1]
    return layer.weight.detach().cpu().numpy(), layer.bias.detach().cpu().numpy()


def look(item, folder, settings, tasks, seed):
    """The Grad-CAM maps of one object (`METHOD@NAME`) by each task's network, and a row of what they cost."""
    name, _, thing = item.partition("@")
    method, found = method_named(name), {}
    pictures, _ = read_pictures(folder, thing)
    with repeatable(seed), Stopwatch() as watch:
        for task, known in tasks.items():
            network = build(method.network, len(set(known.values())), MODES[method.mode], seed, settings.source)
            read_state(folder, f"{name}-{task}", network.to(choose(settings.device)))
            maps, (weights, bias) = maps_of(network, pictures), linear(network)
            winners = scores(maps.mean(axis=(2, 3)), weights, bias).argmax(axis=1)
            found[task] = grad_cam(maps, weights, winners)
    write_arrays(folder / ".cams" / name / f"{thing}.npz", **found, seconds=watch.seconds)
    row = {"object": thing, "method": name, "task": None, "view": None, "metric": "views"}
    return [row | {"value": len(pictures), "seconds": watch.seconds}]
