"""The meaning of a name in lod.methods: which method's points, and how they are preserved."""

from dataclasses import dataclass

from stages.salient_points import METHODS

from .neighbourhood import NEIGHBOURHOODS

PLAIN = "qem"
SOFT = "soft"


@dataclass(frozen=True)
class Variant:
    """One way of simplifying: the method of salient_points (None: plain QEM), and how it is used.

    rule: that of `neighbourhoods`, which preserves the points, or `soft`: the saliency weights the error and nothing is
    frozen; None for plain QEM.
    """

    name: str
    method: str | None
    rule: str | None


def variant(name: str) -> Variant:
    """The Variant of a name: `qem`, `enhanced` (three rings), `enhanced-adaptive`, `-area` or `-soft`.

    Raises ValueError that names the wrong part.
    """
    if name == PLAIN:
        return Variant(name, None, None)
    method, dash, rule = name.partition("-")
    suffixes = [each for each in (*NEIGHBOURHOODS, SOFT) if each != "fixed"]
    if method not in METHODS:
        raise ValueError(f"lod.methods: {name!r}: unknown method {method!r}; methods are {PLAIN}, {', '.join(METHODS)}")
    if dash and rule not in suffixes:
        raise ValueError(f"lod.methods: {name!r} ends in {rule!r}; endings are -{', -'.join(suffixes)}, or none")
    return Variant(name, method, rule or "fixed")
