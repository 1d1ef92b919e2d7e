"""Where a function asks for a mesh, a path, arrays or an object of trimesh do as well."""

from collections.abc import Callable
from functools import wraps
from typing import Any, Concatenate, ParamSpec, TypeVar

from stages.kit import Mesh
from stages.meshes.load import MeshLike, as_mesh

Own = TypeVar("Own")  # what the function takes by itself: a Mesh, or also a Surface of one
Others = ParamSpec("Others")
Result = TypeVar("Result")


def takes_any_mesh(
    function: Callable[Concatenate[Own, Others], Result],
) -> Callable[Concatenate[Own | MeshLike, Others], Result]:
    """The function, its first argument `mesh` converted by `as_mesh`, unless it is a Surface or so, made of a Mesh."""

    @wraps(function)
    def work(mesh: Any, *args: Others.args, **kwargs: Others.kwargs) -> Result:
        prepared: Any = mesh if isinstance(getattr(mesh, "mesh", None), Mesh) else as_mesh(mesh)
        return function(prepared, *args, **kwargs)

    return work
