"""The course of a training: its curve, when it ends, and the best weights so far (T5.3)."""

import math
from collections.abc import Sequence
from typing import Any

import numpy as np
import torch

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
            raise Diverged(f"diverged: {wrong[0].replace('_', ' ')} is not finite in pass {len(self.curve)}")
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


def check_passes(passes: Sequence[str], setting: str) -> None:
    """Raises ValueError, which names the setting, for passes that are none of PASSES."""
    unknown = sorted(set(passes) - {*PASSES})
    if unknown or not passes:
        raise ValueError(f"{setting}: {', '.join(unknown) or 'none'} not known, choose from {', '.join(PASSES)}")


def _rank(values: dict[str, float]) -> tuple[float, float]:
    return values["validation_accuracy"], -values["validation_loss"]
