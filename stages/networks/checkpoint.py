"""What a training needs to go on after a kill as if nothing had happened: one file, whole or absent."""

import copy
import pickle
import sys

import torch

from stages.kit.files import whole_file


def save(path, epoch, settings, **parts):
    """Writes the state of each part (a model, an optimiser, ...) and of torch's random numbers behind `epoch` passes.

    settings: what the training is of, as plain values; it goes on only under the same.
    """
    state = {"epoch": epoch, "settings": settings, "random": torch.get_rng_state()}
    if torch.cuda.is_available():
        state["random_cuda"] = torch.cuda.get_rng_state()
    state["parts"] = {name: part.state_dict() for name, part in parts.items()}
    with whole_file(path) as temporary:
        torch.save(state, temporary)


def resume(path, settings, **parts):
    """The passes that are done: their state is put back into the parts and into torch's random numbers. 0 where none.

    A file that is damaged, of another architecture or of other settings is passed over with a word, and the training
    begins anew. Nothing is unpickled but tensors and plain values.
    """
    if not path.exists():
        return 0
    try:
        state = torch.load(path, map_location="cpu", weights_only=True)
        reason = _strange(state, settings, parts["model"])
        if not reason:
            _restore(state, parts)
    except (OSError, RuntimeError, EOFError, KeyError, TypeError, AttributeError, ValueError,
            pickle.UnpicklingError) as error:  # fmt: skip
        reason = f"it cannot be read ({' '.join(str(error).split())[:80]})"
    if reason:
        print(f"{path.name}: passed over, {reason}; the training begins anew", file=sys.stderr)
        return 0
    return state["epoch"]


def _restore(state, parts):
    """Puts a state back into the parts and into torch's random numbers; where that fails, all is as before."""
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


def _strange(state, settings, model):
    """Why a state is not one of this training; "" where it is."""
    stored, own = _shapes(state["parts"]["model"]), _shapes(model.state_dict())
    if stored != own:
        first = min(key for key in stored.keys() | own.keys() if stored.get(key) != own.get(key))
        return f"it is of another architecture: {first} has shape {stored.get(first)}, here {own.get(first)}"
    strange = [key for key in settings if state["settings"].get(key) != settings[key]]
    return f"it is of a training with other {', '.join(strange)}" if strange else ""


def _shapes(state):
    return {key: tuple(value.shape) for key, value in state.items()}
