"""Networks for photographs on recorded touches (T5.4)."""

from dataclasses import dataclass

COLUMNS = {
    "data": "what is recognised: a name of stages.recorded_networks.data.SOURCES",
    "weights": "what the network starts from: imagenet; random: its normalisation has the images' statistics; "
    "random_initial: those it begins with",
    "pretrained": "which of ImageNet's weights there are: complete, convolutions, converted or none",
    "mode": "frozen (the new head alone learns) or finetuned (all layers learn)",
    "size": "pixels a side that the network sees",
    "repetition": "number of the split",
    "passes": "printed: as many as `epochs` and `steps` say; converged: until nothing improves on validation touches",
}


@dataclass
class Params:
    """Section `recorded_networks` of params.yaml. Those with braces: {mode: value}, the modes frozen and finetuned."""

    networks: dict[str, list[str]]  # {network: its modes}
    weights: list[str]  # what each starts from: imagenet, or as controls random (statistics of images), random_initial
    source: str  # ImageNet's weights: package, download or auto, as in transfer
    size: int  # pixels a side of the images, frozen and fine-tuned alike
    repetitions: dict[str, int]  # {mode: splits, each with a draw of random weights}
    rates: dict[str, list[float]]  # {mode: learning rates tried}
    passes: list[str]  # printed: `epochs` over all training touches; converged: until nothing improves
    epochs: dict[str, int]  # {mode: passes of the final training as printed}
    patience: int  # converged: passes without a better validation accuracy after which a training ends
    most_epochs: int  # converged: passes at most
    search_epochs: dict[str, int]  # {mode: passes of each tried rate}
    batch: dict[str, int]  # {mode: images a step}
    momentum: float  # of the stochastic gradient descent (T5.3)
    steps: int  # of fine-tuning as printed at most, in whole passes
    copies: int  # augmented copies of each image whose frozen features are cached
    device: str  # where networks are trained: auto, cpu or cuda; cuda: with parallel=sequential
