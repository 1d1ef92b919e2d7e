"""How the time of a backend grows with the mesh: a power of n, or of n log n, with its interval."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import pandas as pd

from stages.report.markdown import with_interval

FITTED = 10_000  # faces from which the growth is fitted: below, the fixed cost of a call counts
POWERS: dict[str, Callable] = {"linear": lambda n: n, "loglinear": lambda n: n * np.log(n)}


@dataclass(frozen=True)
class Growth:
    """seconds = level * (shape(n) / shape(middle))^power, with the 95 % interval of the power; shape: of POWERS."""

    shape: str
    level: float
    middle: float
    power: float
    low: float
    high: float
    span: tuple[float, float]

    def __call__(self, n: np.ndarray, power: float | None = None) -> np.ndarray:
        """Seconds at n faces; power: another than the fitted, through the same middle."""
        shape = POWERS[self.shape]
        return self.level * (shape(n) / shape(self.middle)) ** (self.power if power is None else power)

    @property
    def said(self) -> str:
        """`1.04 [0.90, 1.11]`: the power with its interval."""
        return with_interval(self.power, self.low, self.high, places=2)


def growth(rows: pd.DataFrame, shape: str = "loglinear") -> Growth | None:
    """The Growth of the column `seconds` over `full`, or None for fewer than three sizes of FITTED faces or more.

    rows: of one backend. A least-squares line through the logarithms, with a level of its own for each share of the
    faces and for kept points. The interval is a bootstrap over the meshes: a subdivided one goes with what it was.
    """
    rows = rows[(rows["full"] >= FITTED) & (rows["seconds"] > 0)]
    if rows["full"].nunique() < 3:
        return None
    n = rows["full"].to_numpy(dtype=float)
    x, y = np.log(POWERS[shape](n)), np.log(rows["seconds"].to_numpy(dtype=float))
    level = pd.factorize(pd.MultiIndex.from_arrays([(rows["target"] / n).round(2), rows["with_points"]]))[0]
    mesh, names = pd.factorize(rows["mesh"])
    random = np.random.default_rng(0)
    picks = (random.multinomial(len(names), np.full(len(names), 1 / len(names))) for _ in range(1000))
    low, high = np.nanquantile([_slope(x, y, level, times[mesh]) for times in picks], [0.025, 0.975])
    power, middle = _slope(x, y, level, np.ones(len(x))), np.exp(np.log(n).mean())
    offset = (y - power * (x - np.log(POWERS[shape](middle)))).mean()
    return Growth(shape, np.exp(offset), middle, power, low, high, (n.min(), n.max()))


def _slope(x: np.ndarray, y: np.ndarray, level: np.ndarray, weight: np.ndarray) -> float:
    """Weighted least-squares slope with an intercept for each level; NaN where no level has two places."""
    total = np.maximum(np.bincount(level, weight), 1e-9)
    x, y = (values - (np.bincount(level, weight * values) / total)[level] for values in (x, y))
    spread = (weight * x * x).sum()
    return (weight * x * y).sum() / spread if spread > 1e-12 else np.nan
