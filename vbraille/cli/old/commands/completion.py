"""``vbraille completion``: scripts for shells, and what they ask the program at each Tab."""

from __future__ import annotations

from typing import TYPE_CHECKING

from vbraille.cli.old.commandtable import ACTIONS, COMMANDS
from vbraille.cli.old.parser import CommandParser
from vbraille.cli.old.terminal import say_line

if TYPE_CHECKING:
    import argparse
    from collections.abc import Iterable, Sequence

    from vbraille.cli.old.commandtable import CommandRow

# Each falls back on the names of files where the program names nothing.
_SCRIPTS = {
    "bash": """\
_vbraille() {
    local IFS=$'\\n' line=${COMP_LINE:0:COMP_POINT}
    local -a words
    IFS=' ' read -ra words <<< "$line"
    [[ $line == *' ' ]] && words+=('')
    local current=${words[-1]}
    local found=$(vbraille completion words "${words[@]:1}" 2>/dev/null)
    COMPREPLY=($(compgen -W "$found" -- "$current"))
    # The shell takes a colon for the beginning of a word.
    [[ $current == *:* ]] && COMPREPLY=("${COMPREPLY[@]#"${current%"${current##*:}"}"}")
}
complete -o default -F _vbraille vbraille
""",
    "zsh": """\
#compdef vbraille
_vbraille() {
    local -a found
    found=(${(f)"$(vbraille completion words "${(@)words[2,CURRENT]}" 2>/dev/null)"})
    if (( $#found )); then compadd -- $found; else _files; fi
}
# As a file of $fpath it is loaded at the first Tab, and completes it at once.
if [[ $funcstack[1] == _vbraille ]]; then _vbraille "$@"; else compdef _vbraille vbraille; fi
""",
    "fish": """\
function __vbraille
    vbraille completion words (commandline -opc)[2..] (commandline -ct) 2>/dev/null
end
complete -c vbraille -a '(__vbraille)'
""",
}


def run(arguments: argparse.Namespace) -> int:
    """Print a script, or the words that may stand in the place of the last of a line."""
    if arguments.shell == "words":
        for word in candidates(arguments.words):
            say_line(word)
    else:
        print(_SCRIPTS[arguments.shell], end="")
    return 0


def candidates(words: Sequence[str]) -> list[str]:
    """Words that begin as the last of a line does, and may stand in its place.

    Parameters
    ----------
    words
        Words of the line after the program's name; the last is what is completed, perhaps empty.

    >>> candidates(["sess"])
    ['session']
    >>> candidates(["read", "--echo", "b"])
    ['both']
    """
    *before, begun = words or [""]
    return [word for word in _possible(before, begun) if word.startswith(begun)]


def _possible(before: Sequence[str], begun: str) -> Iterable[str]:
    names, rest = COMMANDS, list(before)
    while rest and rest[0] in names:
        name = rest.pop(0)
        if name not in ACTIONS:
            return _of_command(names[name], rest, begun)
        names = ACTIONS[name]
    return () if rest else names


def _of_command(command: CommandRow, before: Sequence[str], begun: str) -> Iterable[str]:
    """Values of the option before, or options, or values of what stands without one."""
    parser = CommandParser(command=command)
    parser.complete()
    options = {name: action for action in parser._actions for name in action.option_strings}
    option = options.get(before[-1]) if before else None
    if option is not None and option.nargs != 0:
        return _values(option)
    if begun.startswith("-"):
        return options
    arguments = (action for action in parser._actions if not action.option_strings)
    return [value for argument in arguments for value in _values(argument)]


def _values(action: argparse.Action) -> Iterable[str]:
    """Values that the program knows of an option or argument; none for a file or a number."""
    if action.choices is not None:
        return map(str, action.choices)
    match action.metavar:
        case "PROTOCOL":
            from vbraille.sessions.planning.protocolfiles import builtin_names

            return builtin_names()
        case "SPEC":
            from importlib.metadata import entry_points

            from vbraille.devices.registry import GROUP

            kinds = entry_points(group=GROUP).names
            return [kind if kind == "sim" else f"{kind}:" for kind in kinds]
        case _ if action.dest == "table":
            from vbraille.translate import list_tables

            return [table.name for table in list_tables()]
        case _:
            return ()
