"""The meaning of a name in lod.methods: which method's points, and how they are preserved."""

from dataclasses import dataclass

from stages.salient_points import METHODS

from .neighbourhood import NEIGHBOURHOODS

PLAIN, QSLIM = "qem", "qslim"  # quadric edge collapse by the backend of the settings, and without its fit
SOFT = "soft"


@dataclass(frozen=True)
class Variant:
    """One way of simplifying: the method of salient_points (None: plain QEM), and how it is used.

    rule: that of `neighbourhoods`, which preserves the points, or `soft`: the saliency weights the error and nothing is
    frozen; None for plain QEM. backend: who simplifies; None for that of the settings.
    """

    name: str
    method: str | None
    rule: str | None
    backend: str | None = None


def variant(name: str) -> Variant:
    """The Variant of a name: `qem`, `qslim`, `glance` (three rings), `glance-adaptive`, `-area` or `-soft`.

    Raises ValueError that names the wrong part.
    """
    if name in (PLAIN, QSLIM):
        return Variant(name, None, None, QSLIM if name == QSLIM else None)
    method, dash, rule = name.partition("-")
    suffixes = [each for each in (*NEIGHBOURHOODS, SOFT) if each != "fixed"]
    known = (PLAIN, QSLIM, *METHODS)
    if method not in METHODS:
        raise ValueError(f"lod.methods: {name!r}: unknown method {method!r}; methods are {', '.join(known)}")
    if dash and rule not in suffixes:
        raise ValueError(f"lod.methods: {name!r} ends in {rule!r}; endings are -{', -'.join(suffixes)}, or none")
    return Variant(name, method, rule or "fixed")
