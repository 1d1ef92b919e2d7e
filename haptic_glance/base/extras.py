"""Packages that a core install leaves out, and the extra that brings each."""

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

MODULES = {
    "pictures": ("cv2", "matplotlib"),
    "pipeline": (
        "cloudpickle", "diskcache", "dvc", "filelock", "hydra", "joblib", "laspy", "omegaconf", "pandas",
        "point_cloud_utils", "pymeshlab", "pypcd4", "pywt", "robust_laplacian", "rtree", "skimage",
        "sklearn", "threadpoolctl", "tqdm", "yaml",
    ),
    "deep": ("kornia", "onnx", "onnxruntime", "onnxscript", "torch", "torchvision"),
    "cluster": ("dask", "distributed"),
    "studio": ("viser",),
    "front": ("optuna",),
    "agents": ("gymnasium",),
    "robots": ("collada",),
}  # fmt: skip
EXTRAS = {module: extra for extra, modules in MODULES.items() for module in modules}


class MissingExtra(ModuleNotFoundError):
    """A package that one of our extras brings is not installed; the message is one line and names the extra."""


@contextmanager
def about(name: object, kind: type[ValueError] = ValueError) -> Iterator[None]:
    """Puts a name before the reason of a MissingExtra, or of an error of a kind, for example that of the file read."""
    try:
        yield
    except (kind, MissingExtra) as error:
        raised = MissingExtra if isinstance(error, MissingExtra) else kind
        raise raised(f"{name}: {error}").with_traceback(error.__traceback__) from None


@contextmanager
def from_extra(need: str = "") -> Iterator[None]:
    """Around the import of what a core install leaves out: raises MissingExtra where it is not installed.

    need: why the package is needed, to go before "is not installed".
    """
    try:
        yield
    except ModuleNotFoundError as error:
        module = (error.name or "").partition(".")[0]
        if isinstance(error, MissingExtra) or module not in EXTRAS:  # the inner one says why it is needed
            raise
        pyproject = Path(__file__).parents[2] / "pyproject.toml"  # beside the stages in a clone alone
        remedy = f"pip install '{'.' if pyproject.is_file() else 'haptic-glance'}[{EXTRAS[module]}]'"
        raise MissingExtra(f"{need or f'{module} '}is not installed: {remedy}", name=error.name) from None
