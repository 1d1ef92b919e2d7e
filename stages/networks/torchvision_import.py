"""torchvision, made to import beside a CPU build of torch.

torchvision's compiled operators are linked against one build of torch. With another build (usual for the PyPI wheel of
torchvision and a CPU wheel of torch) they do not load, and `import torchvision` fails with `operator torchvision::nms
does not exist`, since it describes the shapes of operators that are not registered. Models, transforms and weights need
none of those operators. After that failure, and no other, their schemas are declared here and the import is repeated.
With a matching build nothing is declared. Calling the operators remains an error.

Every import of torchvision in the project goes through here: `from .torchvision_import import torchvision`.
"""

import importlib
import sys
from types import ModuleType

import torch

SCHEMAS = (  # as torchvision registers them in C++: ops/nms.cpp, ops/quantized/cpu/qnms_kernel.cpp
    "nms(Tensor dets, Tensor scores, float iou_threshold) -> Tensor",
    "qnms(Tensor dets, Tensor scores, float iou_threshold) -> Tensor",
)
_declared: list[torch.library.Library] = []  # a Library withdraws its declarations when it is deleted


def load() -> ModuleType:
    """The imported torchvision; raises ImportError, with the remedy, where it cannot be imported."""
    try:
        return importlib.import_module("torchvision")
    except RuntimeError as error:
        if "torchvision::" not in str(error) or "does not exist" not in str(error) or _declared:
            raise ImportError(
                f"torchvision cannot be imported with torch {torch.__version__}: {error}. "
                "Install the releases of both that constraints.txt names."
            ) from error
    _drop_half_imported()
    _declare()
    return importlib.import_module("torchvision")


def _drop_half_imported():
    for name in [name for name in sys.modules if name.partition(".")[0] == "torchvision"]:
        del sys.modules[name]


def _declare():
    library = torch.library.Library("torchvision", "FRAGMENT")
    for schema in SCHEMAS:
        library.define(schema)
    _declared.append(library)


torchvision = load()
