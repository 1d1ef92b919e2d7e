"""Nothing that a reader sees has the name that a program gives it: no `guided_ssim`, no lone backtick."""

import re
from pathlib import Path

import pytest
from matplotlib.text import Text

from stages.engine.settings import Workspace
from stages.report import Params, topics
from stages.report.claims_page import add_words
from stages.report.drawing import SETTINGS, plt
from stages.report.page import item_html
from stages.report.results import NotRun, Results

ROOT = Path(__file__).parents[2]
RAW = re.compile(r"\b[A-Za-z][A-Za-z0-9]*_\w+\b|\b(?:hks|knn|svm|dkl|qem|qslim|leifman|tasse|alexnet|vgg16|resnet50)\b")
NAMED = {"EWIGC_L4", "x86_64"}  # names of their own: the thesis's, and a processor's
OTHERS = ("scene", "stability")  # topics whose code names of perturbations and kernels stay for now
ITEMS = [
    pytest.param(topic, kind, name, id=f"{kind}/{name}")
    for topic in topics.TOPICS
    for kind, attribute in topics.KINDS.items()
    for name in getattr(topic, attribute)
    if not topic.__name__.endswith(OTHERS)
]


def said(html):
    """What a reader of a page sees of its HTML, without code and files, and what a blind reader hears."""
    text = re.sub(r"<(code|a|style|script)\b.*?</\1>", " ", html, flags=re.DOTALL)
    heard = re.findall(r'(?:aria-label|alt)="([^"]*)"', text)
    return " | ".join([re.sub(r"<[^>]*>", " | ", text), *heard])


def raw(text):
    """Names that stand there as a program has them, and lone backticks."""
    files = re.sub(r"\S+\.(?:csv|md|py|png|npz|json|yaml)\b|\S+/\S+", " ", text)
    return set(RAW.findall(files)) - NAMED | set(re.findall("`", text))


@pytest.mark.parametrize(("text", "found"), [
    ("<p>guided by SSIM</p>", set()), ("<td>guided_ssim_object</td>", {"guided_ssim_object"}),
    ("<td>hks</td>", {"hks"}),
    ("<p>see <code>accuracy_blocks</code> in table_4_1.csv and stages/salient_points</p>", set()),
    ('<svg aria-label="of thesis_ssim"><text>kNN</text></svg>', {"thesis_ssim"}), ("<p>`x</p>", {"`"}),
])  # fmt: skip
def test_raw_names_are_found(text, found):
    assert raw(said(text)) == found


@pytest.fixture(scope="module")
def measured(tmp_path_factory):
    """(the results of this repository, a folder to write to)."""
    workspace = Workspace(ROOT)
    return Results(workspace, workspace.settings(Params)), tmp_path_factory.mktemp("labels")


@pytest.mark.slow
@pytest.mark.parametrize(("topic", "kind", "name"), ITEMS)
def test_what_was_measured_is_shown_without_raw_names(measured, topic, kind, name):
    results, folder = measured
    with plt.rc_context(SETTINGS):
        try:
            item = getattr(topic, topics.KINDS[kind])[name](results)
        except NotRun as missing:
            pytest.skip(str(missing))
        add_words(item, topic, kind, name)
        drawn = [text.get_text() for text in item.drawing.findobj(Text)] if hasattr(item, "drawing") else []
        item.write(folder / kind)
    if not item.paths[0].exists():
        pytest.skip("it was drawn on another data set, and kept")
    assert raw(" | ".join(drawn)) == set()
    assert raw(said(item_html(item))) == set()
