"""What the tables, figures, chart and claims of the hybrid network read: rows of the stage transfer, data `hybrid`."""

from stages.report.intervals import interval

from ._transfer import shared

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


def rows(results, middle=None, **where):
    """Rows of the hybrid network that shares the layers `middle`, by default the first; NotRun where there is none.

    Networks of another middle have the same names of methods: never read both at once.
    """
    found = results.measured("transfer", data="hybrid", **where)
    return found[found["mode"] == (middle or first_middle(results))]


def first_middle(results):
    """The range of layers that is shared in the network that was repeated."""
    return middles(results)[0]


def middles(results):
    """The ranges of layers that are shared in a network each, the one that was repeated first."""
    every = results.measured("transfer", data="hybrid", metric="accuracy")
    counts = every.groupby("mode", sort=False)["repetition"].nunique()
    return sorted(counts.index, key=lambda middle: -counts[middle])


def mean(values, split, source=None):
    """(mean, low, high) over the repetitions: splits of the same items, or folds of objects left out."""
    middle, low, high = interval(values, shared(split, source))
    return middle, max(low, 0.0), min(high, 1.0)
