"""symsurf completion: what shells complete, from the parsers of the commands."""

from __future__ import annotations

import argparse
import re
from collections.abc import Callable, Iterable, Mapping

from .._core import InvalidParameter, methods
from .terminal import Parser, say

_WHERE = """where it goes:
bash: source <(symsurf completion bash), in ~/.bashrc
zsh:  source <(symsurf completion zsh), in ~/.zshrc behind compinit
fish: symsurf completion fish > ~/.config/fish/completions/symsurf.fish"""

_BASH = """\
_symsurf() {
  local word=${COMP_WORDS[COMP_CWORD]} before=${COMP_WORDS[COMP_CWORD-1]} words=
  if ((COMP_CWORD == 1)); then
    words="%(commands)s"
  else
    case "${COMP_WORDS[1]} $before" in
%(cases)s
    esac
  fi
  COMPREPLY=($(compgen -W "$words" -- "$word"))
}
complete -o default -F _symsurf symsurf"""


class CompletionCommand:
    """What symsurf.cli takes for a command."""

    SUMMARY = "Prints a script by which bash, zsh or fish completes commands, options and values."

    def __init__(self, parsers: Callable[[], Iterable[Parser]]) -> None:
        """Given what gives those of all commands."""
        self._parsers = parsers

    def add_arguments(self, parser: argparse.ArgumentParser) -> None:
        parser.add_argument("shell", metavar="SHELL", help="bash, zsh or fish")
        parser.epilog = _WHERE

    def run(self, arguments: argparse.Namespace) -> int:
        scripts = {"bash": _bash, "zsh": _zsh, "fish": _fish}
        if arguments.shell not in scripts:
            raise InvalidParameter(f"shell is {arguments.shell}; allowed are {', '.join(scripts)}")
        parsers = {parser.prog.split()[-1]: parser for parser in self._parsers()}
        say(scripts[arguments.shell](parsers))
        return 0


def _options(parser: Parser) -> dict[str, argparse.Action]:
    """The options, of two spellings that with dashes."""
    return {
        option: action
        for option, action in parser._option_string_actions.items()
        if "_" not in option
    }


def _values(action: argparse.Action) -> list[str]:
    """Those of a choice, which stand in its metavar, and the methods."""
    if "--method" in action.option_strings:
        return list(methods())
    metavar = action.metavar if isinstance(action.metavar, str) else ""
    return metavar[1:-1].split(",") if re.fullmatch(r"\{.*\}", metavar) else []


def _kinds(parser: Parser) -> list[str]:
    """The words that may come first, such as "spherical" of ``generate``."""
    first = next((each for each in parser._get_positional_actions() if each.choices), None)
    return [str(choice) for choice in (first.choices or ())] if first else []


def _bash(parsers: Mapping[str, Parser]) -> str:
    cases: dict[str, list[str]] = {}
    for name, parser in parsers.items():
        options = _options(parser)
        cases |= {f'"{name} {option}"': _values(action) for option, action in options.items()}
        cases[f'"{name} "*'] = [*_kinds(parser), *options]
    lines = [
        f'      {case}) words="{" ".join(words)}" ;;' for case, words in cases.items() if words
    ]
    return _BASH % {"commands": " ".join(parsers), "cases": "\n".join(lines)}


def _zsh(parsers: Mapping[str, Parser]) -> str:
    """zsh runs bash's."""
    return f"autoload -U +X bashcompinit && bashcompinit\n{_bash(parsers)}"


def _fish(parsers: Mapping[str, Parser]) -> str:
    lines = []
    for name, parser in parsers.items():
        about = _quoted((parser.description or "").partition("\n\n")[0].replace("\n", " "))
        lines.append(f"complete -c symsurf -n __fish_use_subcommand -a {name} -d {about}")
        own = f"complete -c symsurf -n '__fish_seen_subcommand_from {name}'"
        if kinds := _kinds(parser):
            lines.append(f"{own} -a '{' '.join(kinds)}'")
        for option, action in _options(parser).items():
            dash, word = ("-l", option[2:]) if option.startswith("--") else ("-s", option[1:])
            about = _quoted((action.help or "").replace("%%", "%").split(";")[0][:60])
            values = _values(action)
            taken = f" -x -a '{' '.join(values)}'" if values else " -r" * (action.nargs != 0)
            lines.append(f"{own} {dash} {word}{taken} -d {about}")
    return "\n".join(lines)


def _quoted(text: str) -> str:
    return "'" + text.replace("\\", "\\\\").replace("'", "\\'") + "'"
