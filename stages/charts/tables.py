"""Tables of the report: rows of measurements become cells, grids with the thesis's numbers, and Markdown.

A cell is `mean [low, high]`, rounded for a reader; a cell without a measurement says "not run". `Ranking` finds the
best cells by the numbers that are shown, so that cells shown as equal are equally good. `scaled` selects the rows of
one scaling of the samples (T4.2.4), `with_means` adds means over the classifiers with and without the SVM.
"""

import re
from collections.abc import Callable, Collection, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, cast

import numpy as np
import pandas as pd
from numpy.typing import ArrayLike

from haptic_glance.know.classifiers import BEFOREHAND, MIN_MAX, TRAINING, TWICE
from stages.charts.numbers import number, with_interval
from stages.charts.results import NotRun, Results
from stages.engine.statistics import interval

READINGS = {  # beside ours, TRAINING
    BEFOREHAND: "all data standardised beforehand (T4.2.4)", TWICE: "components standardised, too",
    MIN_MAX: "all data from 0 to 1",
}  # fmt: skip
CLASSIFIERS = ("knn", "svm", "decision_tree", "naive_bayes", "deep_learning")  # the thesis's order, reversed
WHOSE, OURS, THESIS = "numbers of", "ours", "the thesis"  # a column of tables beside the thesis's, and its values
MEANS = {"mean_of_all": CLASSIFIERS, "mean_without_svm": tuple(name for name in CLASSIFIERS if name != "svm")}


def means(frame: pd.DataFrame, by: Sequence[str], shared: float = 0.0, top: float = np.inf) -> list[dict]:
    """Mean, low, high, count and seconds of column `value`, one row for each combination of the columns `by`.

    For values within 0..top, such as rates and errors: the interval is cut there. Seconds are the median, since the
    first piece of work of a process also loads its libraries.
    """
    summaries, names = [], (*by, "mean", "low", "high", "values", "seconds")
    for key, rows in grouped(frame.dropna(subset=["value"]), by):
        numbers = (*within(over_items(rows), shared, top=top), len(rows), rows["seconds"].median())
        summaries.append(dict(zip(names, (*key, *numbers), strict=True)))
    return summaries


def scaled(rows: pd.DataFrame, scaling: str = TRAINING) -> pd.DataFrame:
    """The rows of one scaling; those that are about no classifier have none, and stay with TRAINING."""
    return rows[rows["scaling"].fillna(TRAINING) == scaling]


def with_means(rows: pd.DataFrame) -> pd.DataFrame:
    """The rows, and behind them the means over the classifiers of MEANS where each of these was run."""
    columns = ("dataset", "set", "repetition", "group", "method", "variant", "split", "metric", "scaling")
    keys = [name for name in columns if name in rows]
    rows = rows[[*keys, "classifier", "value"]]  # of some forty columns
    parts = [rows]
    for name, classifiers in MEANS.items():
        groups = rows[rows["classifier"].isin(classifiers)].groupby(keys, dropna=False, sort=False)
        means = groups.agg({"value": "mean", "classifier": "nunique"}).reset_index()
        parts.append(means[means["classifier"] == len(classifiers)].assign(classifier=name))
    return pd.concat(parts, ignore_index=True)


def with_printed_means(thesis: pd.DataFrame) -> pd.DataFrame:
    """The thesis's figures by classifier, the index, and behind them their means over the classifiers of MEANS."""
    means = {name: thesis.loc[list(several)].mean() for name, several in MEANS.items()}
    return pd.concat([thesis, pd.DataFrame(means).T]).rename_axis("classifier")


def over_items(rows: pd.DataFrame) -> pd.Series:
    """Column `value`, indexed by `item` where each row is about one: an interval then counts copies of a shape once."""
    if "item" not in rows or rows["item"].isna().any():
        return rows["value"]
    return pd.Series(rows["value"].to_numpy(), pd.Index(rows["item"], name="item"), name="value")


def grouped(frame: pd.DataFrame, by: Sequence[str]) -> Iterator[tuple[tuple[Any, ...], pd.DataFrame]]:
    """(values of the columns `by`, rows) of each of their combinations, in the order of the rows; no empty cells."""
    for key, group in frame.groupby(list(by), sort=False):
        yield cast(tuple[Any, ...], key), group


