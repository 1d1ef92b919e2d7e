"""Stochastic gradient descent with momentum, and the search of the learning rate."""

import copy
import zlib
from pathlib import Path

import torch

from .checkpoint import resume, save
from .device import device_of, enough_memory, mixed


def learn(task, labels, ids, rate, epochs, batch, momentum, seed=None, checkpoint=None):
    """A copy of task.model trained on the touches `ids`, in evaluation mode; the task's own model stays as it was.

    task: one that stages.networks.modes makes; labels (k,) i8 of all touches; ids (n,) i8. Minimises the cross-entropy
    of a softmax; the touches are shuffled at every epoch, and an odd rest below a batch waits for the next (T5.3). On a
    CUDA card in mixed precision. seed: of torch's random numbers, which go on as they are where it is None.

    checkpoint: a path where the state is kept after every epoch; a training that finds one there goes on behind it and
    ends with the same weights, bit for bit on one thread of a processor. It is removed at the end. Raises ValueError,
    with a remedy, when the memory is too small.
    """
    if seed is not None:
        torch.manual_seed(seed)
    model, device = copy.deepcopy(task.model), device_of(task.model)
    task.begin(model, torch.as_tensor(ids))
    optimiser = torch.optim.SGD([p for p in model.parameters() if p.requires_grad], lr=rate, momentum=momentum)
    scaler = torch.amp.GradScaler(device.type, enabled=device.type == "cuda")
    labels, ids = torch.as_tensor(labels), torch.as_tensor(ids)
    batch = min(batch, len(ids))
    settings = {"rate": rate, "epochs": epochs, "batch": batch, "momentum": momentum, "touches": _digest(ids, labels)}
    settings |= {"seed": seed, "device": device.type}
    settings["learning"] = [name for name, value in model.named_parameters() if value.requires_grad]
    parts, done = {"model": model, "optimiser": optimiser, "scaler": scaler}, 0
    if checkpoint is not None:
        settings["images"] = list(task.inputs(ids[:1]).shape)
        done = resume(Path(checkpoint), settings, **parts)
    with enough_memory():
        for epoch in range(done, epochs):
            _one_epoch(model, task, labels, ids, batch, optimiser, scaler)
            if checkpoint is not None:
                save(checkpoint, epoch + 1, settings, **parts)
        model.eval()
        task.finish(model, ids)
    if checkpoint is not None:
        Path(checkpoint).unlink(missing_ok=True)
    return model


def _one_epoch(model, task, labels, ids, batch, optimiser, scaler):
    device = device_of(model)
    model.train()
    for name in task.fixed:
        model.get_submodule(name).eval()
    shuffled = ids[torch.randperm(len(ids))]
    for start in range(0, len(ids) - batch + 1, batch):
        chosen = shuffled[start : start + batch]
        given, wanted = task.training_inputs(chosen), labels[chosen].to(device)
        with mixed(device):
            loss = torch.nn.functional.cross_entropy(model(given), wanted)
        optimiser.zero_grad()
        scaler.scale(loss).backward()
        scaler.step(optimiser)
        scaler.update()


@torch.no_grad()
def scores(model, task, ids, batch=64):
    """(n, classes) f4: the softmax of the model for the touches `ids`, not augmented."""
    return answers(model, task.inputs, ids, batch)


@torch.no_grad()
def answers(model, inputs, ids, batch=64):
    """(n, classes) f4 on the processor: the softmax of the model for inputs(ids), a part at a time."""
    found = []
    for part in torch.as_tensor(ids).split(batch):
        with enough_memory():
            given = inputs(part)
            with mixed(device_of(model)):
                found.append(model(given).float().softmax(dim=1).cpu())
    return torch.cat(found)


def accuracy(found, labels):
    """Share of touches whose highest score is that of their class; scores that are not finite count as wrong."""
    right = found.argmax(dim=1) == torch.as_tensor(labels)
    return float((right & found.isfinite().all(dim=1)).float().mean())


def search(task, labels, part, validation, rates, **training):
    """(rate, accuracy on the validation part): the best of the learning rates, the first of equals.

    The networks tried learn from the training part without its validation touches, and never from a test touch.
    training: what `learn` is told besides.
    """
    tried = []
    for rate in rates:
        model = learn(task, labels, part, rate, **training)
        tried.append((accuracy(scores(model, task, validation), labels[validation]), rate))
    best = max(tried, key=lambda pair: pair[0])
    return best[1], best[0]


def _digest(ids, labels):
    return zlib.crc32(ids.numpy().tobytes() + labels.numpy().tobytes())
