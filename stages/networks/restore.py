"""Stored weights loaded into a module, or refused with the reason."""

from collections.abc import Mapping
from typing import Any

import numpy as np
import torch


def restore(module: torch.nn.Module, state: Mapping[str, Any], name: str) -> None:
    """Loads a state {parameter or buffer: tensor or array} into a module, whose entries it must match exactly.

    name: of the network, for messages. The number of batches that normalisation layers count may be absent, since some
    libraries do not store it. Raises ValueError for weights of another architecture, naming the first
    entry that does not fit, and for values that are not finite.
    """
    own = module.state_dict()
    try:
        found = {key: _tensor(value) for key, value in dict(state).items()}
    except (TypeError, ValueError) as error:
        raise ValueError(f"these are not weights of {name}: {error}") from None
    _compare({key: tuple(value.shape) for key, value in own.items()}, found, name)
    for key, value in found.items():
        if not bool(value.isfinite().all()):
            raise ValueError(f"the weights of {name} are damaged: {key} holds values that are not finite")
    module.load_state_dict(found, strict=False)


def _compare(shapes, found, name):
    missing = [key for key in shapes if key not in found and not key.endswith("num_batches_tracked")]
    unexpected = [key for key in found if key not in shapes]
    other = [key for key in found if key in shapes and tuple(found[key].shape) != shapes[key]]
    if not (missing or unexpected or other):
        return
    said = [f"{key} is {tuple(found[key].shape)} instead of {shapes[key]}" for key in other[:1]]
    said += [
        f"{len(keys)} {kind}, first {keys[0]}"
        for kind, keys in (("missing", missing), ("unexpected", unexpected))
        if keys
    ]
    raise ValueError(f"these are not weights of {name}: {'; '.join(said)}")


def _tensor(value):
    return value.detach() if isinstance(value, torch.Tensor) else torch.as_tensor(np.asarray(value))
