"""Remembers what was worked out for an object as long as the object lives."""

import functools
import weakref


def once(function):
    """function(owner, *rest), worked out once for each owner (by identity) and rest; forgotten with the owner.

    So the views of a mesh share its curvature, and the channels of a view its grey image. The value must not hold its
    owner, or neither would ever be freed; `rest` are hashable plain values.
    """
    kept = {}

    @functools.wraps(function)
    def remembered(owner, *rest):
        if id(owner) not in kept:
            kept[id(owner)] = {}
            weakref.finalize(owner, kept.pop, id(owner), None)
        values = kept[id(owner)]
        if rest not in values:
            values[rest] = function(owner, *rest)
        return values[rest]

    return remembered
