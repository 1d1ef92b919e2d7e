"""The topics of the report: each stands alone, and together they have each name of an output one time."""

import ast
from pathlib import Path

import pytest

from stages.report import topics

REPORT = Path(topics.__file__).parent
NAMES = sorted(path.parent.name for path in REPORT.glob("*/__init__.py"))


def imports(path):
    """(module, names) of each import from below the report, as absolute names; relative ones resolved."""
    package = f"stages.report.{path.parent.name}" if path.parent != REPORT else "stages.report"
    for node in ast.walk(ast.parse(path.read_text())):
        if isinstance(node, ast.ImportFrom):
            base = package.split(".")[: len(package.split(".")) - node.level + 1] if node.level else []
            yield ".".join([*base, *([node.module] if node.module else [])]), [alias.name for alias in node.names]
        elif isinstance(node, ast.Import):
            yield from ((alias.name, []) for alias in node.names)


def topics_of(path):
    """The topics that a file imports from."""
    found = set()
    for module, names in imports(path):
        for name in [module, *(f"{module}.{name}" for name in names)]:
            parts = name.split(".")
            if parts[:2] == ["stages", "report"] and len(parts) > 2:
                found.add(parts[2])
    return found & {*NAMES, "topics"}


@pytest.mark.parametrize("topic", NAMES)
def test_topics_do_not_import_each_other(topic):
    for path in (REPORT / topic).glob("*.py"):
        assert topics_of(path) <= {topic}, path


def test_shared_modules_import_no_topic():
    for path in REPORT.glob("*.py"):
        if path.name != "topics.py":
            assert topics_of(path) <= ({"topics"} if path.name in ("__init__.py", "__main__.py") else set()), path


def test_every_topic_is_in_the_reading_order_and_says_what_it_asks():
    assert sorted(topic.__name__.rpartition(".")[2] for topic in topics.TOPICS) == NAMES
    assert all(len(topic.__doc__) > 20 for topic in topics.TOPICS)


@pytest.mark.parametrize("kind", topics.KINDS.values())
def test_an_output_belongs_to_one_topic(kind):
    names = [name for topic in topics.TOPICS for name in getattr(topic, kind)]
    assert len(names) == len(set(names)) > 0


def test_the_report_is_all_that_its_topics_hold():
    counts = {kind: sum(len(getattr(topic, kind)) for topic in topics.TOPICS) for kind in topics.KINDS.values()}
    assert counts == {"TABLES": 61, "FIGURES": 50, "CHARTS": 20}
    assert len(topics.CLAIMS) == 481
