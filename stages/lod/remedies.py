"""What to say, and what would help, where a face count is too low for what must survive."""

from .feasibility import InfeasibleTarget, smallest_feasible
from .task import SimplificationTask
from .topology import topology
from .variant import SOFT


def infeasible(task: SimplificationTask, error: InfeasibleTarget, neighbourhood: str = SOFT) -> str:
    """The message for a target that is too low: the reason, and what is feasible; neighbourhood: as --neighbourhood."""
    frozen = [f"{number(error.frozen, 'face')} around {number(len(task.points), 'point')}"] if error.frozen else []
    if len(task.boundary) and not task.free_borders:
        frozen.append(f"{number(len(task.boundary), 'boundary edge')}")
    reason = f", since {' and '.join(frozen)} are frozen" if frozen else ""
    ways = remedies(task, error, neighbourhood) or ["the mesh cannot be simplified further"]
    return f"{number(error.faces, 'face')} are infeasible{reason}: {', or '.join(ways)}"


def remedies(task: SimplificationTask, error: InfeasibleTarget, neighbourhood: str) -> list[str]:
    """What would help; empty where nothing would."""
    total = len(task.mesh.faces)
    possible = smallest_feasible(task.mesh, free_borders=task.free_borders) < total  # with nothing frozen
    may_free = len(task.boundary) and not task.free_borders and not task.attributes and task.backend != "pymeshlab"
    ways = [f"ask for {number(error.smallest, 'face')} or more"] if error.smallest < total else []
    if may_free and (possible or smallest_feasible(task.mesh, free_borders=True) < total):
        ways += ["let the boundary be simplified with --free-borders"]
    if error.frozen and possible:
        ways += _thaw(task, neighbourhood)
    return ways + ([] if possible else _mend(task.mesh))


def _thaw(task, neighbourhood):
    ways = ["--keep fewer points"] if len(task.points) > 1 else []
    if neighbourhood == "fixed" and task.rings.any():
        ways += ["take fewer --rings"]
    return [*ways, *(() if task.shrink else ("let them --shrink",)), "leave --neighbourhood out"]


def _mend(mesh):
    found = topology(mesh.faces)
    holes = found.boundary_loops - (found.components - found.closed_components)  # one loop of each may be its outline
    ways = [f"close its {number(holes, 'hole')} first"] if holes > 0 else []
    return [*ways, *(["join its connected components first"] if found.components > 1 and found.boundary_edges else [])]


def number(count: int, noun: str) -> str:
    """`1 face`, `1,280 faces`."""
    return f"{count:,} {noun}{'' if count == 1 else 's'}"
