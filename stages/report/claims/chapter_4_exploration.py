"""Claims on several touches: how many it takes, where to touch next, and whether the belief is to be believed."""

from stages.report.intervals import HOLD_OUT, REGION_OUT
from stages.report.results import NotRun
from stages.report.tables._exploration import HEADLINE, at_confidence, curves, fixed_at
from stages.report.verdict import Claim

POINTS, TOUCHES = "points of accuracy", "touches"
SET, METHOD = "six", "thesis_ssim"
PERFECT = 0.99  # what "up to 100 %" of T table 4.6 is taken to mean


def exploration(results, way, split="anywhere", likelihood="imprint", method=METHOD):
    """The rows of one way of exploring the set."""
    where = {"object": SET, "method": method, "split": split, "likelihood": likelihood, "way": way}
    return results.measured("exploration", **where)


def after(touches, likelihood, than):
    """differences(results): accuracy after some touches, in random order, minus `than`, or that after one touch."""

    def differences(results):
        curve = curves(exploration(results, "random", likelihood=likelihood))
        if touches not in curve:
            raise NotRun(f"no accuracy after {touches} touches", "exploration", runnable=False)
        return 100 * (curve[touches] - (curve[1] if than is None else than)).to_numpy()

    return differences


def adaptive_over_fixed(way, likelihood):
    """differences(results): accuracy when touching stops at 95 %, minus a fixed number's at as many touches."""

    def differences(results):
        rows = exploration(results, way, likelihood=likelihood)
        stopped = _stopped(rows)
        return 100 * (stopped["value"].to_numpy() - fixed_at(rows, stopped["touches"]))

    return differences


def touches_saved(way, over, method=METHOD):
    """differences(results): touches to 95 % the way `over` minus those the way `way`."""

    def differences(results):
        taken = [_stopped(exploration(results, one, method=method))["touches"] for one in (over, way)]
        return (taken[0] - taken[1]).dropna().to_numpy()

    return differences


def first_touch(way, over, method=METHOD):
    """differences(results): accuracy of the first touch, `way` minus `over`."""

    def differences(results):
        first = [curves(exploration(results, one, method=method))[1] for one in (way, over)]
        return 100 * (first[0] - first[1]).dropna().to_numpy()

    return differences


def sure_and_right(split):
    """differences(results): how often those are right that stopped at 95 %, minus 95 %."""

    def differences(results):
        rows = exploration(results, "random", split)
        right = at_confidence(rows, HEADLINE, "accuracy_decided")["value"].dropna()
        if right.empty:
            raise NotRun(f"nothing reached a belief of {HEADLINE:.0%}", "exploration", runnable=False)
        return 100 * (right.to_numpy() - HEADLINE)

    return differences


def too_sure(split):
    """differences(results): stated belief minus accuracy of likelihoods multiplied, at the most touches."""

    def differences(results):
        rows = exploration(results, "random", split, "imprint_product")
        last = rows[(rows["stop"] == "fixed") & (rows["level"] == rows.loc[rows["stop"] == "fixed", "level"].max())]
        return 100 * (last["belief"] - last["value"]).to_numpy()

    return differences


def _stopped(rows):
    found = at_confidence(rows, HEADLINE)
    if found.empty:
        raise NotRun(f"{HEADLINE} is not among exploration.confidences", "exploration", runnable=False)
    return found


def claim(key, section, sentence, tested_on, unit, differences, shared=HOLD_OUT):
    """A Claim whose pairs are repeated splits of the same imprints."""
    return Claim(key, section, sentence, tested_on, unit, "repetitions", differences, shared)


WHERE = "{six}, enhanced points, test touches anywhere"
CLAIMS = [
    claim(
        "five_touches_over_one", "ours", "Adding up beliefs over touches is better than one touch.",
        f"{WHERE}, belief by imprints, five touches in random order minus one", POINTS, after(5, "imprint", None),
    ),
    claim(
        "five_touches_perfect", "ours", "Beliefs added up over five touches and their places come up to 99 %.",
        f"{WHERE}, belief by imprints and places, five touches in random order, minus 99 %", POINTS,
        after(5, "imprint_place", PERFECT),
    ),
    claim(
        "five_touches_perfect_by_imprints", "ours",
        "Beliefs added up over five touches come up to 99 % by imprints alone.",
        f"{WHERE}, five touches in random order, minus 99 %", POINTS, after(5, "imprint", PERFECT),
    ),
    claim(
        "adaptive_over_fixed", "ours", "Stopping when sure beats a fixed number of touches.",
        f"{WHERE}, random order, stopping at 95 % minus as many touches for every object", POINTS,
        adaptive_over_fixed("random", "imprint"),
    ),
    claim(
        "adaptive_over_fixed_places", "ours", "Stopping when sure beats a fixed number where places count too.",
        f"{WHERE}, random order, belief by imprints and places, stopping at 95 % minus as many for every object",
        POINTS, adaptive_over_fixed("random", "imprint_place"),
    ),
    claim(
        "gain_over_random", "ours", "Touching where the belief gains most takes fewer touches than a random order.",
        f"{WHERE}, stopping at 95 %, touches saved", TOUCHES, touches_saved("gain", "random"),
    ),
    claim(
        "gain_over_saliency", "ours", "Touching where the belief gains most takes fewer touches than by saliency.",
        f"{WHERE}, stopping at 95 %, touches saved", TOUCHES, touches_saved("gain", "saliency"),
    ),
    claim(
        "saliency_over_random", "ours", "Touching by saliency takes fewer touches than a random order.",
        f"{WHERE}, stopping at 95 %, touches saved", TOUCHES, touches_saved("saliency", "random"),
    ),
    claim(
        "first_touch_by_saliency", "ours", "The most salient place is the best first touch.",
        f"{WHERE}, accuracy of one touch, most salient place minus a random one of them", POINTS,
        first_touch("saliency", "random"),
    ),
    claim(
        "sure_is_right", "ours", "A belief of 95 % is right at least 95 times in 100.",
        f"{WHERE}, random order, those that stopped at 95 %, minus 95 %", POINTS, sure_and_right("anywhere"),
    ),
    claim(
        "product_too_sure", "ours", "Multiplying the likelihoods of touches makes a robot too sure.",
        "{six}, enhanced points, touches of one unseen region, stated belief minus accuracy after the most touches",
        POINTS, too_sure("apart"), REGION_OUT,
    ),
]  # fmt: skip
