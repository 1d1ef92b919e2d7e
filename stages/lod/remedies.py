"""What to say, and what would help, where a face count is too low for what must survive."""

from argparse import Namespace

from .feasibility import InfeasibleTarget, smallest_feasible
from .task import SimplificationTask
from .topology import topology


def infeasible(task: SimplificationTask, error: InfeasibleTarget, chosen: Namespace) -> str:
    """The message for a target that is too low: the reason, and what is feasible."""
    frozen = [f"{number(error.frozen, 'face')} around {number(len(task.points), 'point')}"] if error.frozen else []
    if len(task.boundary) and not task.free_borders:
        frozen.append(f"{number(len(task.boundary), 'boundary edge')}")
    reason = f", since {' and '.join(frozen)} are frozen" if frozen else ""
    ways = remedies(task, error, chosen) or ["the mesh cannot be simplified further"]
    return f"{number(error.faces, 'face')} are infeasible{reason}: {', or '.join(ways)}"


def remedies(task: SimplificationTask, error: InfeasibleTarget, chosen: Namespace) -> list[str]:
    """What would help; empty where nothing would."""
    total = len(task.mesh.faces)
    if smallest_feasible(task.mesh) >= total:  # not even with nothing frozen
        several = len(task.boundary) and topology(task.mesh.faces).components > 1
        return ["join its connected components first"] if several else []
    ways = [f"ask for --faces {error.smallest} or more"] if error.smallest < total else []
    if len(task.boundary) and not task.free_borders and not chosen.attributes and task.backend != "pymeshlab":
        ways += ["let the boundary be simplified with --free-borders"]
    if error.frozen and len(task.points) > 1:
        ways += ["--keep fewer points"]
    if error.frozen and chosen.neighbourhood == "fixed" and task.rings.any():
        ways += ["take fewer --rings"]
    if error.frozen:
        ways += [*(() if task.shrink else ("let them --shrink",)), "leave --neighbourhood out"]
    return ways


def number(count: int, noun: str) -> str:
    """`1 face`, `1,280 faces`."""
    return f"{count:,} {noun}{'' if count == 1 else 's'}"
