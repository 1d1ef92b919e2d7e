"""What the tables, figures, chart and claims of the hybrid network read: rows of the stage transfer, data `hybrid`."""

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


MIDDLE = "18:139"  # the layers that the thesis's network shares


def rows(results, middle=MIDDLE, dataset=None, **where):
    """Rows of the hybrid network that shares the layers `middle`; NotRun where there is none.

    Networks of another middle have the same names of methods: never read both at once.
    """
    return results.measured("transfer", dataset, data="hybrid", mode=middle, **where)


def middles(results, dataset=None):
    """The ranges of layers that are shared in a network each, the one that was repeated first."""
    every = results.measured("transfer", dataset, data="hybrid", metric="accuracy")
    counts = every.groupby("mode", sort=False)["repetition"].nunique()
    return sorted(counts.index, key=lambda middle: -counts[middle])
