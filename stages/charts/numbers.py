"""Numbers as text."""

import math
import numbers
from typing import Any


def number(value: Any, digits: int = 3) -> str:
    """A number to `digits` significant digits without exponent clutter; a dash for NaN; other things as they are."""
    if value is None or value != value:
        return "–"
    if isinstance(value, bool) or not isinstance(value, numbers.Real):
        return str(value)
    value = float(value)
    if value.is_integer() and abs(value) < 1e7:
        return f"{int(value):,}"
    if 0 < abs(value) < 1e-4:
        return f"{value:.{digits - 1}e}"
    places = max(0, digits - 1 - math.floor(math.log10(abs(value))))
    return f"{value:.{places}f}"


def with_interval(mean: float, low: float, high: float, scale: float = 1, places: int | None = None) -> str:
    """`mean [low, high]`, or the mean alone where the interval is unknown; "not run" without a mean."""
    if mean != mean:
        return "not run"
    show = (lambda v: f"{v * scale:z.{places}f}") if places is not None else (lambda v: number(v * scale))
    return show(mean) if low != low else f"{show(mean)} [{show(low)}, {show(high)}]"
