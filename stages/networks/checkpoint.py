"""Checkpoints from which an interrupted training continues with the same result: one file, complete or absent."""

import copy
import pickle
import sys
from pathlib import Path
from typing import Any

import torch

from stages.kit.files import whole_file


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
        state = torch.load(path, map_location="cpu", weights_only=True)
        reason = _mismatch(state, settings, parts["model"])
        if not reason:
            _restore(state, parts)
            return state["epoch"]
    except (OSError, RuntimeError, EOFError, LookupError, TypeError, AttributeError, ValueError,
            pickle.UnpicklingError) as error:  # fmt: skip
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
    stored, own = _shapes(state["parts"]["model"]), _shapes(model.state_dict())
    if stored != own:
        first = min(key for key in stored.keys() | own.keys() if stored.get(key) != own.get(key))
        return f"it is of another architecture: {first} has shape {stored.get(first)}, here {own.get(first)}"
    different = [key for key in settings if state["settings"].get(key) != settings[key]]
    return f"it is of a training with other {', '.join(different)}" if different else ""


def _shapes(state):
    return {key: tuple(value.shape) for key, value in state.items()}
