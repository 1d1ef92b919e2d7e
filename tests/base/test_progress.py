"""A command that works for long says so; one that reports nothing stays silent."""

import io
import time
import warnings

import pytest
from PIL import Image

from haptic_glance import __main__
from haptic_glance.base import progress


@pytest.fixture
def hasty(monkeypatch):
    monkeypatch.setattr(progress, "PAUSE", 0.05)


@pytest.mark.slow
def test_a_long_step_says_that_it_still_goes_on(hasty, capsys):
    with progress.no_silence():
        progress.report("touch", "reading")
        time.sleep(0.5)
    lines = capsys.readouterr().err.splitlines()
    assert lines[0] == "touch: reading" and lines[1] == "touch: still working, 0 s" and len(lines) > 2
    time.sleep(0.2)
    assert capsys.readouterr().err == ""  # the block has ended


@pytest.mark.slow
def test_each_command_runs_with_such_lines(hasty, capsys, monkeypatch):
    def work(argv):
        progress.report("saliency", "looking at it")
        time.sleep(0.5)

    monkeypatch.setattr("haptic_glance.cli.saliency.run", work)
    monkeypatch.setattr("haptic_glance.base.errors.errors_in_one_line", lambda name: None)
    assert __main__.run("saliency", []) == 0
    assert "saliency: still working" in capsys.readouterr().err


def test_no_command_prints_a_warning_of_large_pictures(monkeypatch):
    picture = io.BytesIO()
    Image.new("L", (6, 4)).save(picture, "PNG")
    monkeypatch.setattr(Image, "MAX_IMAGE_PIXELS", 20)
    monkeypatch.setattr("haptic_glance.cli.saliency.run", lambda argv: Image.open(picture).close())
    monkeypatch.setattr("haptic_glance.base.errors.errors_in_one_line", lambda name: None)
    with warnings.catch_warnings(record=True) as seen:
        __main__.run("saliency", [])
    assert seen == []
