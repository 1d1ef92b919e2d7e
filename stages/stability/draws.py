"""Several draws of one disturbance as one: the mean of what was measured."""

from collections.abc import Sequence

from stages.kit.run import Rows


def mean_of_draws(draws: Sequence[Rows]) -> Rows:
    """Rows of one disturbance, those of the first draw with the means of all; a draw without values does not count.

    draws: the rows of each, in the same order, or fewer where it failed; those of the longest are taken.
    """
    longest = max(draws, key=len)
    found: dict[tuple[str, str], list[dict]] = {}
    for row in (row for rows in draws for row in rows if row["value"] is not None):
        found.setdefault((row["method"], row["metric"]), []).append(row)
    return [row | _means(found.get((row["method"], row["metric"]), [])) for row in longest]


def _means(rows):
    return {key: sum(row[key] for row in rows) / len(rows) for key in ("value", "seconds") if rows}
