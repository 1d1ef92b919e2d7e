"""The detectors of T3.3: fused maps of networks, rival models and controls, and how they are called."""

from typing import NamedTuple

from stages.fixation.tasks import LEVELS, SHAPE_MEASURES
from stages.report.style import label

FUSED, NARROWED = "ewigc", "ewigc_l4"  # T eq. 3.24 and 3.25
MODELS = {FUSED: "EWIGC", NARROWED: "EWIGC_L4"}
TASKS = (*LEVELS, *SHAPE_MEASURES)  # in the order of T figure 3.30
UNTRAINED = "-random"  # ends the name of a network that learned nothing but its heads
NAMES = {"centre_prior": "centre prior", "random": "noise"}  # of the controls
KINDS = {  # words, and colour
    "fused": ("Grad-CAM of a network", "#0072B2"),
    "rival": ("other model", "#767676"),
    "control": ("control", "#D55E00"),
}


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
        task = MODELS.get(self.task, label(self.task))
        own = NAMES.get(self.task, task) if self.method == "control" else task
        return own if self.method in KINDS else f"{task}, {network_text(self.method)}"

    @property
    def tint(self) -> str:
        """The colour of its kind."""
        return KINDS[self.kind][1]


LEE, OURS = Detector("rival", "mesh_saliency"), Detector("rival", "enhanced")
PRIOR, NOISE = Detector("control", "centre_prior"), Detector("control", "random")


def untrained(method: str) -> bool:
    """True for a network with random weights."""
    return method.endswith(UNTRAINED)


def with_random_weights(method: str) -> str:
    """The same network with random weights."""
    return method.rpartition("-")[0] + UNTRAINED


def network_text(method: str) -> str:
    """`VGG16, frozen`: the network of a method and what of it learned."""
    network, _, mode = method.rpartition("-")
    return f"{label(network)}, {'random weights' if mode == 'random' else label(mode)}"