def records(frame: pd.DataFrame) -> Iterable[Any]:
    """The rows of a frame as `itertuples` gives them, of whose values no type is known."""
    return frame.itertuples()


def within(values: ArrayLike, shared: float = 0.0, least: float = 0.0, top: float = 1.0) -> tuple[float, float, float]:
    """(mean, low, high) with the interval cut at the range of the values, by default that of rates."""
    mean, low, high = interval(values, shared)
    return mean, float(np.maximum(low, least)), float(np.minimum(high, top))


def grid(
    cells: pd.DataFrame,
    down: str | Sequence[str],
    across: str,
    names: Mapping[str, Callable[[Any], Any]] | None = None,
    head: Callable[[Any], str] = str,
    places: int = 0,
) -> pd.DataFrame:
    """Cells pivoted for a reader: `62 [57, 67]`, shares in per cent, in the order of the cells.

    cells: one row each, with the columns `down` and `across`, `accuracy` with `low` and `high`. names: how a value of a
    column `down` is said; head: how one of `across` is. A cell that is absent is "not run"; in rows of the THESIS, a
    dash.
    """
    down = [down] if isinstance(down, str) else list(down)
    wide = cells.assign(text=cell_texts(cells, places)).pivot(index=down, columns=across, values="text")
    wide = wide.reindex(index=cells.set_index(down).index.unique(), columns=cells[across].unique())
    gaps = pd.Series(np.where((wide.index.to_frame() == THESIS).any(axis=1), "–", "not run"), wide.index)
    wide = wide.apply(lambda column: column.fillna(gaps)).rename(columns=head).rename_axis(columns=None).reset_index()
    return wide.assign(**{column: wide[column].map(say) for column, say in (names or {}).items()})


def cell_texts(cells: pd.DataFrame, places: int = 0) -> list[str]:
    """The cells of `grid`."""
    shares = cells[["accuracy", "low", "high"]].itertuples(index=False)
    return [with_interval(*share, scale=100, places=places) for share in shares]


def beside_thesis(cells: pd.DataFrame, down: Sequence[str]) -> pd.DataFrame:
    """Cells of `grid` with a column WHOSE: ours, and behind each row of the columns `down` the thesis's, if it has one.

    cells: with a column `thesis`, which is empty where the thesis prints nothing.
    """
    cells = cells.assign(**{WHOSE: OURS}, place=cells.groupby(list(down), sort=False).ngroup())
    printed = cells.dropna(subset=["thesis"])
    printed = printed.assign(accuracy=printed["thesis"], low=np.nan, high=np.nan, **{WHOSE: THESIS})
    return pd.concat([cells, printed]).sort_values("place", kind="stable", ignore_index=True)


def percent(share: float, places: int = 0) -> str:
    """A share in per cent, a dash where it is unknown."""
    return f"{100 * share:z.{places}f}" if share == share else "–"


def everywhere(results: Results, stage: str, message: str = "", **where: object) -> dict[str, pd.DataFrame]:
    """{set: its rows as `Results.measured` reads them}: of all sets that have such rows.

    Raises NotRun where none has: of `message`, or as the last set that was looked at.
    """
    by_set, error = {}, NotRun(message or f"no measurements of {stage}", stage)
    for dataset in results.datasets(stage):
        try:
            by_set[dataset] = results.measured(stage, dataset, **where)
        except NotRun as missing:
            error = error if message else missing
    if not by_set:
        raise error
    return by_set


WORDS = ("not run", "infeasible", "")  # that stand in columns of numbers


def interval_columns(name: str, ends: Iterable[Any], prefix: str | None = None) -> dict[str, Any]:
    """{name: mean, `name_low`: low, `name_high`: high} of (mean, low, high); prefix: in place of `name_`."""
    prefix = f"{name}_" if prefix is None else prefix
    return dict(zip((name, f"{prefix}low", f"{prefix}high"), ends, strict=True))


