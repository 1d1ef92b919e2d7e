"""The text of OBJ files as people write it, in the form that the parser reads."""

import codecs
import re

NUMBERED = [b"v"], [b"vt"], [b"vn"], [b"f"]  # the first words of lines of numbers


def plain(content: bytes) -> bytes:
    """An OBJ's bytes without a byte-order mark, tabs, and comments behind numbers."""
    content = content.removeprefix(codecs.BOM_UTF8)  # the parser would miss the first vertex
    content = content.replace(b"\t", b" ") if b"\t" in content else content

    def cut(comment: re.Match[bytes]) -> bytes:
        start = content.rfind(b"\n", 0, comment.start()) + 1
        return b"" if content[start : comment.start()].split(None, 1)[:1] in NUMBERED else comment[0]

    return re.sub(rb"#[^\n]*", cut, content) if b"#" in content else content
