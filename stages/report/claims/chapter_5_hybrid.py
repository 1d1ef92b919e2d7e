"""Claims of T5.5 and 5.6: one network for sight and touch, and what two senses are worth together."""

from stages.report.intervals import HOLD_OUT
from stages.report.results import NotRun
from stages.report.tables._hybrid import WHOLE, rows
from stages.report.verdict import Claim

POINTS = "points of accuracy"


def accuracies(results, method, sense, split="random", **where):
    """Series of accuracies in per cent, a repetition. where: perturbation and severity of the damage."""
    found = rows(results, metric="accuracy", method=method, split=split, sense=sense)
    if "perturbation" not in where:
        found = found[found["perturbation"].isna()]
    for column, wanted in where.items():
        found = found[found[column] == wanted]
    if found.empty:
        raise NotRun(f"{method} was not asked by {sense}", "transfer", runnable=False)
    return 100 * found.groupby("repetition")["value"].mean()


def both_over(method, other, **where):
    """differences(results): accuracy with both senses, one way of joining them minus another."""
    where = {"perturbation": WHOLE} | where

    def differences(results):
        first, second = (accuracies(results, name, "both", **where) for name in (method, other))
        return (first - second).dropna().to_numpy()

    return differences


def over_touch(results):
    """Accuracy by sight minus by touch, the separate networks."""
    return (accuracies(results, "vision", "vision") - accuracies(results, "touch", "touch")).dropna().to_numpy()


def harshest(results, perturbation):
    """The harshest severity of a damage."""
    return rows(results, perturbation=perturbation)["severity"].max()


def trusts(method, other, perturbation):
    """differences(results): as both_over, one sense damaged as harshly as it was measured."""

    def differences(results):
        where = {"perturbation": perturbation, "severity": harshest(results, perturbation)}
        return both_over(method, other, **where)(results)

    return differences


def claim(key, section, sentence, tested_on, differences):
    return Claim(key, section, sentence, tested_on, POINTS, "repetitions", differences, HOLD_OUT)


CLAIMS = [
    claim("sight_over_touch", "T5.5", "The hybrid network recognises better by sight than by touch.",
          "items at random, sight minus touch", over_touch),
    claim("both_over_better", "ours", "Both senses together recognise more than the better one alone.",
          "both heads by certainty minus the better sense", both_over("fusion_entropy", "better_sense")),
    claim("apart_over_sum", "ours", "Fed both senses, two answers joined beat the summed streams of the thesis.",
          "both heads by certainty minus the streams summed", both_over("fusion_entropy", "sum_mean")),
    claim("touch_in_the_dark", "T5.5", "Where sight fails, touch helps.",
          "hardly any light: both heads by certainty minus sight alone",
          trusts("fusion_entropy", "vision", "picture_darkness")),
    claim("harmless_in_the_dark", "ours", "Where sight fails, having it does no harm to touch.",
          "hardly any light: both heads by certainty minus touch alone",
          trusts("fusion_entropy", "touch", "picture_darkness")),
    claim("temperatures_help", "ours", "In the dark temperatures tell better who is to be trusted.",
          "hardly any light: by certainty, with temperatures minus without",
          trusts("fusion_entropy", "fusion_entropy_raw", "picture_darkness")),
]  # fmt: skip
