"""Claims of T5.5 and 5.6: one network for sight and touch, and what two senses are worth together."""

from functools import partial

from stages.report.results import NotRun
from stages.report.tables._hybrid import SENSES, WHOLE, rows
from stages.report.tables.section_5_5 import POINT

from .chapter_5 import both, on_their_classes


def accuracies(results, method, sense, split, **where):
    """Series of accuracies in per cent, a repetition. where: perturbation and severity of the damage."""
    found = rows(results, metric="accuracy", method=method, split=split, sense=sense)
    if "perturbation" not in where:
        found = found[found["perturbation"].isna()]
    for column, wanted in where.items():
        found = found[found[column] == wanted]
    if found.empty:
        raise NotRun(f"{method} was not asked by {sense}", "transfer", runnable=False)
    return 100 * found.groupby("repetition")["value"].mean()


def both_over(method, other, split, **where):
    """differences(results): accuracy with both senses, one way of joining them minus another."""
    where = {"perturbation": WHOLE} | where

    def differences(results):
        first, second = (accuracies(results, name, "both", split, **where) for name in (method, other))
        return (first - second).dropna().to_numpy()

    return differences


def over_touch(split):
    """differences(results): accuracy by sight minus by touch, the separate networks."""

    def differences(results):
        sight, touch = (accuracies(results, sense, sense, split) for sense in SENSES)
        return (sight - touch).dropna().to_numpy()

    return differences


def within_a_point(method, sense, split):
    """differences(results): accuracy of a kind of hybrid minus that of the sense's own network, and POINT.

    Not of the hybrid of 32 bits: its answers are those of the two networks, so that no difference has a spread to
    judge; section_5_5 tells that of each network made.
    """

    def differences(results):
        gap = accuracies(results, method, sense, split) - accuracies(results, sense, sense, split)
        return gap.dropna().to_numpy() + POINT

    return differences


def harshest(results, perturbation):
    """The harshest severity of a damage."""
    return rows(results, perturbation=perturbation)["severity"].max()


def trusts(method, other, perturbation, split):
    """differences(results): as both_over, one sense damaged as harshly as it was measured."""

    def differences(results):
        where = {"perturbation": perturbation, "severity": harshest(results, perturbation)}
        return both_over(method, other, split, **where)(results)

    return differences


def told(key, section, sentence, tested_on, differences):
    """The claim of both splits. differences: split -> differences(results)."""
    return both(key, section, sentence, tested_on, differences, items="items", felt="met")


THESIS = [
    *told("sight_over_touch", "T5.5", "The hybrid network recognises better by sight than by touch.",
          "hybrid network, sight minus touch", over_touch),
    *told("touch_in_the_dark", "T5.5", "Where sight fails, touch helps.",
          "hardly any light: both heads by certainty minus sight alone",
          partial(trusts, "fusion_entropy", "vision", "picture_darkness")),
]  # fmt: skip
CLAIMS = [
    *THESIS,
    *(
        claim
        for sense, word in SENSES.items()
        for claim in told(
            f"eight_bits_{word}", "ours",
            f"With weights of 8 bits the hybrid recognises as well by {word} as one network.",
            f"hybrid of 8 bits minus the network for {word}, plus the one point that may be lost",
            partial(within_a_point, "hybrid_int8", sense),
        )
    ),
    *told("both_over_better", "ours", "Both senses together recognise more than the better one alone.",
          "both heads by certainty minus the better sense", partial(both_over, "fusion_entropy", "better_sense")),
    *told("apart_over_sum", "ours", "Fed both senses, two answers joined beat the summed streams of the thesis.",
          "both heads by certainty minus the streams summed", partial(both_over, "fusion_entropy", "sum_mean")),
    *told("harmless_in_the_dark", "ours", "Where sight fails, having it does no harm to touch.",
          "hardly any light: both heads by certainty minus touch alone",
          partial(trusts, "fusion_entropy", "touch", "picture_darkness")),
    *told("temperatures_help", "ours", "In the dark temperatures tell better who is to be trusted.",
          "hardly any light: by certainty, with temperatures minus without",
          partial(trusts, "fusion_entropy", "fusion_entropy_raw", "picture_darkness")),
    *on_their_classes(THESIS),
]  # fmt: skip
