"""Statistics: intervals, pooled differences of several data sets, breaking points, and random splits of items.

A breaking point is the severity of a disturbance at which half of a score's lead is lost. Pooling is by random effects.
"""

from collections.abc import Callable, Mapping, Sequence
from functools import lru_cache
from typing import Any, NamedTuple

import numpy as np
import scipy
from numpy.typing import ArrayLike

from .rows import by_unit

Statistic = Callable[..., np.floating | np.ndarray]

RESAMPLES = 2000  # the interval's own error is then below a tenth of its width
SMALLEST = 1e-3  # p-value
ROUNDED = 1e-3  # of the largest value: differences of measurements with six digits are no more equal than this


def interval(
    values: ArrayLike, shared: float = 0.0, seed: int = 0, statistic: Statistic = np.mean
) -> tuple[float, float, float]:
    """(mean, low, high): bootstrap percentile interval of the values (k,), NaN left out, widened twice about the mean.

    A Series whose index has a level `item` counts by unit (stages.engine.rows): copies of a shape are one. First it is
    widened by t(n - 1) / z * sqrt(n / (n - 1)), since the percentile interval (Efron and Tibshirani, An Introduction to
    the Bootstrap, 1993, chapter 13) is too narrow for few values (Hesterberg, What teachers should know about the
    bootstrap, The American Statistician 2015, section 3.3). Then by sqrt(1 + n * shared) where the values are repeated
    splits of the same data: without it an interval shrinks to nothing by splitting more often (Nadeau and Bengio,
    Inference for the generalization error, 2003). shared: test over training share of a split
    (haptic_glance.know.split); 0 for values of independent items. Fewer than two values, or values without spread: no
    interval (NaN), since a resample of equal values says nothing of how others would differ. statistic: np.median,
    say, in the mean's place. Raises ValueError for values of another shape.
    """
    values = of_units(values)
    if len(values) == 0:
        return np.nan, np.nan, np.nan
    mean = float(statistic(values, axis=0))
    if not _varied(values):
        return mean, np.nan, np.nan
    return mean, *_ends(mean, _resampled(values, seed, statistic), len(values), shared)


def _varied(values: np.ndarray) -> bool:
    """Whether there are two values or more (k,), and not all equal."""
    return len(values) > 1 and bool(np.ptp(values) > ROUNDED * np.abs(values).max())


def _resampled(values: np.ndarray, seed: int, statistic: Statistic) -> np.ndarray:
    """(RESAMPLES,) the statistic of resamples of the values (k,)."""
    return np.asarray(statistic(values[_picks(RESAMPLES, len(values), seed)], axis=1))


@lru_cache(maxsize=16)  # most intervals of a table are over as many values
def _picks(resamples: int, count: int, seed: int) -> np.ndarray:
    """(resamples, count) which of so many values each resample has."""
    return np.random.default_rng(seed).integers(count, size=(resamples, count))


def _ends(mean: float, resampled: np.ndarray, n: int, shared: float, level: float = 0.95) -> tuple[float, float]:
    """The ends of the `interval` of n values, from their mean and the means (r,) of their resamples."""
    tail = (1 + level) / 2
    low, high = np.quantile(resampled, [1 - tail, tail])
    t_factor = scipy.special.stdtrit(n - 1, tail) / scipy.special.ndtri(tail) * np.sqrt(n / (n - 1))
    widen = t_factor * np.sqrt(1 + n * shared)
    return float(mean - (mean - low) * widen), float(mean + (high - mean) * widen)


def of_units(values: ArrayLike) -> np.ndarray:
    """The finite values as `interval` counts them: those of a Series over items by unit, all others each by itself."""
    series: Any = values  # a Series, maybe; the core install has no pandas to ask
    if "item" in getattr(getattr(series, "index", None), "names", ()):
        series = by_unit(series)
    numbers = np.asarray(series, dtype=np.float64)
    if numbers.ndim != 1:
        raise ValueError(f"values must have shape (k,), got {numbers.shape}")
    return numbers[np.isfinite(numbers)]


