"""T figure 5.6: what the hybrid network takes for what, by sight and by touch."""

from stages.report.confusion import draw_matrices
from stages.report.items import Figure
from stages.report.results import Results

from .section_5_5 import ITEMS, MIDDLE, SENSES


def build(results: Results) -> Figure:
    """Confusion matrices, senses in columns and splits in rows."""
    frame = results.measured("transfer", method="hybrid", metric="confusion", mode=MIDDLE)
    splits = {(split,): words for split, words in ITEMS.items() if split in set(frame["split"])}
    senses = {sense: f"by {word}" for sense, word in SENSES.items()}
    figure, words = draw_matrices(frame, splits, senses, ["split"], "sense")
    return Figure(figure, words | {"splits": ", ".join(splits.values())})
