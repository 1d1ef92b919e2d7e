"""The known answers of detectors: the examples in their docstrings."""

import doctest
import inspect

import pytest

from haptic_glance.look.points.detectors import SURFACE
from haptic_glance.look.points.methods import PUBLISHED

FUNCTIONS = {**SURFACE, **{name: rival.saliency for name, rival in PUBLISHED.items()}}


@pytest.mark.parametrize("name", [name for name, values in FUNCTIONS.items() if ">>>" in (values.__doc__ or "")])
def test_the_example_of_a_detector_gives_its_known_answer(name):
    values, failures = FUNCTIONS[name], []
    (example,) = doctest.DocTestFinder(recurse=False).find(
        values, name, inspect.getmodule(values), dict(vars(inspect.getmodule(values)))
    )
    doctest.DocTestRunner(optionflags=doctest.NORMALIZE_WHITESPACE).run(example, out=failures.append)
    assert not failures, "".join(failures)


@pytest.mark.parametrize("name", SURFACE)
def test_a_detector_of_one_function_has_an_example(name):
    assert ">>>" in (SURFACE[name].__doc__ or "")
