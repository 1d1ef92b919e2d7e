"""What people call methods on a command line, and the names that these have here."""

from collections.abc import Sequence

from stages.weights import LearnedWeights

from .methods import MAIN, METHODS, meant, split_runnable

HELP = (
    "glance, our model of human gaze (default); thesis_ssim, the thesis's attention; itti, plain visual attention; "
    "haptic_glance.METHODS has the rest"
)


def check_name(method: str, first: Sequence[str] = (), points_alone: bool = False) -> None:
    """Raises ValueError for a method that does not run on a mesh outside the pipeline's data sets, with one that does.

    first: names that the command adds. points_alone: also methods that place points and have no saliency.
    """
    runs, learned = split_runnable(METHODS, LearnedWeights())
    runs.remove("random")  # which no command needs: touch has --at random
    usable = [*first, *(name for name in runs if points_alone or hasattr(METHODS[name], "saliency"))]
    if method in usable:
        return
    said = method.lower().replace("-", "_").replace(" ", "_")
    near = meant(said, usable)
    reason = f"there is no such method{near}"
    if method in METHODS:
        reason = "its weights are learned in the pipeline" if method in learned else "it has no saliency"
    rest = "" if near and method not in METHODS else f"; choose one of {', '.join([*first, *MAIN])}"
    raise ValueError(f"--method {method}: {reason}{rest}")
