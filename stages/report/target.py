"""Whether a target was met: the word goes by the interval, not by the mean alone."""

from collections.abc import Callable

from .markdown import number


def on_target(
    value: float,
    low: float,
    high: float,
    at_least: float | None = None,
    at_most: float | None = None,
    show: Callable[[float], str] = number,
) -> str:
    """The word: met, met on average (interval from x), missed on average (interval to x), or missed.

    `value` against `at_least`, or against `at_most`. low, high: the interval; met and missed are what the whole of it
    says. show: how its end is written. A value without an interval (NaN) is one or the other on average only.
    """
    if value != value:
        return "not measured"
    ends = {"from": low, "to": high}
    good, sides = (value >= at_least, ("from", "to")) if at_most is None else (value <= at_most, ("to", "from"))
    side = sides[0] if good else sides[1]  # the end that decides: the one nearer to the other word
    end = ends[side]
    if end == end and (end >= at_least if at_most is None else end <= at_most) == good:
        return "met" if good else "missed"
    rest = f"interval {side} {show(end)}" if end == end else "no interval"
    return f"{'met' if good else 'missed'} on average ({rest})"
