"""Prints what a shell needs to complete commands and options: `haptic-glance completion bash`

Add it once: `haptic-glance completion bash >> ~/.bashrc`, or `zsh` and `~/.zshrc`, or
`haptic-glance completion fish > ~/.config/fish/completions/haptic-glance.fish`. Any other word is completed as a file.
"""

import argparse
import json
import re
import subprocess
import sys
from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

OPTIONS = Path(__file__).with_name("options.json")  # {command: its long options}, of `write_options`
BASH = """\
_haptic_glance() {{
  local word=${{COMP_WORDS[COMP_CWORD]}}
  if [ "$COMP_CWORD" = 1 ]; then COMPREPLY=($(compgen -W "{commands}" -- "$word")); return; fi
  case $word in -*) case ${{COMP_WORDS[1]}} in
{cases}
  esac ;; esac
}}
complete -o default -F _haptic_glance haptic-glance
"""
CASE = '    {command}) COMPREPLY=($(compgen -W "{options}" -- "$word")) ;;'
ZSH = "autoload -Uz compinit bashcompinit && compinit && bashcompinit\n"
FISH_COMMAND = "complete -c haptic-glance -n __fish_use_subcommand -f -a {command}"
FISH_OPTION = "complete -c haptic-glance -n '__fish_seen_subcommand_from {command}' -l {option}"


def run(argv: Sequence[str]) -> None:
    """Prints the script of a shell."""
    parser = argparse.ArgumentParser(
        prog="haptic-glance completion", description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("shell", choices=["bash", "zsh", "fish"])
    shell = parser.parse_args(argv).shell
    from haptic_glance.__main__ import COMMANDS

    option_table = json.loads(OPTIONS.read_text())
    options = {command: option_table.get(command, []) for command in COMMANDS}
    print(fish(options) if shell == "fish" else (ZSH if shell == "zsh" else "") + bash(options), end="")


def options_of(command: str) -> list[str]:
    """The long options that the --help of a command lists; none where it needs an extra that is not installed."""
    process = subprocess.run([sys.executable, "-m", "haptic_glance", command, "--help"], capture_output=True, text=True)
    return sorted(set(re.findall(r"^  (?:-\w, )?(--[a-z-]+)", process.stdout, flags=re.MULTILINE)))


def write_options() -> None:
    """Asks every command for its --help, half a minute, and keeps the options; a test says when that is due."""
    from haptic_glance.__main__ import COMMANDS

    with ThreadPoolExecutor() as pool:
        options = dict(zip(COMMANDS, pool.map(options_of, COMMANDS), strict=True))
    OPTIONS.write_text(json.dumps(options, indent=1) + "\n")


def bash(options: dict[str, list[str]]) -> str:
    """The script of bash, which zsh reads as well. options: {command: its options}."""
    cases = "\n".join(CASE.format(command=name, options=" ".join(flags)) for name, flags in options.items())
    return BASH.format(commands=" ".join(options), cases=cases)


def fish(options: dict[str, list[str]]) -> str:
    """The script of fish. options: {command: its options}."""
    lines = [FISH_COMMAND.format(command=name) for name in options]
    pairs = ((name, option) for name, flags in options.items() for option in flags)
    lines += [FISH_OPTION.format(command=name, option=option.removeprefix("--")) for name, option in pairs]
    return "\n".join([*lines, ""])
