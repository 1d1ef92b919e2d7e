"""Small settings of the transfer stage."""

from types import SimpleNamespace

import pytest

from stages.transfer import Params

SETTINGS = {
    "touches": 8, "detector": "thesis_ssim", "cells": 32, "pitch": 0.005, "coarse_cells": [8],
    "networks": {"mobilenet_v2": ["frozen"]}, "weights": ["random"], "uncontrolled": [],
    "source": "package",
    "splits": {"random": 1, "objects": 1}, "size": 32, "copies": 1, "train_share": 0.75, "validation_share": 0.25,
    "frozen_rates": [0.003, 0.01], "finetuned_rates": [0.003], "search_epochs": 2, "epochs": 4, "batch": 8,
    "passes": ["printed"], "patience": 2, "most_epochs": 6,
    "momentum": 0.9, "device": "cpu",
    "hybrid_middles": [],
    "hybrid_passes": "printed", "hybrid_size": 32,
    "hybrid_pictures": 4, "hybrid_colour": False, "hybrid_rate": 0.003, "hybrid_onnx": False,
    "hybrid_severities": {"picture_noise": [0.1]}, "new_object_touches": [1, 2],
}  # fmt: skip


@pytest.fixture
def small():
    """small.settings(key=value, ...): Params of a stage that takes seconds."""
    other = {field: SETTINGS.get(field, 1) for field in Params.__dataclass_fields__}
    return SimpleNamespace(settings=lambda **changes: Params(**(other | changes)))
