"""What the documentation makes of docstrings and formulas."""

import pytest

pytest.importorskip("sphinx")

from _extensions.docstrings import as_rst, linked
from docutils.core import publish_string


def html(lines):
    settings = {"output_encoding": "unicode", "halt_level": 2, "embed_stylesheet": False}
    return publish_string("\n".join(lines), writer="html5", settings_overrides=settings)


def test_backticks_become_code_even_over_the_end_of_a_line():
    assert as_rst(["Gives `a`, and `b", "c` too."]) == ["Gives ``a``, and ``b", "c`` too."]


@pytest.mark.parametrize(
    "text", ["1 + STRENGTH * saliency * 2", "|O(c) - O(s)| is zero", "names such as best_ or keys_"]
)
def test_special_characters_stay_as_they_are(text):
    assert text in html(as_rst([text]))


def test_an_indented_block_is_code():
    shown = html(as_rst(["For example:", "", "    mesh = load(path)", "    print(mesh)", "", "Done."]))
    assert "<pre" in shown and "mesh = load(path)" in shown and "<blockquote" not in shown


@pytest.mark.parametrize(
    "code, module, shown",
    [
        ("simplify", "haptic_glance.lod.export", ":py:obj:`~haptic_glance.simplify`"),
        ("quadric_weights", "haptic_glance.lod.simplify", ":py:obj:`~haptic_glance.lod.quadric_weights`"),
        ("quadric_weights", "haptic_glance.look.views.view", "``quadric_weights``"),
        ("faces > 4", "haptic_glance.lod.simplify", "``faces > 4``"),
        ("faces", "", "``faces``"),
    ],
)
def test_code_that_is_a_public_name_is_a_link(code, module, shown):
    assert linked(code, module) == shown
