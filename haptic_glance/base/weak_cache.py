"""A cache of function results that lives as long as the first argument."""

import functools
import weakref
from collections.abc import Callable


def weak_cache(function: Callable) -> Callable:
    """Caches function(owner, *rest) per owner (by identity) and rest; the entries are freed with the owner.

    So the views of a mesh share its curvature, and the channels of a view its grey image. The value must not refer to
    its owner, or neither would ever be freed. `rest` must be hashable.
    """
    cache = {}

    @functools.wraps(function)
    def cached(owner, *rest):
        if id(owner) not in cache:
            cache[id(owner)] = {}
            weakref.finalize(owner, cache.pop, id(owner), None)
        values = cache[id(owner)]
        if rest not in values:
            values[rest] = function(owner, *rest)
        return values[rest]

    return cached
