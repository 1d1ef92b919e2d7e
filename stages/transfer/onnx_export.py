"""The hybrid network as ONNX and its scores in onnxruntime, and the change of each convolution by training (T5.4).

The change is shown in T figure 5.4.
"""

import contextlib
import copy
import io
import re
import warnings
from pathlib import Path

import numpy as np
import torch

from haptic_glance.base.files import whole_file
from haptic_glance.deep.hybrid import SENSES, HybridNet
from haptic_glance.deep.modes import is_mobilenet_v2, layers

OPSET = 18  # of 2022, the oldest that torch's exporter writes without conversion
INPUT = "images"


def export_onnx(path: Path, network: HybridNet, size: int) -> None:
    """Writes a HybridNet to one .onnx file.

    Input `images` (b, 6, size, size), outputs `vision` and `touch` (b, classes); b is variable. Paths of the
    machine are removed from the file. Uses torch's exporter of programs, which needs onnx and onnxscript.
    """
    import onnx

    example = torch.rand(2, 6, size, size, generator=torch.Generator().manual_seed(0))
    with warnings.catch_warnings(), contextlib.redirect_stdout(io.StringIO()):
        warnings.simplefilter("ignore")  # the exporter uses deprecated parts of torch
        program = torch.onnx.export(
            copy.deepcopy(network).cpu(), (example,), input_names=[INPUT], output_names=list(SENSES), dynamo=True,
            dynamic_shapes={INPUT: {0: torch.export.Dim("batch")}}, opset_version=OPSET, verbose=False,
        )  # fmt: skip
    assert program is not None  # it is None for the older exporter alone
    model = program.model_proto
    for part in (*model.graph.node, *model.graph.value_info, model.graph, model):
        part.ClearField("metadata_props")  # paths of the source code of each node
        part.ClearField("doc_string")
    with whole_file(path) as part:
        onnx.save(model, part)


def onnx_scores(path: Path, images: torch.Tensor) -> list[np.ndarray]:
    """[vision, touch] scores (b, classes) by onnxruntime for images (b, 6, h, w) f4, on one thread."""
    import onnxruntime

    options = onnxruntime.SessionOptions()
    options.intra_op_num_threads = 1
    session = onnxruntime.InferenceSession(str(path), options, providers=["CPUExecutionProvider"])
    scores = session.run(list(SENSES), {INPUT: np.asarray(images, dtype=np.float32)})
    return [np.asarray(part) for part in scores]


def weight_changes(before: torch.nn.Module, after: torch.nn.Module) -> dict[str, float]:
    """{name of a convolution: mean squared difference of its weights} of two networks of the same architecture.

    The weights of each layer are first scaled to 0..1, before and after separately (T5.4); equal weights become 0.
    Grouped convolutions are included, biases are not. In the order of the network.
    """
    trained = dict(after.named_modules())
    convolutions = {n: layer for n, layer in before.named_modules() if isinstance(layer, torch.nn.Conv2d)}
    return {
        name: float(np.mean((_scaled(layer.weight) - _scaled(trained[name].weight)) ** 2))
        for name, layer in convolutions.items()
    }


def network_parts(network: torch.nn.Module) -> dict[str, str]:
    """{name of a convolution: the part of the network that it belongs to}.

    In MobileNetV2 this is the block of Matlab's layer (Conv1, expanded_conv, block_1, ...); in other networks conv_1,
    conv_2 and so on, from the input to the output.
    """
    names = [name for name, layer in network.named_modules() if isinstance(layer, torch.nn.Conv2d)]
    if not is_mobilenet_v2(network):
        return {name: f"conv_{i}" for i, name in enumerate(names, start=1)}
    matlab = {layer.module: layer.name for layer in layers()}
    return {name: re.sub("_(expand|depthwise|project)$", "", matlab[name]) for name in names}


def _scaled(weight):
    values = weight.detach().cpu().double().numpy()
    low, high = values.min(), values.max()
    return (values - low) / (high - low) if high > low else np.zeros_like(values)
