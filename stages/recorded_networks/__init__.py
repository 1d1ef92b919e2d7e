"""Networks for photographs on recorded touches (T5.4)."""

from dataclasses import dataclass

from stages.engine.settings import setting

COLUMNS = {
    "data": "what is recognised: a name of stages.recorded_networks.data.SOURCES",
    "weights": "what the network starts from: imagenet; random: its normalisation has the statistics of the "
    "images that train; random_initial: those it begins with",
    "pretrained": "which of ImageNet's weights there are: complete, convolutions, converted or none",
    "mode": "frozen (the new head alone learns) or finetuned (all layers learn)",
    "size": "pixels a side that the network sees",
    "repetition": "number of the split",
    "passes": "printed: as many as `epochs` and `steps` say; converged: until nothing improves on validation touches",
}


@dataclass
class Params:
    """Section `recorded_networks` of params.yaml. Those with braces: {mode: value}, the modes frozen and finetuned."""

    networks: dict[str, list[str]] = setting(
        {
            "mobilenet_v2": ["frozen", "finetuned"],
            "alexnet": ["frozen"],
            "efficientnet_lite0": ["frozen"],
            "resnet50": ["frozen"],
            "vgg16": ["frozen"],
        },
        "network: its modes; from quick to slow",
    )
    weights: list[str] = setting(
        ["imagenet", "random"],
        "what each starts from: imagenet, or as controls random (statistics of the images that train) and "
        "random_initial (its own statistics)",
    )
    source: str = setting(
        "package",
        "ImageNet's weights: package (by hash), download (torchvision's own) or auto (a package where there is one)",
    )
    size: int = setting(
        96,
        "pixels a side, frozen and fine-tuned alike; the thesis's 224 takes six times as long",
        least=1,
    )
    repetitions: dict[str, int] = setting(
        {"frozen": 5, "finetuned": 5},
        "{mode: splits, each with a draw of random weights}",
        least=1,
    )
    rates: dict[str, list[float]] = setting(
        {"frozen": [0.001, 0.003, 0.01, 0.03], "finetuned": [0.0003, 0.001, 0.003]},
        "learning rates tried",
        above=0,
    )
    passes: list[str] = setting(
        ["printed"],
        "printed: `epochs` passes; converged: until nothing improves on validation touches",
    )
    epochs: dict[str, int] = setting(
        {"frozen": 20, "finetuned": 10},
        "passes; the thesis has 20 of both for VT-60 (T table 5.1), else 10 of both",
        least=1,
    )
    patience: int = setting(20, "converged: passes without a better validation accuracy after which a training ends")
    most_epochs: int = setting(150, "converged: passes at most")
    search_epochs: dict[str, int] = setting({"frozen": 8, "finetuned": 3}, "passes of each tried rate", least=1)
    batch: dict[str, int] = setting(
        {"frozen": 32, "finetuned": 16},
        "images a step; 16 in the thesis; 32 halve the time of training a head alone",
        least=1,
    )
    momentum: float = setting(0.9, "of the stochastic gradient descent (T5.3)", least=0, most=1)
    steps: int = setting(
        600,
        "maximum steps of fine-tuning, in whole passes: ten of 825 pressure images, two of the 4,373 grasps",
        least=1,
    )
    copies: int = setting(2, "augmented copies of each image whose frozen features are cached", least=1)
    device: str = setting(
        "auto",
        "auto (a CUDA card where there is one), cpu, cuda; with a card choose parallel=sequential",
    )
