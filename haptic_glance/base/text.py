"""Text files of numbers as people's programs write them: in UTF-8 or UTF-16, with points or commas before decimals."""

import codecs
import re

MARKS = {codecs.BOM_UTF16_LE: "utf-16", codecs.BOM_UTF16_BE: "utf-16", codecs.BOM_UTF8: "utf-8-sig"}
DECIMALS = re.compile(r"[-+]?\d*,\d+(e[-+]?\d+)?", re.IGNORECASE)
NUMBER = re.compile(r"[-+]?(\d+([.,]\d*)?|[.,]\d+|nan|inf)(e[-+]?\d+)?(?=[\s,;]|$)", re.IGNORECASE)
SEEN = 100  # lines that show whether commas stand before decimals


def text_of(content: bytes) -> str:
    """The text in the bytes of a file: UTF-16 or UTF-8 as its byte order mark says, else UTF-8, else Latin-1."""
    encoding = next((encoding for mark, encoding in MARKS.items() if content.startswith(mark)), "utf-8")
    try:
        return content.decode(encoding)
    except UnicodeDecodeError:
        return content.decode("latin-1")


def rows_of(text: str) -> tuple[list[tuple[int, list[str]]], list[str]]:
    """([(number of a line, its words)] from the first line on that begins with a number, words of the line before it).

    Blanks, semicolons and commas separate words. Commas stand before decimals instead where each word has at most one
    of them, and none has a point.
    """
    lines = [(number, line.strip()) for number, line in enumerate(text.splitlines(), 1) if line.strip()]
    first = next((i for i, (_, line) in enumerate(lines) if NUMBER.match(line)), len(lines))
    words = [word for _, line in lines[first : first + SEEN] for word in re.split(r"[;\s]+", line)]
    with_comma = [word for word in words if "," in word]
    has_decimals = all(map(DECIMALS.fullmatch, with_comma)) and not any("." in word for word in words)
    lines = [(number, line.replace(",", "." if has_decimals else " ").replace(";", " ")) for number, line in lines]
    header = lines[first - 1][1].split() if first else []
    return [(number, line.split()) for number, line in lines[first:]], header
