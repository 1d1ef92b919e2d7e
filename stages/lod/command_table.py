"""The table that the command prints."""

from collections.abc import Sequence

from stages.kit import Mesh

from .error_table import NAMES, format_table
from .task import SimplificationTask


def summary(
    task: SimplificationTask, heads: Sequence[str], meshes: Sequence[Mesh], rival: Mesh | None, errors: Sequence[dict]
) -> str:
    """The table that the command prints: the mesh, the meshes under their heads, and plain QEM where there is one."""
    shown = [*meshes, *([] if rival is None else [rival])]
    rest = [None] * (len(shown) - len(meshes))
    rows: list[tuple] = [("faces", len(task.mesh.faces), *(len(mesh.faces) for mesh in shown))]
    if len(task.points):
        rows += [("points kept", len(task.points), *(int(task.points_kept(mesh).sum()) for mesh in meshes), *rest)]
    if len(task.border) and not task.free_borders:
        rows += [("border edges kept", len(task.border), *(task.border_edges_kept(mesh) for mesh in meshes), *rest)]
    if len(task.points) or len(task.border):
        rows += [("fewest faces that keep them", None, *([task.smallest_with_borders] * len(meshes)), *rest)]
    rows += [(NAMES[name], None, *(each[name] for each in errors)) for name in NAMES if name in errors[0]]
    return format_table(["before", *heads, *["plain QEM"] * len(rest)], rows)