def p_value(values: ArrayLike, shared: float = 0.0) -> float:
    """Two-sided: 1 less the level at which the `interval` of the values (k,) just touches zero; NaN without interval.

    Not below SMALLEST, which is what RESAMPLES draws can tell.
    """
    values = of_units(values)
    if not _varied(values):
        return np.nan
    mean, resampled = float(np.mean(values, axis=0)), _resampled(values, 0, np.mean)
    levels = np.array([SMALLEST, 1 - SMALLEST])  # searched by halving, since an interval widens with its level
    while np.ptp(levels) > SMALLEST:
        low, high = _ends(mean, resampled, len(values), shared, float(levels.mean()))
        levels[0 if low > 0 or high < 0 else 1] = levels.mean()
    return float(1 - levels.mean())


def discoveries(p_values: ArrayLike) -> np.ndarray:
    """(k,) bool: which of the p-values (k,) hold with a false discovery rate of 5 %; NaN never does.

    Benjamini and Hochberg, Controlling the false discovery rate, 1995, by scipy.
    """
    p_values = np.asarray(p_values, dtype=np.float64)
    finite = np.isfinite(p_values)
    holds = np.zeros(len(p_values), dtype=bool)
    if finite.any():
        holds[finite] = scipy.stats.false_discovery_control(p_values[finite]) <= 0.05
    return holds


def interval_metrics(values: ArrayLike, seed: int = 0) -> dict[str, float]:
    """{mean, low, high} of `interval`, rounded for a metric file; what is not finite is left out."""
    ends = zip(("mean", "low", "high"), interval(values, seed=seed), strict=True)
    return {key: round(value, 6) for key, value in ends if np.isfinite(value)}


def interval_tree(values: Mapping[tuple[str, ...], ArrayLike], seed: int = 0) -> dict[str, Any]:
    """Nested dicts for a metric file: the `interval_metrics` of each list of values, below the parts of its key."""
    tree: dict[str, Any] = {}
    for (*names, last), numbers in values.items():
        branch = tree
        for name in names:
            branch = branch.setdefault(name, {})
        branch[last] = interval_metrics(numbers, seed)
    return tree


def pseudo_values(whole: float, without: Any) -> Any:
    """(objects,) each object's part in a statistic, by its value of all objects and of all but one (Tukey 1958)."""
    return len(without) * whole - (len(without) - 1) * without


ROUNDS = 1000  # of the search for the variance between sets; tens are enough but where it is next to zero


class Pooled(NamedTuple):
    """A pooled effect: its standard error with degrees of freedom, and how the sets vary.

    between: the variance between sets. i2: its share of the variation of the sets' effects, 0 to 1. differ: p-value of
    Cochran's Q, that all sets have one effect.
    """

    mean: float
    error: float
    freedom: float
    between: float
    i2: float
    differ: float

    def interval(self, level: float = 0.95) -> tuple[float, float, float]:
        """(mean, low, high), by Student's t."""
        half = float(scipy.special.stdtrit(self.freedom, (1 + level) / 2)) * self.error
        return self.mean, self.mean - half, self.mean + half

    @property
    def p_value(self) -> float:
        """Two-sided, of no effect."""
        return float(2 * scipy.special.stdtr(self.freedom, -abs(self.mean) / self.error))


