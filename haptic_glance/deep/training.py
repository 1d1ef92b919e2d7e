"""Trains a network by stochastic gradient descent with momentum, until nothing improves (T5.3).

The learning rate is searched. A checkpoint is one file, complete or absent, and an interrupted training continues from
its checkpoint with the same result.
"""

import copy
import math
import pickle
import sys
import zipfile
import zlib
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
import torch

from haptic_glance.base.files import whole_file

from .device import device_of, explain_out_of_memory, mixed_precision
from .images import Transform
from .modes import Task

PRINTED, CONVERGED = "printed", "converged"
PASSES = (PRINTED, CONVERGED)  # as many passes as the thesis's captions print, or until nothing improves


class Diverged(ValueError):
    """A training whose loss is no longer finite."""


class Learning:
    """The curve of a training, pass by pass; with validation touches also its end and its best weights.

    validation: ids (n,) i8 of the touches whose accuracy decides which weights are best, of equals the ones with the
    lowest loss; None: all passes are made and the last weights are kept. patience: the training ends after as many
    passes without better ones. curve: a dict of each pass with `loss` and `train_accuracy`, both over the augmented
    images as they were learned, and with validation touches `validation_accuracy` and `validation_loss`.
    """

    def __init__(self, validation: np.ndarray | torch.Tensor | None = None, patience: int = 1) -> None:
        if patience < 1:
            raise ValueError(f"patience must be 1 or more, got {patience}")
        if validation is not None and not len(validation):
            raise ValueError("there are no validation touches: give some, or None for all passes")
        self.validation, self.patience = validation, patience
        self.curve: list[dict[str, float]] = []
        self.best: dict[str, torch.Tensor] = {}
        self.best_pass = 0  # the number of the pass that `best` is of, from 1

    @property
    def finished(self) -> bool:
        """Whether nothing has improved for `patience` passes."""
        return self.validation is not None and len(self.curve) - self.best_pass >= self.patience

    def add(self, model: torch.nn.Module, **values: float) -> None:
        """Appends a pass to the curve and keeps the model's weights if they are the best so far.

        Raises Diverged where a value is not finite, naming the pass.
        """
        self.curve.append(values)
        wrong = [name for name, value in values.items() if not math.isfinite(value)]
        if wrong:
            cause = f"{wrong[0].replace('_', ' ')} is not finite in pass {len(self.curve)}"
            raise Diverged(f"diverged: {cause}: take a lower learning rate")
        if self.validation is not None and (
            not self.best_pass or _rank(values) > _rank(self.curve[self.best_pass - 1])
        ):
            self.best_pass = len(self.curve)
            self.best = {key: value.detach().cpu().clone() for key, value in model.state_dict().items()}

    def restore(self, model: torch.nn.Module) -> None:
        """Gives the model its best weights, if validation touches have chosen any."""
        if self.best:
            model.load_state_dict(self.best)

    def settings(self) -> dict[str, Any]:
        """Settings under which a checkpoint is resumed, as plain values; empty without validation touches."""
        if self.validation is None:
            return {}
        return {"patience": self.patience, "validation": torch.as_tensor(self.validation).tolist()}

    def state_dict(self) -> dict[str, Any]:
        """The state that a checkpoint keeps."""
        return {"curve": self.curve, "best": self.best, "best_pass": self.best_pass}

    def load_state_dict(self, state: dict[str, Any]) -> None:
        """Takes over what a checkpoint kept."""
        self.curve, self.best, self.best_pass = list(state["curve"]), state["best"], state["best_pass"]


def check_passes(passes: Sequence[str], setting: str, choices: Sequence[str] = PASSES) -> None:
    """Raises ValueError, which names the setting, for passes that are not known."""
    unknown = sorted(set(passes) - {*choices})
    if unknown or not passes:
        raise ValueError(f"{setting}: {', '.join(unknown) or 'none'} not known, choose from {', '.join(choices)}")


def _rank(values: dict[str, float]) -> tuple[float, float]:
    return values["validation_accuracy"], -values["validation_loss"]


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

    task: of haptic_glance.deep.modes; labels (k,) i8 of all touches; ids (n,) i8. Minimises the cross-entropy of a
    softmax. The touches are shuffled at every epoch, and the last ones that do not fill a batch are skipped (T5.3).
    Uses mixed precision on a CUDA card. seed: of torch's random numbers; None leaves them as they are.

    checkpoint: a path where the state is saved after every epoch and removed at the end. A training that finds one
    there continues from it and ends with the same weights, bit for bit on one CPU thread. Raises ValueError, with a
    remedy, when there is too little memory, and for no touches or a batch below 1.

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
    if min(batch, len(ids)) < 1:
        raise ValueError(f"a training needs touches and a batch of 1 or more, got {len(ids)} touches, batch {batch}")
    batch = min(batch, len(ids))
    settings = {"rate": rate, "epochs": epochs, "batch": batch, "momentum": momentum, "touches": _digest(ids, labels)}
    settings |= {"seed": seed, "device": device.type}
    settings["learning"] = [name for name, value in model.named_parameters() if value.requires_grad]
    settings |= learning.settings() if learning else {}
    parts: dict[str, Any] = {"model": model, "optimiser": optimiser, "scaler": scaler}
    parts, start = parts | ({"learning": learning} if learning else {}), 0
    if checkpoint is not None:
        settings["images"] = list(task.inputs(ids[:1]).shape)
        start = resume(Path(checkpoint), settings, **parts)
    try:
        with explain_out_of_memory():
            for epoch in range(start, epochs):
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
    predicted, truth = predict_probabilities(model, task.inputs, validation), labels[torch.as_tensor(validation)]
    loss = torch.nn.functional.nll_loss(predicted.clamp_min(SMALLEST).log(), truth)
    return {"validation_accuracy": accuracy(predicted, truth), "validation_loss": float(loss)}


