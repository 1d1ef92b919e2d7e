"""Random sets of objects in the place of named ones, so that a conclusion is about sets and not about one of them."""

from collections.abc import Mapping, Sequence

from haptic_glance.base.rng import rng


def drawn_sets(
    groups: Mapping[str, Sequence[str]], objects: Sequence[str], count: int, seed: int
) -> dict[str, list[str]]:
    """{"GROUP.NUMBER": objects}: `count` random sets, each with groups of as many objects as the named ones have.

    The objects are dealt like cards and shuffled anew when too few are left, so that two sets share as few as they can.
    The groups of one number are nested: four objects are the first four of the six. Raises ValueError where there are
    fewer objects than the largest group takes.
    """
    size = max(map(len, groups.values()))
    if size > len(objects):
        raise ValueError(f"classification.drawn: a set takes {size} objects, there are {len(objects)}")
    hands: list[list[str]] = []
    while len(hands) < count:
        deck = rng(seed, f"deck {len(hands)}").permutation(sorted(objects)).tolist()
        hands += [deck[start : start + size] for start in range(0, len(deck) - size + 1, size)]
    return {
        f"{group}.{number:02}": hand[: len(named)]
        for number, hand in enumerate(hands[:count], 1) for group, named in groups.items()
    }  # fmt: skip


def set_of(name: str) -> dict[str, str | int | None]:
    """The columns `group` and `set` of a name of `drawn_sets`, or of a named set."""
    group, _, number = name.partition(".")
    return {"group": group, "set": int(number) if number else None}
