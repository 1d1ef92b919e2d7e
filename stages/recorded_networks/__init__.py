"""Networks for photographs on recorded touches (T5.4)."""

from dataclasses import dataclass

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

    networks: dict[str, list[str]]
    weights: list[str]
    source: str
    size: int
    repetitions: dict[str, int]
    rates: dict[str, list[float]]
    passes: list[str]
    epochs: dict[str, int]
    patience: int
    most_epochs: int
    search_epochs: dict[str, int]
    batch: dict[str, int]
    momentum: float
    steps: int
    copies: int
    device: str
