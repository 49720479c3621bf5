"""Man pages made from the command line: `python packaging/manual.py FOLDER` writes them."""

import argparse
import sys
from pathlib import Path

from vbraille.cli.commandtable import ACTIONS, COMMANDS, GROUPS
from vbraille.cli.parser import CommandParser
from vbraille.version import __version__


def _plain(text):
    """Words as roff takes them: no line is a request, and hyphens can be copied."""
    lines = text.replace("\\", "\\e").replace("-", "\\-").splitlines()
    return "\n".join(f"\\&{line}" if line[:1] in ".'" else line for line in lines)


def _heading(name, text):
    return [
        f'.TH "{name.upper()}" 1 "" "vbraille {__version__}" "vbraille"',
        ".SH NAME",
        f"{_plain(name)} \\- {_plain(text[0].lower() + text[1:].removesuffix('.'))}",
    ]


def _parser(words, command):
    """The parser of a command, with its options added."""
    parser = CommandParser(prog=" ".join(words), command=command)
    parser.complete()
    return parser


def _arguments(parser):
    for action in parser._actions:
        if action.help is argparse.SUPPRESS or isinstance(action, argparse._SubParsersAction):
            continue
        names = ", ".join(action.option_strings) or str(action.metavar or action.dest)
        value = ""
        if action.option_strings and action.nargs != 0:
            choices = "{" + ",".join(map(str, action.choices)) + "}" if action.choices else ""
            value = f" {action.metavar or choices or action.dest.upper()}"
        yield ".TP"
        yield f"\\fB{_plain(names)}\\fR{_plain(value)}"
        yield _plain((action.help or "").replace("%%", "%"))


def _positional(action):
    name = str(action.metavar or action.dest)
    return {"?": f"[{name}]", "*": f"[{name} ...]", "+": f"{name} [{name} ...]"}.get(
        action.nargs, name
    )


def _command_page(words, command):
    parser = _parser(words, command)
    given = [action for action in parser._actions if not action.option_strings]
    usage = [*words, "[options]", *(_positional(action) for action in given)]
    return [
        *_heading("-".join(words), command.does),
        ".SH SYNOPSIS",
        _plain(" ".join(usage)),
        ".SH DESCRIPTION",
        _plain(command.does),
        ".SH OPTIONS",
        *_arguments(parser),
        ".SH EXAMPLE",
        ".EX",
        _plain(command.example),
        ".EE",
        ".SH SEE ALSO",
        "\\fBvbraille\\fR(1)",
    ]


def pages():
    """Name and text of each page: of the program, its commands, and their actions."""
    about = "Read braille under one fingertip, on a page as large as you like."
    page = [*_heading("vbraille", about), ".SH SYNOPSIS", "vbraille COMMAND [options]"]
    for group, names in GROUPS.items():
        page.append(f".SH {group.upper()}")
        for name in names:
            page += [".TP", f"\\fBvbraille\\-{_plain(name)}\\fR(1)", _plain(COMMANDS[name].does)]
    page += [
        ".SH EXIT STATUS",
        "0 where all went well, 1 for a fault at run time, 2 for something that cannot be used; "
        "one sentence on standard error says what to do.",
        ".SH ENVIRONMENT",
        "Settings are in \\fIvbraille/settings.toml\\fR under \\fB$XDG_CONFIG_HOME\\fR; "
        "\\fBvbraille settings\\fR says where.",
    ]
    yield "vbraille.1", "\n".join(page) + "\n"
    for name, command in COMMANDS.items():
        if name not in ACTIONS:
            yield f"vbraille-{name}.1", "\n".join(_command_page(("vbraille", name), command)) + "\n"
            continue
        made = [*_heading(f"vbraille-{name}", command.does), ".SH ACTIONS"]
        for action, each in ACTIONS[name].items():
            words = ("vbraille", name, action)
            made += [".TP", f"\\fBvbraille\\-{name}\\-{action}\\fR(1)", _plain(each.does)]
            yield f"{'-'.join(words)}.1", "\n".join(_command_page(words, each)) + "\n"
        yield f"vbraille-{name}.1", "\n".join(made) + "\n"


if __name__ == "__main__":
    folder = Path(sys.argv[1])
    folder.mkdir(parents=True, exist_ok=True)
    for page, text in pages():
        (folder / page).write_text(text, encoding="utf-8")
