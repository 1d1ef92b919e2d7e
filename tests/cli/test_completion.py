"""Shell completion: what is printed is what a shell then completes."""

import json
import shutil
import subprocess

import pytest

from haptic_glance.__main__ import OWN, SHELL
from haptic_glance.base.timing import WallClock
from haptic_glance.cli.completion import OPTIONS, bash, fish, options_of, run

KNOWN = {"saliency": ["--count", "--out"], "gate": ["--update"]}


@pytest.mark.parametrize(
    ("words", "expected"),
    [
        (["ga"], ["gate"]),
        (["saliency", "--c"], ["--count"]),
        (["saliency", "--"], ["--count", "--out"]),
        (["gate", "--c"], []),
        (["saliency", "sc"], []),
    ],
)
def test_bash_completes_commands_and_options_and_leaves_files(words, expected):
    shell = shutil.which("bash")
    if not shell:
        pytest.skip("no bash")
    typed = f"COMP_WORDS=(haptic-glance {' '.join(words)}); COMP_CWORD={len(words)}"
    script = f'{bash(KNOWN)}{typed}; _haptic_glance; echo "${{COMPREPLY[@]}}"'
    ran = subprocess.run([shell, "-c", script], capture_output=True, text=True, check=True)
    assert ran.stdout.split() == expected


def test_fish_has_a_line_for_each_command_and_option():
    assert len(fish(KNOWN).splitlines()) == 2 + 3


@pytest.mark.slow
def test_the_options_are_those_that_help_lists():
    kept = json.loads(OPTIONS.read_text())
    assert {"--help", "--out", "--json", "--up"} <= set(kept["points"]) and set(kept) == {*OWN, *SHELL}
    again = "python -c 'from haptic_glance.cli.completion import write_options; write_options()'"
    for command in ("points", "simplify", "touch", "saliency", "studio"):
        assert options_of(command) == kept[command], f"{command} has other options now: {again}"


def test_the_script_is_printed_in_a_second(capsys):
    with WallClock() as watch:
        run(["bash"])
    assert watch.seconds < 1 and "--neighbourhood" in capsys.readouterr().out
