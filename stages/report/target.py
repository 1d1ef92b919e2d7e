"""Whether a target was met: the word goes by the interval, not by the mean alone."""

import math
from collections.abc import Callable

from .markdown import number


def on_target(
    value: float,
    low: float,
    high: float,
    at_least: float = -math.inf,
    at_most: float = math.inf,
    show: Callable[[float], str] = number,
) -> str:
    """The word: met, met on average (interval from x), missed on average (interval to x), or missed.

    `value` against `at_least`, or against `at_most`. low, high: the interval; met and missed are what the whole of it
    says. show: how its end is written. A value without an interval (NaN) is one or the other on average only.
    """
    if value != value:
        return "not measured"
    good = at_least <= value <= at_most
    side, end = ("from", low) if good == (at_most == math.inf) else ("to", high)  # the end nearer to the other word
    if end == end and (at_least <= end <= at_most) == good:
        return "met" if good else "missed"
    rest = f"interval {side} {show(end)}" if end == end else "no interval"
    return f"{'met' if good else 'missed'} on average ({rest})"
