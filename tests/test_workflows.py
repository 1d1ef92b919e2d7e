"""The workflows: what may be published, from where, and by which job."""

from pathlib import Path

import pytest
import yaml

ROOT = Path(__file__).parents[1]
FOLDER = ROOT / ".github/workflows"


def workflow(name):
    """(jobs, triggers, permissions) of a workflow; YAML 1.1 reads the key `on` as true."""
    content = yaml.safe_load((FOLDER / f"{name}.yml").read_text(encoding="utf-8"))
    return content["jobs"], content[True], content["permissions"]


@pytest.mark.parametrize("name", [path.stem for path in sorted(FOLDER.glob("*.yml"))])
def test_only_jobs_that_publish_may_write(name):
    jobs, _, permissions = workflow(name)
    assert permissions == {"contents": "read"}
    writing = {job for job, content in jobs.items() if "write" in content.get("permissions", {}).values()}
    assert writing <= {"deploy", "publish"}


def test_a_release_is_a_tag_and_publishes_what_was_checked():
    jobs, triggers, _ = workflow("release")
    assert triggers == {"push": {"tags": ["v*"]}}
    publish, lines = jobs["publish"], "\n".join(step.get("run", "") for step in jobs["build"]["steps"])
    assert publish["needs"] == "build" and publish["environment"] == "pypi"
    assert publish["permissions"] == {"id-token": "write"} and "password" not in str(publish)
    order = [lines.index(command) for command in ("GITHUB_REF_NAME", "-m build", "twine check --strict", "demo")]
    assert order == sorted(order)


def test_pages_have_the_site_and_below_it_the_documentation():
    jobs, triggers, _ = workflow("pages")
    assert triggers["push"] == {"branches": ["main"]} and jobs["deploy"]["needs"] == "build"
    steps = jobs["build"]["steps"]
    lines = "\n".join(step.get("run", "") for step in steps)
    assert lines.index("make repro") < lines.index("make docs") < lines.index("cp -r build/docs build/pages/docs")
    assert steps[-1]["with"]["path"] == "build/pages"


@pytest.mark.parametrize("name", ["pages", "release"])
def test_workflows_run_targets_and_commands_that_are_there(name):
    jobs, _, _ = workflow(name)
    lines = "\n".join(step.get("run", "") for job in jobs.values() for step in job["steps"])
    makefile = (ROOT / "Makefile").read_text(encoding="utf-8")
    targets = [line.split()[1] for line in lines.splitlines() if line.startswith("make ")]
    assert all(f"\n{target}:" in makefile for target in targets)
    assert ("haptic-glance demo" in lines) == (name == "release")
