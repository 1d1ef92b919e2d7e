"""The agreements that the fidelity table states: their forms, and the comparison with a measured value."""

import re

FORMS = {
    "r": r"r = (-?[\d.]+)",  # a correlation
    "difference": r"difference < ([\d.e-]+)",  # the largest absolute one lies below
    "settings": r"(\d+) of (\d+) settings",
    "pixels": r"([\d.]+) pixels",
    "share": r"([\d.]+) % apart",
}
CORRELATION, DIFFERENCE = 0.99, 1e-3  # the least and the most of what is as printed
ROUNDING = 0.51  # of the last digit that is stated


def stated(text: str) -> tuple[str, list[float]]:
    """(kind, numbers) of a stated agreement; ValueError for another form."""
    for kind, form in FORMS.items():
        if match := re.fullmatch(form, text):
            return kind, [float(number) for number in match.groups()]
    raise ValueError(f"{text!r} is no agreement: write it as one of {', '.join(FORMS.values())}")


def is_printed(text: str) -> bool:
    """Whether a stated agreement is good enough for `as printed`."""
    kind, numbers = stated(text)
    if kind == "r":
        return numbers[0] >= CORRELATION
    if kind == "settings":
        return numbers[0] == numbers[1]
    return numbers[0] <= (DIFFERENCE if kind == "difference" else 0)


def matches(text: str, kind: str, measured: float | tuple[int, int]) -> bool:
    """Whether a stated agreement is what a test measures, within its last digit; a difference need only be below."""
    form, numbers = stated(text)
    if form != kind:
        return False
    if isinstance(measured, tuple):
        return numbers == list(measured)
    if kind == "difference":
        return measured < numbers[0]
    digits = re.search(r"\d+\.?(\d*)", text)
    return abs(measured - numbers[0]) <= ROUNDING * 10.0 ** -len(digits[1] if digits else "")
