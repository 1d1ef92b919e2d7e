"""Shell completion: what is printed is what a shell then completes."""

import shutil
import subprocess

import pytest

from haptic_glance.__main__ import COMMANDS
from haptic_glance.cli.completion import bash, fish, options_of, run

KNOWN = {"saliency": ["--count", "--out"], "gate": ["--update"]}
TYPED = {"ga": "gate", "saliency --c": "--count", "saliency --": "--count --out", "gate --c": "", "saliency sc": ""}


@pytest.mark.skipif(not shutil.which("bash"), reason="no bash")
def test_bash_completes_commands_and_options_and_leaves_files():
    for words, expected in TYPED.items():
        typed = f"COMP_WORDS=(haptic-glance {words}); COMP_CWORD={len(words.split())}"
        script = f'{bash(KNOWN)}{typed}; _haptic_glance; echo "${{COMPREPLY[@]}}"'
        process = subprocess.run(["bash", "-c", script], capture_output=True, text=True, check=True)
        assert process.stdout.strip() == expected


def test_fish_has_a_line_for_each_command_and_option(capsys):
    assert len(fish(KNOWN).splitlines()) == 2 + 3
    run(["bash"])
    assert "--neighbourhood" in capsys.readouterr().out


@pytest.mark.parametrize("command", COMMANDS)
def test_every_command_has_a_parser_with_its_options(command):
    assert "--help" in options_of(COMMANDS[command])
    assert command in ("studio", "completion") or "--json" in options_of(COMMANDS[command])
