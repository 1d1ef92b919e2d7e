"""Which row of a table is the best."""

import re
from collections.abc import Collection, Sequence
from dataclasses import dataclass

import numpy as np
import pandas as pd

FIRST = re.compile(r"[+<]?\s*([-−]?\d[\d,]*(?:\.\d+)?(?:e[+-]?\d+)?)")  # number of a cell such as `+0.83 [0.61, 1.05]`


@dataclass(frozen=True)
class Ranking:
    """By which column of what is shown a table is ranked.

    lowest: whether less is better. among: columns; rows that agree in them are compared with each other alone. exempt:
    names; a row that has one in any of its cells takes no part: a truth, a full model, what the thesis printed.
    """

    by: str
    lowest: bool = False
    among: Sequence[str] = ()
    exempt: Collection[str] = ()

    def best(self, text: pd.DataFrame) -> np.ndarray:
        """(rows,) boolean of a frame of strings: the best, with those that are shown as equal to it; none if all are.

        None either where the column was not run.
        """
        if self.by not in text:
            return np.zeros(len(text), dtype=bool)
        values = text[self.by].map(leading).mask(text.isin(list(self.exempt)).any(axis=1))
        groups = values.groupby([text[column] for column in self.among] or np.zeros(len(text)), sort=False)
        best, worst = ("min", "max") if self.lowest else ("max", "min")
        top = groups.transform(best)
        return ((values == top) & (top != groups.transform(worst))).to_numpy()


def leading(cell: str) -> float:
    """The first number of a cell; NaN of one that starts with a word or a dash."""
    found = FIRST.match(cell)
    return float(found[1].replace(",", "").replace("−", "-")) if found else np.nan
