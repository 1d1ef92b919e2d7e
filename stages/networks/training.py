"""Stochastic gradient descent with momentum, and the search of the learning rate."""

import copy
import zlib
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
import torch

from .checkpoint import resume, save
from .device import device_of, explain_out_of_memory, mixed_precision
from .images import Transform
from .learning import Diverged, Learning
from .modes import Task

SMALLEST = 1e-12  # probability: the logarithm of less is cut off


def train_model(
    task: Task,
    labels: np.ndarray | torch.Tensor,
    ids: np.ndarray | torch.Tensor,
    rate: float,
    epochs: int,
    batch: int,
    momentum: float,
    seed: int | None = None,
    checkpoint: Path | None = None,
    learning: Learning | None = None,
) -> torch.nn.Module:
    """A copy of task.model trained on the touches `ids`, in evaluation mode; the task's own model stays unchanged.

    task: of stages.networks.modes; labels (k,) i8 of all touches; ids (n,) i8. Minimises the cross-entropy of a
    softmax. The touches are shuffled at every epoch, and the last ones that do not fill a batch are skipped (T5.3).
    Uses mixed precision on a CUDA card. seed: of torch's random numbers; None leaves them as they are.

    checkpoint: a path where the state is saved after every epoch and removed at the end. A training that finds one
    there continues from it and ends with the same weights, bit for bit on one CPU thread. Raises ValueError, with a
    remedy, when there is too little memory.

    learning: collects the curve; with validation touches, `epochs` is the most that are made, and the copy has the best
    weights. Raises Diverged where the loss is not finite. Without it a diverged model is returned as it is.
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
    settings |= learning.settings() if learning else {}
    parts: dict[str, Any] = {"model": model, "optimiser": optimiser, "scaler": scaler}
    parts, done = parts | ({"learning": learning} if learning else {}), 0
    if checkpoint is not None:
        settings["images"] = list(task.inputs(ids[:1]).shape)
        done = resume(Path(checkpoint), settings, **parts)
    try:
        with explain_out_of_memory():
            for epoch in range(done, epochs):
                if learning and learning.finished:
                    break
                course = _one_epoch(model, task, labels, ids, batch, optimiser, scaler)
                if learning:
                    learning.add(model, **course, **_validated(model, task, labels, learning.validation))
                if checkpoint is not None:
                    save(checkpoint, epoch + 1, settings, **parts)
            if learning:
                learning.restore(model)
            model.eval()
            task.finish(model, ids)
    except Diverged:
        _remove(checkpoint)
        raise
    _remove(checkpoint)
    return model


def _remove(checkpoint):
    if checkpoint is not None:
        Path(checkpoint).unlink(missing_ok=True)


def _one_epoch(model, task, labels, ids, batch, optimiser, scaler):
    """{loss, train_accuracy}: means over the touches that were learned from."""
    device, losses, right = device_of(model), [], []
    model.train()
    for name in task.fixed:
        model.get_submodule(name).eval()
    shuffled = ids[torch.randperm(len(ids))]
    for start in range(0, len(ids) - batch + 1, batch):
        part = shuffled[start : start + batch]
        inputs, targets = task.training_inputs(part), labels[part].to(device)
        with mixed_precision(device):
            scores = model(inputs)
            loss = torch.nn.functional.cross_entropy(scores, targets)
        losses.append(loss.detach())
        right.append((scores.detach().argmax(dim=1) == targets).float().mean())
        optimiser.zero_grad()
        scaler.scale(loss).backward()
        scaler.step(optimiser)
        scaler.update()
    return {"loss": float(torch.stack(losses).mean()), "train_accuracy": float(torch.stack(right).mean())}


def _validated(model, task, labels, validation):
    """{validation_accuracy, validation_loss} of the touches that decide which weights are best; empty without them."""
    if validation is None:
        return {}
    model.eval()
    found, truth = predict_probabilities(model, task.inputs, validation), labels[torch.as_tensor(validation)]
    loss = torch.nn.functional.nll_loss(found.clamp_min(SMALLEST).log(), truth)
    return {"validation_accuracy": accuracy(found, truth), "validation_loss": float(loss)}


@torch.no_grad()
def predict_probabilities(
    model: torch.nn.Module, inputs: Transform, ids: np.ndarray | torch.Tensor, batch: int = 64
) -> torch.Tensor:
    """(n, classes) f4 on the CPU: the softmax of the model for inputs(ids), computed in batches."""
    found = []
    for part in torch.as_tensor(ids).split(batch):
        with explain_out_of_memory():
            images = inputs(part)
            with mixed_precision(device_of(model)):
                found.append(model(images).float().softmax(dim=1).cpu())
    return torch.cat(found)


def accuracy(probabilities: torch.Tensor, labels: np.ndarray | torch.Tensor) -> float:
    """The share of touches whose class has the highest probability; rows that are not finite count as wrong."""
    right = probabilities.argmax(dim=1) == torch.as_tensor(labels)
    return float((right & probabilities.isfinite().all(dim=1)).float().mean())


def search_rate(
    task: Task,
    labels: np.ndarray | torch.Tensor,
    part: np.ndarray,
    validation: np.ndarray,
    rates: Sequence[float],
    **training: Any,
) -> tuple[float, float]:
    """(rate, accuracy on the validation part): the best of the learning rates, the first of equals.

    part, validation: ids of touches to train on and to validate on. training: the other arguments of train_model.
    """
    tried = []
    for rate in rates:
        model = train_model(task, labels, part, rate, **training)
        tried.append((accuracy(predict_probabilities(model, task.inputs, validation), labels[validation]), rate))
    best = max(tried, key=lambda pair: pair[0])
    return best[1], best[0]


def _digest(ids, labels):
    return zlib.crc32(ids.numpy().tobytes() + labels.numpy().tobytes())
