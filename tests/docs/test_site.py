"""The site as a whole: it builds without a warning, and asks nothing of a network."""

import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

pytest.importorskip("sphinx_gallery")
pytest.importorskip("pydata_sphinx_theme")
pytest.importorskip("torch", reason="the API has the hybrid network")

pytestmark = pytest.mark.slow

ROOT = Path(__file__).parents[2]
FETCHED = re.compile(
    r"<(?:script|img|iframe|source)[^>]*src=\"(https?:|//)|<link[^>]*href=\"(https?:|//)|url\((https?:|//)"
)


@pytest.fixture(scope="module")
def site(tmp_path_factory):
    """The built pages; the scripts of the gallery are shown and not run, which tests/docs/test_scripts.py does."""
    copy = tmp_path_factory.mktemp("site")
    shutil.copytree(ROOT / "docs", copy / "docs", ignore=shutil.ignore_patterns("generated", "__pycache__"))
    for name in ("reports", "conf", "params.yaml"):
        (copy / name).symlink_to(ROOT / name)
    command = [sys.executable, "-m", "sphinx", "-W", "--keep-going", "-q", "-D", "plot_gallery=0", "docs", "built"]
    process = subprocess.run(command, cwd=copy, capture_output=True, text=True)
    assert process.returncode == 0, process.stderr[-3000:]
    return copy / "built"


def test_it_builds_without_a_warning_has_its_pages_and_fetches_nothing(site):
    pages = {str(path.relative_to(site)) for path in site.rglob("*.html")}
    assert {"index.html", "first_steps.html", "concepts/attention.html", "api/lod.html", "artifact.html"} <= pages
    assert "generated/api/haptic_glance.simplify.html" in pages and len(pages) > 80
    files = [*site.rglob("*.html"), *site.rglob("*.css")]
    assert not [path.name for path in files if FETCHED.search(path.read_text(encoding="utf-8"))]


def test_formulas_figures_and_verdicts_are_in_the_pages(site):
    attention = (site / "concepts/attention.html").read_text(encoding="utf-8")
    assert "<math" in attention and "verdict-supported" in attention and 'title="reports/claims' in attention
    simplify = (site / "generated/api/haptic_glance.simplify.html").read_text(encoding="utf-8")
    assert "<strong>keep</strong>" in simplify and "Examples" in simplify
    forces = (site / "generated/api/haptic_glance.press_forces.html").read_text(encoding="utf-8")
    assert "ArrayLike" in forces and "_NestedSequence" not in forces
    assert "Create a new string object" not in (site / "api/know.html").read_text(encoding="utf-8")


def test_every_link_within_the_site_leads_to_a_page(site):
    broken = []
    for path in site.rglob("*.html"):
        for link in re.findall(r'href="([^"#:]+\.html)(?:#[^"]*)?"', path.read_text(encoding="utf-8")):
            if not (path.parent / link).exists():
                broken.append(f"{path.name}: {link}")
    assert not broken
