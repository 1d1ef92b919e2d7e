"""How many faces an object needs to be seen, to be felt and to be recognised by touch: no more than a task needs."""

from .need import coarsest

__all__ = ["coarsest"]
