"""How many verdicts and sentences there are of each word, and why those that are open are."""

import pandas as pd

from .verdict import CAUSES, WORDS


def counts(claims: pd.DataFrame) -> dict[str, int]:
    """{word: how many there are of it} in a frame of `judge`."""
    return _tally(claims["verdict"])


def sentences(claims: pd.DataFrame) -> pd.DataFrame:
    """A row a sentence: section and verdict. One that is judged several times counts once.

    It has the word that its measured verdicts share, is mixed where one supports and another contradicts it or where
    one is mixed, and else is open. What was not run says nothing, unless nothing else is there. A sentence of the
    thesis and one of our own are two, even in the same words.
    """
    own = claims["section"].eq("ours")
    found = [
        {"section": group["section"].iloc[0], "claim": group["claim"].iloc[0], "verdict": _shared_word(group)}
        for _, group in claims.groupby([own, claims["claim"]], sort=False)
    ]
    return pd.DataFrame(found, columns=["section", "claim", "verdict"])


def counted(claims: pd.DataFrame) -> str:
    """On a frame of `judge`: how many verdicts there are of each word, how many of them hold, how many sentences."""
    decided = claims["holds"].isin(["yes", "no"]).sum()
    once = sentences(claims)
    thesis = once[once["section"] != "ours"]
    return (
        f"{len(claims)} verdicts: {_said(claims)}. Of the {decided} that are supported or contradicted, "
        f"{(claims['holds'] == 'yes').sum()} hold among the claims of their chapter, at a false discovery rate of 5 %. "
        f"They judge {len(once)} sentences: {_said(once)}. Of these {len(thesis)} are the thesis's: {_said(thesis)}."
    )


def open_by_cause(claims: pd.DataFrame) -> str:
    """A sentence: of the open verdicts, how many there are of each of CAUSES."""
    found = _tally(claims.loc[claims["verdict"] == "open", "cause"], CAUSES)
    return f"Open verdicts by cause: {', '.join(f'{cause} {count}' for cause, count in found.items() if count)}."


def _said(frame: pd.DataFrame) -> str:
    return ", ".join(f"{count} {word}" for word, count in counts(frame).items())


def _tally(column: pd.Series, words: tuple[str, ...] = WORDS) -> dict[str, int]:
    return {word: list(column).count(word) for word in words}


def _shared_word(group: pd.DataFrame) -> str:
    words = set(group.loc[group["pairs"] > 0, "verdict"])
    if len(words) == 1:
        return words.pop()
    return "mixed" if "mixed" in words or {"supported", "contradicted"} <= words else "open"