def pool(means: Sequence[float], errors: Sequence[float], freedoms: Sequence[float]) -> Pooled:
    """The random-effects mean of the effects of k sets, (k,) with their standard errors and degrees of freedom.

    The variance between sets is that of restricted maximum likelihood. Where it is above zero and there are three sets
    or more, the error is Hartung and Knapp's (2001) with k - 1 degrees of freedom: it carries to other sets. That error
    is too small where sets agree by luck, and therefore never taken below the plain one (Roever, Knapp and Friede,
    BMC Medical Research Methodology 2015). Else the error is the plain one, sqrt(1 / sum of weights), with the degrees
    of freedom of Welch and Satterthwaite. Of two sets nobody knows the spread of sets: it is about these two.
    Raises ValueError for fewer than two sets, or an error that is not above zero.
    """
    effects, within = np.asarray(means, dtype=np.float64), np.asarray(errors, dtype=np.float64) ** 2
    k = len(effects)
    if k < 2 or not (within > 0).all():
        raise ValueError(f"pooling needs two sets or more with errors above zero, got the errors {list(errors)}")
    weights = 1 / within
    q = float(weights @ (effects - weights @ effects / weights.sum()) ** 2)
    typical = (k - 1) / (weights.sum() - (weights**2).sum() / weights.sum())  # variance within (Higgins, Thompson 2002)
    between = variance_between(effects, within)
    weights = 1 / (within + between)
    mean = float(weights @ effects / weights.sum())
    error, freedom = weights.sum() ** -0.5, weights.sum() ** 2 / (weights**2 / np.asarray(freedoms)).sum()
    if between > 0 and k > 2:
        error, freedom = error * max(1.0, float(weights @ (effects - mean) ** 2) / (k - 1)) ** 0.5, k - 1
    shares = between / (between + typical), scipy.special.chdtrc(k - 1, q)
    return Pooled(mean, float(error), float(freedom), between, *map(float, shares))


def variance_between(effects: np.ndarray, within: np.ndarray) -> float:
    """The variance between sets by restricted maximum likelihood (Viechtbauer 2005); effects, within: (k,)."""
    variance = float(effects.var(ddof=1))
    for _ in range(ROUNDS):
        weights, before = 1 / (within + variance), variance
        mean = weights @ effects / weights.sum()
        step = (weights**2 @ ((effects - mean) ** 2 - within)) / (weights**2).sum() + 1 / weights.sum()
        variance = max(0.0, float(step))
        if abs(variance - before) <= 1e-9 * (variance + within.min()):
            break
    return variance if variance > 1e-6 * within.min() else 0.0


BROKEN = 0.5  # share of the lead that is left at the breaking point


def lead_left(accuracy: ArrayLike, clean: float, chance: float) -> np.ndarray:
    """The share of the lead over chance that is left: 1 for the undisturbed accuracy `clean`, 0 at chance.

    accuracy: any shape. NaN if `clean` is at chance or below, since there is no lead to lose.
    """
    lead = np.asarray(accuracy, dtype=np.float64) - chance
    return lead / (clean - chance) if clean > chance else np.full_like(lead, np.nan)


def breaking_point(severities: Sequence[float], left: Sequence[float], unharmed: float) -> float:
    """The mildest severity at which less than half is left, linearly interpolated; NaN if there is none.

    severities (s,): from mild to harsh, rising or falling; left (s,): a share such as that of `lead_left` or the
    repeatability; unharmed: the severity that changes nothing, where the share is 1.
    """
    return float(_first_falls(severities, np.asarray(left, dtype=np.float64)[None], unharmed)[0])


def breaking_interval(
    severities: Sequence[float], left: ArrayLike, unharmed: float, seed: int = 0
) -> tuple[float, float, float]:
    """(breaking point of the mean over units, its 95 % interval from mild to harsh); NaN is beyond the harshest.

    left (n, s): of each unit at each severity, NaN where it was not measured. The units are resampled, and an end of
    the interval is censored where so many resamples do not break. The ends are quantiles at levels that are widened for
    few units (`expanded_levels`). Fewer than two units: both ends are the breaking point.
    """
    left = np.atleast_2d(np.asarray(left, dtype=np.float64))
    left = left[np.isfinite(left).any(axis=1)]
    point = float(_first_falls(severities, resampled_means(left, np.ones((1, len(left)))), unharmed)[0])
    if len(left) < 2:
        return point, point, point
    sign = 1 if severities[-1] >= unharmed else -1  # harsher is more, or less
    points = sign * _first_falls(severities, resampled_means(left, resamples(len(left), seed)), unharmed)
    points[np.isnan(points)] = np.inf
    tail = expanded_levels(len(left))
    low, high = np.quantile(points, tail[0], method="lower"), np.quantile(points, tail[1], method="higher")
    mild, harsh = (sign * float(end) if np.isfinite(end) else float("nan") for end in (low, high))
    return point, mild, harsh


