"""What the name of a method in lod.methods means: whose points, and how they are kept."""

from dataclasses import dataclass

from stages.salient_points import METHODS

from .neighbourhood import WAYS

PLAIN = "qem"
SOFT = "soft"


@dataclass(frozen=True)
class Variant:
    """One way of simplifying: the method of salient_points (None: plain QEM), and how it is used.

    way: a way of `neighbourhoods`, by which the points are kept, or `soft`: the saliency weighs the error, nothing is
    kept; None for plain QEM.
    """

    name: str
    method: str | None
    way: str | None


def variant(name):
    """The Variant that a name means: `qem`, `enhanced` (three rings), `enhanced-adaptive`, `-area` or `-soft`.

    Raises ValueError that says which part of the name is wrong.
    """
    if name == PLAIN:
        return Variant(name, None, None)
    method, dash, way = name.partition("-")
    suffixes = [each for each in (*WAYS, SOFT) if each != "fixed"]
    if method not in METHODS:
        raise ValueError(f"lod.methods: {name!r}: unknown method {method!r}; methods are {PLAIN}, {', '.join(METHODS)}")
    if dash and way not in suffixes:
        raise ValueError(f"lod.methods: {name!r} ends on {way!r}; endings are -{', -'.join(suffixes)}, or none")
    return Variant(name, method, way or "fixed")
