"""Stored weights put into a module, or refused with a word that says why."""

import numpy as np
import torch


def restore(module, state, name):
    """Gives a module the weights of a state: {parameter or buffer: tensor or array}, all of them and no other.

    name: what the weights should be of, for the message. The count of batches that normalisation layers keep may be
    absent, since some libraries store none. Raises ValueError for weights of another architecture, naming the first
    entry that does not fit, and for values that are not finite.
    """
    own = module.state_dict()
    try:
        found = {key: _tensor(value) for key, value in dict(state).items()}
    except (TypeError, ValueError) as error:
        raise ValueError(f"these are no weights of {name}: {error}") from None
    _compare({key: tuple(value.shape) for key, value in own.items()}, found, name)
    for key, value in found.items():
        if not bool(value.isfinite().all()):
            raise ValueError(f"the weights of {name} are damaged: {key} holds values that are not finite")
    module.load_state_dict(found, strict=False)


def _compare(shapes, found, name):
    missing = [key for key in shapes if key not in found and not key.endswith("num_batches_tracked")]
    strange = [key for key in found if key not in shapes]
    other = [key for key in found if key in shapes and tuple(found[key].shape) != shapes[key]]
    if not (missing or strange or other):
        return
    said = [f"{key} is {tuple(found[key].shape)} instead of {shapes[key]}" for key in other[:1]]
    said += [
        f"{len(keys)} {kind}, first {keys[0]}" for kind, keys in (("missing", missing), ("too many", strange)) if keys
    ]
    raise ValueError(f"these are no weights of {name}: {'; '.join(said)}")


def _tensor(value):
    return value.detach() if isinstance(value, torch.Tensor) else torch.as_tensor(np.asarray(value))