def resamples(units: int, seed: int = 0) -> np.ndarray:
    """(RESAMPLES, units) f8: how often each unit is in each bootstrap resample."""
    return np.random.default_rng(seed).multinomial(units, np.full(units, 1 / units), RESAMPLES).astype(np.float64)


def resampled_means(values: np.ndarray, counts: np.ndarray) -> np.ndarray:
    """(r, k) means of values (n, k) over the units that counts (r, n) name; NaN left out, NaN where nothing is left."""
    finite = np.isfinite(values)
    with np.errstate(invalid="ignore"):
        return (counts @ np.where(finite, values, 0.0)) / (counts @ finite)


def expanded_levels(units: int) -> tuple[float, float]:
    """(low, high) quantiles of a bootstrap of `units` units whose interval has 95 % in spite of few units.

    The plain percentile interval is too narrow by t / z * sqrt(n / (n - 1)). Quantiles farther out mend that, the
    expanded percentile interval of Hesterberg (What teachers should know about the bootstrap, The American Statistician
    2015), and an end may be censored.
    """
    tail = float(scipy.stats.norm.cdf(np.sqrt(units / (units - 1)) * scipy.stats.t.ppf((1 - 0.95) / 2, units - 1)))
    return tail, 1 - tail


def _first_falls(severities, left, unharmed):
    """(r,) breaking points of curves (r, s); NaN where a curve never falls below BROKEN, or falls after a NaN."""
    levels = np.array([unharmed, *severities], dtype=np.float64)
    left = np.hstack([np.ones((len(left), 1)), left])
    k, rows = (left < BROKEN).argmax(axis=1), np.arange(len(left))  # 0 where it never falls
    before, after = left[rows, k - 1], left[rows, k]
    with np.errstate(invalid="ignore", divide="ignore"):
        points = levels[k - 1] + (before - BROKEN) / (before - after) * (levels[k] - levels[k - 1])
    return np.where(k > 0, points, np.nan)


class Split(NamedTuple):
    """Ids of items: `train` and `test` are disjoint and hold all; `validation`, a part of `train`, chooses settings."""

    train: np.ndarray
    validation: np.ndarray
    test: np.ndarray

    @property
    def fit(self) -> np.ndarray:
        """The part of `train` that is not in `validation`."""
        return np.setdiff1d(self.train, self.validation)


def stratified_split(labels: np.ndarray, share: float, rng: np.random.Generator) -> tuple[np.ndarray, np.ndarray]:
    """(first, second): sorted ids of two disjoint parts that together hold all; first holds `share` of each label.

    labels: (k,) integers. Each label has at least one item in both parts. Raises ValueError for a share outside
    (0, 1) or a label with fewer than two items.
    """
    labels = np.asarray(labels)
    if labels.ndim != 1 or not np.issubdtype(labels.dtype, np.integer):
        raise ValueError(f"labels must be integers of shape (k,), got {labels.dtype} {labels.shape}")
    if not 0 < share < 1:
        raise ValueError(f"share must lie between 0 and 1, got {share}")
    first = []
    for label in np.unique(labels):
        ids = np.flatnonzero(labels == label)
        if len(ids) < 2:
            raise ValueError(f"class {label} has one item alone: it cannot be split")
        count = min(max(round(share * len(ids)), 1), len(ids) - 1)
        first.append(rng.permutation(ids)[:count])
    first = np.sort(np.concatenate(first))
    return first, np.setdiff1d(np.arange(len(labels)), first)
