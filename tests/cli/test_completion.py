"""Shell completion: what is printed is what a shell then completes."""

import json
import shutil
import subprocess
from types import SimpleNamespace

import pytest

from haptic_glance.__main__ import MESH_COMMANDS, SHELL_COMMANDS
from haptic_glance.__main__ import run as run_command
from haptic_glance.cli import completion
from haptic_glance.cli.completion import OPTIONS, bash, fish, options_of, run

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


def test_the_options_are_those_that_help_lists(monkeypatch, capsys):
    def here(line, **_):
        with pytest.raises(SystemExit):
            run_command(line[-2], ["--help"])
        return SimpleNamespace(stdout=capsys.readouterr().out)

    monkeypatch.setattr(completion.subprocess, "run", here)
    kept = json.loads(OPTIONS.read_text())
    assert set(kept) == {*MESH_COMMANDS, *SHELL_COMMANDS} and {"--help", "--out", "--json", "--up"} <= set(
        kept["points"]
    )
    again = "python -c 'from haptic_glance.cli.completion import write_options; write_options()'"
    for command in ("points", "simplify", "touch", "saliency", "gallery"):
        assert options_of(command) == kept[command], f"{command} has other options now: {again}"
