"""How many verdicts and sentences there are of each word, and why those that are open are."""

import pandas as pd

from .verdict import CAUSES, WORDS


def counts(claims: pd.DataFrame) -> dict[str, int]:
    """{word: how many there are of it} in a frame of `judge`."""
    return _tally(claims["verdict"])


def sentences(claims: pd.DataFrame) -> pd.DataFrame:
    """A row a sentence: section, claim, verdict and pairs of its primary claim; other claims ask whether it carries."""
    primary = claims["of"].eq("")
    return claims.loc[primary, ["section", "claim", "verdict", "pairs"]].reset_index(drop=True)


def counted(claims: pd.DataFrame) -> str:
    """On a frame of `judge`: how many verdicts there are of each word, how many of them hold, how many sentences."""
    decided = claims["holds"].isin(["yes", "no"]).sum()
    once = sentences(claims)
    thesis = once[once["section"] != "ours"]
    return (
        f"Sentences of the thesis ({len(thesis)}): {_said(thesis)}. "
        f"Sentences of this project ({len(once) - len(thesis)}): {_said(once[once['section'] == 'ours'])}. "
        f"Verdicts, with {len(claims) - len(once)} that test a sentence elsewhere ({len(claims)}): {_said(claims)}. "
        f"Of the {decided} that are supported or contradicted, {(claims['holds'] == 'yes').sum()} hold among the "
        "claims of their chapter, at a false discovery rate of 5 %."
    )


def open_by_cause(claims: pd.DataFrame) -> str:
    """A sentence: of the open verdicts, how many there are of each of CAUSES."""
    found = _tally(claims.loc[claims["verdict"] == "open", "cause"], CAUSES)
    return f"Open verdicts by cause: {', '.join(f'{cause} {count}' for cause, count in found.items() if count)}."


def _said(frame: pd.DataFrame) -> str:
    return ", ".join(f"{count} {word}" for word, count in counts(frame).items() if count) or "none"


def _tally(column: pd.Series, words: tuple[str, ...] = WORDS) -> dict[str, int]:
    return {word: list(column).count(word) for word in words}
