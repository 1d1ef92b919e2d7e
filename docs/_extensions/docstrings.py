"""Makes reStructuredText of docstrings with `code` in single backticks; napoleon reads their sections afterwards."""

import inspect
import re
from collections.abc import Callable
from importlib import import_module

from numpy.typing import ArrayLike
from sphinx.application import Sphinx
from sphinx.util.typing import stringify_annotation

import haptic_glance

SPECIAL = re.compile(r"([*|])|(?<=\w)(_)(?!\w)")  # what would begin emphasis, a substitution or a reference
ARRAY_LIKE = stringify_annotation(ArrayLike, "smart")  # numpy's name stands for eight private types
CODE = re.compile(r"(`+[^`]+`+)")


def setup(app: Sphinx) -> dict[str, bool]:
    """Hooks into autodoc."""
    app.connect("autodoc-process-docstring", _process)
    app.connect("autodoc-process-signature", _short)
    app.connect("autodoc-skip-member", _skip)
    return {"parallel_read_safe": True, "parallel_write_safe": True}


def as_rst(lines: list[str], role: Callable[[str], str] = "``{}``".format) -> list[str]:
    """The lines of a docstring as reStructuredText; indented blocks after an empty line are code.

    role: what becomes of the text in backticks.
    """
    text = "\n".join(lines)
    blocks = re.split(r"(?:^|\n)((?:\n    .*)+)", text)
    return "".join(_code(part) if k % 2 else _prose(part, role) for k, part in enumerate(blocks)).splitlines()


def _prose(text, role):
    parts = CODE.split(text)
    return "".join(role(part.strip("`")) if k % 2 else SPECIAL.sub(r"\\\g<0>", part) for k, part in enumerate(parts))


def _code(block):
    return f"\n\n.. code-block:: text\n{block}\n" if ">" not in block and "=" not in block else f"\n\n::\n{block}\n"


def _process(app, what, name, obj, options, lines):
    if isinstance(obj, dict | tuple | int | str):  # else it would have the docstring of its type
        lines[:] = [_value_text(obj), ""]
        return
    text = as_rst(lines, lambda code: linked(code, getattr(obj, "__module__", None) or ""))
    lines[:] = [*with_bold_names(text, _parameters(obj)), ""]


def linked(code: str, module: str) -> str:
    """Code in a docstring of a module: a link where it is a public name of its package or of haptic_glance."""
    if code in haptic_glance.__all__:
        return f":py:obj:`~haptic_glance.{code}`"
    parts = module.split(".")
    for package in (".".join(parts[:k]) for k in range(len(parts) - 1, 1, -1) if code.isidentifier()):
        if code in getattr(import_module(package), "__all__", ()):
            return f":py:obj:`~{package}.{code}`"
    return f"``{code}``"


def with_bold_names(lines: list[str], names: list[str]) -> list[str]:
    """The lines with parameters in bold where a sentence begins with them: `faces: how many`, `rows, columns: of`."""
    name = "|".join(map(re.escape, sorted(names, key=len, reverse=True)))
    if not name:
        return lines
    begins = re.compile(rf"(?:(?<=^)|(?<=[.;:] )|(?<=\n))((?:{name})(?:(?:, | and )(?:{name}))*)(?=(?: \([^)]*\))?:)")
    return begins.sub(r"**\1**", "\n".join(lines)).splitlines()


def _value_text(obj):
    """A constant in words: a number or a text itself, of a dict or tuple its items by their names."""
    if isinstance(obj, int | str):
        return f"``{obj}``"
    if any(isinstance(item, tuple) for item in obj):
        return f"A {type(obj).__name__} of {len(obj)} tuples."
    return f"A {type(obj).__name__} of " + ", ".join(f"``{getattr(item, 'name', item)}``" for item in obj) + "."


def _parameters(obj):
    try:
        return list(inspect.signature(obj).parameters)
    except (TypeError, ValueError):
        return []


def _short(app, what, name, obj, options, signature, returns):
    """The signature and the result with numpy's own name of everything that becomes an array."""
    return tuple(text and text.replace(ARRAY_LIKE, "ArrayLike") for text in (signature, returns))


def _skip(app, what, name, obj, skip, options):
    """Fields of named tuples say nothing of themselves."""
    return True if type(obj).__name__ == "_tuplegetter" else None
