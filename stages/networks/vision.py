"""torchvision, made to import beside a CPU build of torch.

torchvision's compiled operators are linked against one build of torch. Beside another (the usual case for the PyPI
wheel of torchvision and a CPU wheel of torch) they do not load, and then `import torchvision` stops with `operator
torchvision::nms does not exist`, for it describes the shapes of operators that nobody registered. Models, transforms
and weights need none of those operators: after that one failure, and no other, their schemas are declared here and
the import is repeated. On a machine with a matching build nothing is declared. Calling the operators stays an error.

Every import of torchvision in the project goes through here: `from .vision import torchvision`.
"""

import importlib
import sys

import torch

SCHEMAS = (  # as torchvision registers them in C++: ops/nms.cpp, ops/quantized/cpu/qnms_kernel.cpp
    "nms(Tensor dets, Tensor scores, float iou_threshold) -> Tensor",
    "qnms(Tensor dets, Tensor scores, float iou_threshold) -> Tensor",
)
_declared = []  # a torch.library.Library withdraws what it declared when it is collected: it must live on


def load():
    """Imports torchvision and returns it; raises ImportError with the remedy when it cannot be imported at all."""
    try:
        return importlib.import_module("torchvision")
    except RuntimeError as error:
        if "torchvision::" not in str(error) or "does not exist" not in str(error) or _declared:
            raise ImportError(
                f"torchvision does not import beside torch {torch.__version__}: {error}. "
                "Install the pair of releases that constraints.txt names."
            ) from error
    _drop_half_imported()
    _declare()
    return importlib.import_module("torchvision")


def declared():
    """True when this process had to declare the schemas, so that torchvision's own operators cannot be called."""
    return bool(_declared)


def _drop_half_imported():
    for name in [name for name in sys.modules if name.partition(".")[0] == "torchvision"]:
        del sys.modules[name]


def _declare():
    library = torch.library.Library("torchvision", "FRAGMENT")
    for schema in SCHEMAS:
        library.define(schema)
    _declared.append(library)


torchvision = load()