def interval_text(row: Any, name: str, scale: float = 1, places: int | None = None) -> str:
    """`with_interval` of a row of `records` with `interval_columns` of this name."""
    mean, low, high = (getattr(row, column) for column in (name, f"{name}_low", f"{name}_high"))
    return with_interval(mean, low, high, scale, places)


def signed(mean: float, low: float, high: float, places: int = 2) -> str:
    """`+0.83 [0.61, 1.05]`."""
    span = f" [{low:z.{places}f}, {high:z.{places}f}]" if low == low else ""
    return f"{mean:+z.{places}f}{span}"


def as_text(frame: pd.DataFrame) -> pd.DataFrame:
    """A frame of strings, numbers rounded to three significant digits."""
    return frame.map(number)


def markdown_table(frame: pd.DataFrame, bold: pd.DataFrame | None = None) -> str:
    """A GitHub table of a frame of strings; columns of numbers stand to the right. bold: of each cell whether it is."""
    marks = np.zeros(frame.shape, dtype=bool) if bold is None else bold.to_numpy()
    rows = [
        [f"**{text}**" if mark else text for text, mark in zip(_escaped(cells), line, strict=True)]
        for cells, line in zip(frame.itertuples(index=False), marks, strict=True)
    ]
    rules = ["---:" if is_numeric(frame[column]) else "---" for column in frame.columns]
    lines = [[str(column) for column in frame.columns], rules, *rows]
    return "\n".join("| " + " | ".join(line) + " |" for line in lines)


def _escaped(cells: Iterable[Any]) -> list[str]:
    return [str(cell).replace("|", r"\|") for cell in cells]


def is_numeric(column: pd.Series) -> bool:
    """True for a column of strings that hold numbers alone: signs, intervals, a dash or a few words are let through."""
    return all(cell in WORDS or re.fullmatch(r"[-+–±\d.,:e\[\]· ]*", str(cell)) for cell in column)


FIRST = re.compile(r"[+<]?\s*([-−]?\d[\d,]*(?:\.\d+)?(?:e[+-]?\d+)?)")  # number of a cell such as `+0.83 [0.61, 1.05]`


@dataclass(frozen=True)
class Ranking:
    """The columns of the shown frame whose best cells stand in bold.

    by: a column, or several. lowest: whether less is better. among: columns; rows that agree in them are compared with
    each other alone. exempt: names; a row that has one in any of its cells takes no part: a truth, a full model, what
    the thesis printed. aside: such rows in words.
    """

    by: str | Sequence[str]
    lowest: bool = False
    among: Sequence[str] = ()
    exempt: Collection[str] = (THESIS,)
    aside: str = ""

    @property
    def columns(self) -> list[str]:
        """The columns `by`."""
        return [self.by] if isinstance(self.by, str) else list(self.by)

    def best(self, text: pd.DataFrame) -> pd.DataFrame:
        """Of each cell of a frame of strings whether it is the best, or shown as equal to it.

        None of a column is where all are equal, or where the column was not run.
        """
        marks = pd.DataFrame(False, text.index, text.columns)
        aside = text.isin(list(self.exempt)).any(axis=1)
        keys: Any = [text[column] for column in self.among] or np.zeros(len(text))
        best, worst = ("min", "max") if self.lowest else ("max", "min")
        for column in filter(text.columns.__contains__, self.columns):
            values = text[column].map(leading).mask(aside)
            groups = values.groupby(keys, sort=False)
            top = groups.transform(best)
            marks[column] = (values == top) & (top != groups.transform(worst))
        return marks

    def legend(self, heads: Iterable[str]) -> str:
        """What bold means, in a line, in a table with these columns."""
        end = f"{'lowest' if self.lowest else 'highest'}{' of ours' if WHOSE in heads else ''}"
        what = f"the {end} of its column" if len(self.columns) > 1 else f"the {end} in the column “{self.columns[0]}”"
        what += f" among rows of the same {' and '.join(self.among)}" if self.among else ""
        return f"Bold: {what}{', ' if self.aside else ''}{self.aside}."


def leading(cell: str) -> float:
    """The first number of a cell; NaN of one that starts with a word or a dash."""
    match = FIRST.match(cell)
    return float(match[1].replace(",", "").replace("−", "-")) if match else np.nan
