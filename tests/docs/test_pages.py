"""The pages of the documentation: figures from tables, links, pictures, commands and API names that exist."""

import json
import re
from importlib.util import find_spec
from pathlib import Path

import pytest

pytest.importorskip("sphinx")
yaml = pytest.importorskip("yaml")

from _extensions.commands import DEFAULT, commands  # noqa: E402
from _extensions.measured import REPORTS, measured  # noqa: E402

import haptic_glance  # noqa: E402
from haptic_glance.__main__ import MESH_COMMANDS  # noqa: E402
from stages.charts.cells import rows_of  # noqa: E402

ROOT = Path(__file__).parents[2]
CLAIMS = rows_of(REPORTS / "claims.csv")
DOCS = ROOT / "docs"
PAGES = sorted(path for path in DOCS.rglob("*.md") if "generated" not in path.parts)
SOURCES = PAGES + sorted(path for path in DOCS.rglob("*.py") if "generated" not in path.parts)
MEASURED = re.compile(r"\{measured\}`([^`]+)`")
NAME = re.compile(r"(?:`~?|\.\. auto\w+:: )((?:haptic_glance|stages)(?:\.\w+)+)[`\n]")


def name(path):
    return str(path.relative_to(DOCS))


def text_of(path):
    return path.read_text(encoding="utf-8")


def test_every_figure_is_in_its_table():
    for path in PAGES:
        for query in MEASURED.findall(text_of(path)):
            assert re.search(r"\d", measured(" ".join(query.split()))), query


def test_every_claim_that_a_page_lists_is_one():
    keys = {*CLAIMS["key"]}
    listed = re.findall(r"```\{claims\} (.+)", "\n".join(map(text_of, PAGES)))
    assert len(listed) >= 9
    assert not {key for line in listed for key in line.split(", ")} - keys


def test_every_link_and_picture_leads_to_a_file_and_pictures_have_an_alternative_text():
    for path in PAGES:
        text = text_of(path)
        links = re.findall(r"\]\((?!https?:|#)([^)\s]+)\)", text) + re.findall(r"```\{figure\} (\S+)", text)
        files = {link.partition("#")[0] for link in links}  # of anchors, Sphinx warns
        absent = [file for file in files if not (path.parent / file).exists() and "generated/" not in file]
        assert not absent, path
        figures = re.findall(r"```\{figure\} \S+\n(.*?)```", text, re.S)
        assert all(re.match(r":alt: .{20,}", figure) for figure in figures), path


def test_every_path_that_a_text_names_exists():
    folders = "|".join(entry.name for entry in ROOT.iterdir() if entry.is_dir() and entry.name[0] != ".")
    for path in [ROOT / "CONTRIBUTING.md", *SOURCES]:
        named = set(re.findall(rf"`((?:{folders})/[\w./-]+)`", text_of(path)))
        made = {x for x in named if re.search(r"[A-Z]{3}|^build/|^runs/|^reports/index.html$", x)}  # or for example
        assert not [entry for entry in named - made if not (ROOT / entry).exists()], path


def test_the_api_lists_every_name_of_the_core():
    listed = re.findall(r"^   (\w+)$", text_of(DOCS / "api/haptic_glance.rst"), re.M)
    assert sorted(listed) == sorted(haptic_glance.__all__)


def test_the_api_lists_every_name_of_a_package():
    from importlib import import_module

    for path in sorted((DOCS / "api").glob("*.rst")):
        if path.stem in ("haptic_glance", "disturb", "deep"):  # of deep, the page shows the hybrid network alone
            continue
        text = text_of(path)
        package = import_module(re.search(r"automodule:: (\S+)", text)[1])
        absent = [member for member in package.__all__ if not re.search(rf"\b{member}\b", text)]
        assert not absent, f"{name(path)} lacks {', '.join(absent)}"
        shown = ", ".join(re.findall(r":members: (.+)", text)).split(", ")
        unknown = [member for member in filter(None, shown) if member not in package.__all__]
        assert not unknown, f"{name(path)} names {', '.join(unknown)}, which {package.__name__} lacks"


@pytest.mark.slow
def test_every_name_that_a_page_mentions_exists():
    import pkgutil

    names = {match for path in [*SOURCES, *DOCS.glob("api/*.rst")] for match in NAME.findall(text_of(path))}
    assert len(names) > 20
    for dotted in sorted(names):
        pkgutil.resolve_name(dotted)


def test_every_command_that_a_page_shows_exists():
    text = "\n".join(map(text_of, SOURCES))
    shown = set(re.findall(r"^#?\s*haptic-glance (\w+)", text, re.M)) - {"contributors"}
    assert {"saliency", "simplify", "touch"} <= shown <= {*MESH_COMMANDS}
    assert all(find_spec(f"stages.{name}") for name in re.findall(r"python -m stages\.([\w.]*\w)", text))
    experiments = set(re.findall(r"experiment=(\w+)", text))
    assert experiments and all(
        (ROOT / "conf/experiment" / f"{experiment}.yaml").is_file() for experiment in experiments
    )


@pytest.mark.slow
def test_every_claim_has_a_command_and_a_command_has_minutes():
    listed = commands()
    keys = [claim["key"] for command in listed for claim in command.claims]
    assert len(keys) == len(set(keys)) and {*CLAIMS.loc[CLAIMS["low"] != "", "key"]} <= set(keys)
    assert listed[0].text == DEFAULT and all(command.minutes > 0 for command in listed)


@pytest.mark.parametrize(
    "asked",
    ["claims key=no_such_claim: effect", "claims: effect", "claims key=keep_metro: gone", "claims key=keep_metro"],
)
def test_a_figure_without_one_cell_is_an_error(asked):
    with pytest.raises(LookupError):
        measured(asked)


def test_figures_are_shown_as_asked():
    (row,) = CLAIMS[CLAIMS["key"] == "keep_metro"].to_dict("records")
    assert measured("claims key=keep_metro: effect .3f") == f"{float(row['effect']):.3f}"
    low, high = sorted((float(row["low"]), float(row["high"])))
    assert measured("claims key=keep_metro: effect low high .1f").endswith(f"[{low:.1f}, {high:.1f}]")
    assert measured("claims key=keep_metro: effect high low .1f").endswith(f"[{low:.1f}, {high:.1f}]")
    assert measured("claims key=keep_metro: 100*effect .0f") == f"{100 * float(row['effect']):,.0f}"
    seconds = [*map(float, rows_of(REPORTS / "bench/tactile.csv", "what=build")["seconds"])]
    assert measured("bench/tactile what=build: count:seconds") == str(len(seconds))
    assert measured("bench/tactile what=build: most:seconds .6f") == f"{max(seconds):.6f}"


def test_citation_and_deposit_say_the_same_as_the_package():
    import tomllib

    project = tomllib.loads(text_of(ROOT / "pyproject.toml"))["project"]
    citation = yaml.safe_load(text_of(ROOT / "CITATION.cff"))
    deposit = json.loads(text_of(ROOT / ".zenodo.json"))
    assert citation["cff-version"] == "1.2.0" and {"message", "authors", "title"} <= citation.keys()
    assert project["version"] == citation["version"] == deposit["version"]
    assert citation["title"] == deposit["title"] and citation["keywords"] == deposit["keywords"]
    assert citation["abstract"] == deposit["description"] and citation["license"] == deposit["license"] == "MIT"
