"""Shell completion: what is printed is what a shell then completes."""

import shutil
import subprocess

import pytest

from haptic_glance.completion import bash, fish, options_of

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
    assert {"--help", "--out", "--json", "--up"} <= set(options_of("points"))
    assert options_of("nothing-of-this-name") == []
