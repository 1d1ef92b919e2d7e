"""Shell completion: what is printed is what a shell then completes."""

import shutil
import subprocess

import pytest

from haptic_glance.cli.completion import bash, fish, run

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
