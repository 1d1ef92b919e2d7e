"""The settings of the recorded_networks stage, and what its rows hold."""

from dataclasses import dataclass

COLUMNS = {
    "data": "what is recognised: a name of stages.recorded_networks.sources.SOURCES",
    "weights": "what the network starts from: imagenet or random",
    "pretrained": "which of ImageNet's weights there are: complete, convolutions, converted or none",
    "mode": "frozen (the new head alone learns) or finetuned (all layers learn)",
    "size": "pixels a side that the network sees",
    "repetition": "number of the split",
}


@dataclass
class Params:
    """Section `recorded_networks` of params.yaml. Those with braces: {mode: value}, the modes frozen and finetuned."""

    networks: dict[str, list[str]]  # {network: its modes}
    weights: list[str]  # what each starts from: imagenet, random
    source: str  # ImageNet's weights: package, download or auto, as in transfer
    size: int  # pixels a side of the images, frozen and fine-tuned alike
    repetitions: dict[str, int]  # {mode: splits, each with a draw of random weights}
    rates: dict[str, list[float]]  # {mode: learning rates tried}
    epochs: dict[str, int]  # {mode: passes of the final training}
    search_epochs: dict[str, int]  # {mode: passes of each tried rate}
    batch: dict[str, int]  # {mode: images a step}
    momentum: float  # of the stochastic gradient descent (T5.3)
    steps: int  # of fine-tuning at most, in whole passes
    copies: int  # augmented copies of each image whose frozen features are cached
    device: str  # where networks are trained: auto, cpu or cuda; cuda: with parallel=sequential
