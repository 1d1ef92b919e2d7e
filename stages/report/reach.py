"""Whether what is to be reached was reached: the word goes by the interval, not by the mean alone."""

from .markdown import number


def reach(value, low, high, least=None, most=None, show=number):
    """The word: reached, reached on average (interval from x), missed on average (interval to x), or missed.

    `value` against `least`, or against `most`. low, high: the interval; reached and missed are what the whole of it
    says. show: how its end is written. A value without an interval (NaN) is one or the other on average only.
    """
    if value != value:
        return "not measured"
    ends = {"from": low, "to": high}
    good, sides = (value >= least, ("from", "to")) if most is None else (value <= most, ("to", "from"))
    side = sides[0] if good else sides[1]  # the end that decides: the one nearer to the other word
    end = ends[side]
    if end == end and (end >= least if most is None else end <= most) == good:
        return "reached" if good else "missed"
    rest = f"interval {side} {show(end)}" if end == end else "no interval"
    return f"{'reached' if good else 'missed'} on average ({rest})"