@torch.no_grad()
def predict_probabilities(
    model: torch.nn.Module, inputs: Transform, ids: np.ndarray | torch.Tensor, batch: int = 64
) -> torch.Tensor:
    """(n, classes) f4 on the CPU: the softmax of the model, put in evaluation mode, for inputs(ids), in batches."""
    model.eval()
    batches = []
    for part in torch.as_tensor(ids).split(batch):
        with explain_out_of_memory():
            images = inputs(part)
            with mixed_precision(device_of(model)):
                batches.append(model(images).float().softmax(dim=1).cpu())
    return torch.cat(batches)


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
    if not rates:
        raise ValueError("there is no learning rate to try")
    trials = []
    for rate in rates:
        model = train_model(task, labels, part, rate, **training)
        trials.append((accuracy(predict_probabilities(model, task.inputs, validation), labels[validation]), rate))
    best = max(trials, key=lambda pair: pair[0])
    return best[1], best[0]


def _digest(ids, labels):
    return zlib.crc32(ids.numpy().tobytes() + labels.numpy().tobytes())


def save(path: Path, epoch: int, settings: dict[str, Any], **parts: Any) -> None:
    """Writes the state of each part (a model, an optimiser, ...) and of torch's random numbers after `epoch` epochs.

    settings: of the training, as plain values; it is resumed only under the same ones.
    """
    state = {"epoch": epoch, "settings": settings, "random": torch.get_rng_state()}
    if torch.cuda.is_available():
        state["random_cuda"] = torch.cuda.get_rng_state()
    state["parts"] = {name: part.state_dict() for name, part in parts.items()}
    with whole_file(path) as temporary:
        torch.save(state, temporary)


def resume(path: Path, settings: dict[str, Any], **parts: Any) -> int:
    """The number of epochs done, 0 without a file; loads their state into the parts and torch's random numbers.

    A file that is damaged, or of another architecture or other settings, is ignored with a message, and the training
    starts again. Only tensors and plain values are unpickled.
    """
    if not path.exists():
        return 0
    try:
        with zipfile.ZipFile(path) as archive:
            if archive.testzip():  # torch compares no checksums
                raise ValueError("its checksum is wrong")
        state = torch.load(path, map_location="cpu", weights_only=True)
        reason = _mismatch(state, settings, parts["model"])
        if not reason:
            _restore(state, parts)
            return state["epoch"]
    except (OSError, RuntimeError, EOFError, LookupError, TypeError, AttributeError, ValueError,
            pickle.UnpicklingError, zipfile.BadZipFile) as error:  # fmt: skip
        reason = f"it cannot be read ({' '.join(str(error).split())[:80]})"
    print(f"{path.name}: ignored, {reason}; the training starts again", file=sys.stderr)
    return 0


def _restore(state, parts):
    """Loads a state into the parts and into torch's random numbers; where that fails, all stay unchanged."""
    before = {name: copy.deepcopy(part.state_dict()) for name, part in parts.items()}
    random, _ = state["random"], state["epoch"]
    try:
        for name, part in parts.items():
            part.load_state_dict(state["parts"][name])
        torch.set_rng_state(random)
        if "random_cuda" in state and torch.cuda.is_available():
            torch.cuda.set_rng_state(state["random_cuda"])
    except Exception:
        for name, part in parts.items():
            part.load_state_dict(before[name])
        raise


def _mismatch(state, settings, model):
    """Why a state does not belong to this training; "" where it does."""
    shapes, current = _shapes(state["parts"]["model"]), _shapes(model.state_dict())
    if shapes != current:
        first = min(key for key in shapes.keys() | current.keys() if shapes.get(key) != current.get(key))
        return f"it is of another architecture: {first} has shape {shapes.get(first)}, here {current.get(first)}"
    different = [key for key in settings if state["settings"].get(key) != settings[key]]
    return f"it is of a training with other {', '.join(different)}" if different else ""


def _shapes(state):
    return {key: tuple(value.shape) for key, value in state.items()}
