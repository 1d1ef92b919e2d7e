"""What the tables, figures, chart and claims of the hybrid network read: rows of the stage transfer, data `hybrid`."""

from stages.report.intervals import HOLD_OUT, interval

from ._transfer import FOLD_OUT

SENSES = {"vision": "sight", "touch": "touch"}
BOTH = {
    "better_sense": "the better sense alone",
    "vision": "sight alone",
    "touch": "touch alone",
    "sum_mean": "the streams summed, both heads",
    "sum_vision": "the streams summed, sight's head",
    "sum_touch": "the streams summed, touch's head",
    "fusion_mean": "both heads, mean",
    "fusion_product": "both heads, product",
    "fusion_entropy": "both heads, by certainty",
    "fusion_entropy_raw": "both heads, by certainty, no temperatures",
    "fusion_surest": "the surer head",
}
WHOLE = "none"  # the perturbation of senses that are as they should be


def rows(results, **where):
    """Rows of the hybrid network's first middle in this run; NotRun where there is none."""
    found = results.measured("transfer", data="hybrid", **where)
    return found[found["mode"] == first_middle(results)]


def first_middle(results):
    """The range of layers that is shared in the network that was repeated."""
    every = results.measured("transfer", data="hybrid", metric="accuracy")
    return every.groupby("mode", sort=False)["repetition"].nunique().idxmax()


def mean(values, split, top=1.0):
    """(mean, low, high) over the repetitions: splits of the same items, or folds of objects left out."""
    middle, low, high = interval(values, HOLD_OUT if split == "random" else FOLD_OUT)
    return middle, max(low, 0.0), min(high, top)
