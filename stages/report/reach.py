"""Whether what is to be reached was reached: the word goes by the interval, not by the mean alone."""

from .markdown import number


def reach(value, low, high, least=None, most=None, show=number):
    """The word: reached, reached on average (interval from x), or missed; `value` against `least`, or against `most`.

    low, high: the interval; reached is what the whole of it says. show: how its end is written. A value without an
    interval (NaN) can be reached on average only.
    """
    if value != value:
        return "not measured"
    side, end = ("from", low) if most is None else ("to", high)
    good, sure = (value >= least, low >= least) if most is None else (value <= most, high <= most)
    if sure or not good:
        return "reached" if sure else "missed"
    return f"reached on average (interval {side} {show(end)})" if end == end else "reached on average (no interval)"
