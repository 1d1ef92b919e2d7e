"""The hybrid network as ONNX, and its scores in onnxruntime."""

import contextlib
import copy
import io
import warnings
from pathlib import Path

import numpy as np
import torch

from haptic_glance.base.files import whole_file
from haptic_glance.deep.hybrid import SENSES, HybridNet

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
    return [np.asarray(one) for one in scores]
