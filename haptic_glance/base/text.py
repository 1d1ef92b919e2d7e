"""Text files of numbers as people's programs write them: in UTF-8 or UTF-16, with points or commas before decimals."""

import codecs
import re

MARKS = {codecs.BOM_UTF16_LE: "utf-16", codecs.BOM_UTF16_BE: "utf-16", codecs.BOM_UTF8: "utf-8-sig"}
DECIMALS = re.compile(r"[-+]?\d*,\d+(e[-+]?\d+)?", re.IGNORECASE)
NUMBER = re.compile(r"\s*[-+]?(\d+([.,]\d*)?|[.,]\d+|nan|inf)(e[-+]?\d+)?(?=[\s,;]|$)", re.IGNORECASE)
SEEN = 100  # lines that show whether commas stand before decimals


def text_of(content: bytes) -> str:
    """The text in the bytes of a file: UTF-16 or UTF-8 as its byte order mark says, else UTF-8, else Latin-1."""
    encoding = next((encoding for mark, encoding in MARKS.items() if content.startswith(mark)), "utf-8")
    try:
        return content.decode(encoding)
    except UnicodeDecodeError:
        return content.decode("latin-1")


def lines_of(text: str) -> tuple[list[str], int, list[str]]:
    """(lines from the first on that begins with a number, lines before them, words of the last of these).

    Blanks separate the words of a line, also where the text has semicolons or commas. Commas stand before decimals
    instead, and become points, where each word has at most one of them, and none has a point.
    """
    lines = text.splitlines()
    first = next((i for i, line in enumerate(lines) if NUMBER.match(line)), len(lines))
    words = [word for line in lines[first : first + SEEN] for word in re.split(r"[;\s]+", line)]
    with_comma = [word for word in words if "," in word]
    has_decimals = all(map(DECIMALS.fullmatch, with_comma)) and not any("." in word for word in words)
    plain = text.replace(",", "." if has_decimals else " ").replace(";", " ").splitlines()
    header = next((line.split() for line in reversed(plain[:first]) if line.strip()), [])
    return plain[first:], first, header
