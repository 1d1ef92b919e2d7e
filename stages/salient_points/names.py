"""What people call methods on a command line, and the names that these have here."""

from collections.abc import Sequence
from difflib import get_close_matches

from stages.weights import LearnedWeights

from .methods import METHODS, split_runnable

HELP = (
    "glance, our model of human gaze (default); enhanced, our earlier one, from rendered views; thesis_ssim, the "
    "thesis's enhanced attention; itti, plain visual attention; any other name lists the rest"
)
MEANT = {  # in other words, and in the thesis's
    "ours": "glance", "gaze": "glance", "default": "glance", "any_pose": "glance_any_pose",
    "thesis": "thesis_ssim", "enhanced_attention": "thesis_ssim", "enhanced_visual_attention": "thesis_ssim",
    "ssim": "thesis_ssim", "ed": "thesis_ed", "visual_attention": "itti", "attention": "itti", "classical": "itti",
    "lee": "mesh_saliency", "fixations": "enhanced", "fixation": "enhanced", "hks": "heat_kernel",
}  # fmt: skip


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
    reason = f"there is no such method{meant(said, usable)}"
    if method in METHODS:
        reason = "its weights are learned in the pipeline" if method in learned else "it has no saliency"
    raise ValueError(f"--method {method}: {reason}; choose one of {', '.join(usable)}")


def meant(said: str, usable: Sequence[str]) -> str:
    """ " (did you mean NAME?)" for a name in other words or mistyped; else empty."""
    lower = {name.lower(): name for name in usable}
    close = get_close_matches(said, [*MEANT, *lower], 1)
    found = MEANT.get(close[0], lower.get(close[0])) if close else None
    return f" (did you mean {found}?)" if found in usable else ""
