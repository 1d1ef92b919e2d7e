"""Prints what a shell needs to complete commands and options: `haptic-glance completion bash`

Add it once: `haptic-glance completion bash >> ~/.bashrc`, or `zsh` and `~/.zshrc`, or
`haptic-glance completion fish > ~/.config/fish/completions/haptic-glance.fish`. Any other word is completed as a file.
"""

import argparse
import re
from collections.abc import Sequence
from importlib import import_module

from .arguments import command_parser

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


def parser() -> argparse.ArgumentParser:
    """The parser of the command line."""
    command = command_parser("completion", __doc__ or "")
    command.add_argument("shell", choices=["bash", "zsh", "fish"])
    return command


def run(argv: Sequence[str]) -> None:
    """Prints the script of a shell."""
    shell = parser().parse_args(argv).shell
    from haptic_glance.__main__ import COMMANDS

    options = {command: options_of(module) for command, module in COMMANDS.items()}
    print(fish(options) if shell == "fish" else (ZSH if shell == "zsh" else "") + bash(options), end="")


def options_of(module: str) -> list[str]:
    """The long options that the --help of a command's module lists."""
    text = import_module(module).parser().format_help()
    return sorted(set(re.findall(r"^  (?:-\w, )?(--[a-z-]+)", text, flags=re.MULTILINE)))


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
