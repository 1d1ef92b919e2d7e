"""One style for all pictures: white page, quiet axes, colours that the colour-blind can tell apart."""

import io
from collections.abc import Sequence
from itertools import cycle
from pathlib import Path
from typing import Any

import matplotlib
from PIL import Image

from haptic_glance.base.files import whole_file

matplotlib.use("Agg")  # no screen where pipelines run
import matplotlib.pyplot as plt  # noqa: E402
from matplotlib.axis import Axis  # noqa: E402
from matplotlib.figure import Figure  # noqa: E402
from matplotlib.ticker import LogLocator, NullFormatter  # noqa: E402

MAP = "viridis"  # for saliency: even in lightness, safe for the colour-blind
INK, GREY, PALE = "#222222", "#767676", "#d9d9d9"
# Okabe and Ito 2008: eight colours that stay apart under the common colour deficiencies.
CYCLE = ["#0072B2", "#D55E00", "#009E73", "#CC79A7", "#E69F00", "#56B4E9", "#7A6A00", "#000000"]
LABELS = {
    "random": "blind touch",
    "itti": "Itti's attention",
    "VisAttAll": "thesis, equal weights",
    "equal": "thesis, nine equal weights",
    "thesis_ssim": "thesis, SSIM",
    "thesis_ed": "thesis, ED",
    "glance_any_pose": "glance, any pose",
    "glance_deep": "glance, deep",
    "human": "the truth itself",
    "guided_ssim": "guided by SSIM",
    "guided_ed": "guided by ED",
    "guided_ssim_object": "guided by SSIM on the object",
    "svm_nearest": "thesis, SVM of the nearest object",
    "svm_object": "thesis, SVM of the object",
    "svm_viewpoint": "thesis, SVM of each view",
    "leifman": "regions of interest",
    "song": "spectral saliency",
    "tasse": "cluster-based saliency",
    "sift": "3D-SIFT",
    "harris": "3D-Harris",
    "corners": "scale-dependent corners",
    "farthest": "farthest points",
    "touch": "places to touch",
    "centre_distance": "distance from the centre",
    "spectral_residual": "spectral residual (OpenCV)",
    "fine_grained": "fine-grained (OpenCV)",
    "qem": "plain QEM",
    "qslim": "QSlim",
    "knn": "kNN",
    "svm": "SVM",
    "naive_bayes": "naive Bayes",
    "mean_without_svm": "mean without the SVM",
    "discriminant": "linear discriminant",
    "linear_svm": "linear SVM",
    "heat_kernel": "heat kernel signature",
    "hks": "heat kernel signature",
    "dkl": "DKL",
    "alexnet": "AlexNet",
    "googlenet": "GoogLeNet",
    "vgg16": "VGG16",
    "resnet50": "ResNet50",
    "resnet101": "ResNet101",
    "mobilenet_v2": "MobileNetV2",
    "efficientnet_lite0": "EfficientNet-Lite0",
    "finetuned": "fine-tuned",
    "last_block": "last block fine-tuned",
    "fast": "fast (ours)",
    "fast_simplification": "fast-simplification",
    "meshoptimizer_native": "meshoptimizer 0.2.30a0",
    "vtk": "VTK",
}
WAYS = ("adaptive", "area", "soft")  # of keeping a neighbourhood; behind a method's name
METHOD_COLOURS = {"random": "#E69F00", "itti": "#56B4E9", "thesis_ssim": "#009E73", "glance": "#0072B2", "qem": GREY}
MARKERS = "osD^vPX*"
PALETTE = 160  # colours of a picture: a fourth of the bytes, and the shading of meshes still looks smooth
SETTLED = 1_000  # pixels that still change their colour: to go on until all stay takes five times as long
SETTINGS: dict[Any, Any] = {
    "figure.facecolor": "white",
    "savefig.facecolor": "white",
    "font.family": "DejaVu Sans",  # comes with matplotlib: the same letters on every machine
    "font.size": 10,
    "axes.titlesize": 11,
    "axes.titleweight": "bold",
    "axes.titlelocation": "left",
    "axes.edgecolor": GREY,
    "axes.labelcolor": INK,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.axisbelow": True,
    "grid.color": "#ececec",
    "xtick.color": INK,
    "ytick.color": INK,
    "legend.frameon": False,
    "image.interpolation": "antialiased",
}


def label(name: object) -> str:
    """A method's name in words, with its way of keeping neighbourhoods where there is one, but without `_seen`."""
    text = str(name)
    base, _, way = text.rpartition("-")
    said = LABELS.get(text) or LABELS.get(text.removesuffix("_seen")) or text.replace("_", " ")
    return f"{label(base)}, {way}" if way in WAYS else said


def start(weights: str) -> str:
    """What a network starts from, in words."""
    own = {"imagenet": "ImageNet", "random_initial": "random weights, initial statistics"}
    return own.get(weights) or f"{weights} weights"


def colours(names: Sequence[str]) -> dict[str, str]:
    """dict name -> colour: fixed for the known methods, the cycle for others."""
    known = {name: METHOD_COLOURS[name] for name in names if name in METHOD_COLOURS}
    free = cycle(colour for colour in CYCLE if colour not in known.values())
    return {name: known.get(name) or next(free) for name in names}


def plain_logarithm(axis: Axis, subs: Sequence[float] = (1.0, 2.0, 5.0)) -> None:
    """Numbers without powers at these multiples of a logarithmic axis's decades."""
    axis.set_major_locator(LogLocator(subs=subs))
    axis.set_major_formatter(lambda value, _: f"{value:g}")
    axis.set_minor_formatter(NullFormatter())


def save(figure: Figure, path: Path, dpi: int = 130) -> Path:
    """Writes a PNG of PALETTE colours without dates or versions, so that equal runs give equal bytes; the path."""
    drawn = io.BytesIO()
    figure.savefig(drawn, dpi=dpi, bbox_inches="tight", pad_inches=0.12, metadata={"Software": None})
    plt.close(figure)
    with Image.open(drawn) as image:
        few = image.convert("RGB").quantize(PALETTE, Image.Quantize.MEDIANCUT, SETTLED, dither=Image.Dither.NONE)
    with whole_file(path) as part:
        few.save(part, "PNG", optimize=True)
    return path
