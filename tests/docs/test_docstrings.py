"""Docstrings of the public names: numpydoc sections that agree with the signature, and examples that run."""

import doctest
import inspect
import re

import pytest

import haptic_glance
from haptic_glance import know
from haptic_glance.lod import scene

MEMBERS = {name: getattr(module, name) for module in (scene, know, haptic_glance) for name in module.__all__}
PUBLIC = {name: MEMBERS[name] for name in haptic_glance.__all__}
FUNCTIONS = {
    name: member
    for name, member in MEMBERS.items()
    if inspect.isfunction(member) and (name in PUBLIC or "Parameters\n" in (member.__doc__ or ""))
}
EXAMPLES = [name for name, member in MEMBERS.items() if callable(member) and ">>>" in (member.__doc__ or "")]


def sections(member):
    """{title: lines} of a docstring."""
    parts = re.split(r"^(\w[\w ]*)\n-+$", inspect.getdoc(member), flags=re.MULTILINE)
    return dict(zip(parts[1::2], parts[2::2], strict=True))


@pytest.mark.parametrize("name", FUNCTIONS)
def test_a_public_function_documents_its_parameters_and_result(name):
    function = FUNCTIONS[name]
    signature, parts = inspect.signature(function), sections(function)
    heads = [line for line in parts["Parameters"].splitlines() if line and not line.startswith(" ")]
    documented = [part.strip() for head in heads for part in head.partition(" : ")[0].split(",")]
    assert sorted(part.lstrip("*") for part in documented) == sorted(signature.parameters)
    assert ("Returns" in parts) == (signature.return_annotation not in (None, "None"))


@pytest.mark.parametrize("name", EXAMPLES)
def test_the_example_of_a_public_name_runs(name, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    member, failures = inspect.unwrap(MEMBERS[name]), []
    finder = doctest.DocTestFinder(recurse=False)
    (example,) = finder.find(member, name, module=inspect.getmodule(member), globs={})
    doctest.DocTestRunner(optionflags=doctest.NORMALIZE_WHITESPACE).run(example, out=failures.append)
    assert not failures, "".join(failures)
