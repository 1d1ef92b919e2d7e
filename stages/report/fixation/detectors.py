"""The detectors of T3.3: fused maps of networks, rival models and controls, and how they are called."""

from typing import NamedTuple

from stages.fixation.tasks import LEVELS, SHAPE_MEASURES
from stages.report.style import CYCLE, GREY, label

FUSED, NARROWED = "ewigc", "ewigc_l4"  # T eq. 3.24 and 3.25
NAMES = {FUSED: "EWIGC", NARROWED: "EWIGC_L4", "random": "noise"}
TASKS = (*LEVELS, *SHAPE_MEASURES)  # in the order of T figure 3.30
# Words, and colour.
KINDS = {"fused": ("Grad-CAM of a network", CYCLE[0]), "rival": ("other model", GREY), "control": ("control", CYCLE[1])}


class Detector(NamedTuple):
    """A column of a frame of scores."""

    method: str  # "rival", "control", or a network with what of it learned
    task: str  # or model

    @property
    def kind(self) -> str:
        """A key of KINDS."""
        return self.method if self.method in KINDS else "control" if untrained(self.method) else "fused"

    @property
    def text(self) -> str:
        """As a person says it."""
        name = task_text(self.task)
        return name if self.method in KINDS else f"{name}, {network_text(self.method)}"


LEE, OURS = Detector("rival", "mesh_saliency"), Detector("rival", "glance")
RIVALS = {"Leifman's regions of interest": "leifman", "Song's spectral saliency": "song", "Tasse's clusters": "tasse"}
PRIOR, NOISE = Detector("control", "centre_prior"), Detector("control", "random")


def untrained(method: str) -> bool:
    """True for a network that learned nothing but its heads."""
    return method.endswith("-random")


def with_random_weights(method: str) -> str:
    """The same network with random weights."""
    return f"{method.rpartition('-')[0]}-random"


def network_text(method: str) -> str:
    """`VGG16, frozen`: the network of a method and what of it learned."""
    network, _, mode = method.rpartition("-")
    return f"{label(network)}, {'random weights' if mode == 'random' else label(mode)}"


def task_text(task: str) -> str:
    """A task or model as a person says it."""
    return NAMES.get(task, label(task))
