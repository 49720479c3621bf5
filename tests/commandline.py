"""The command line without its commands: whether words can be given, and what help there is."""

import click

from vbraille.cli import app


def commands():
    """All commands and their actions, with the words that call them."""
    context = click.Context(app.app, info_name="vbraille")
    for name in app.HELP:
        if app._is_old(name):
            continue
        command = app.app.get_command(context, name)
        yield (name,), command
        if isinstance(command, click.Group):
            for action in command.list_commands(context):
                yield (name, action), command.get_command(context, action)


def parsed(words):
    """The command that words call, without calling it; a refusal is raised."""
    if app._is_old(words[0]):
        from vbraille.cli.old.parser import parse

        return parse(words).command
    with app.app.make_context("vbraille", list(words)) as context:
        _follow(context)
    return words[0]


def _follow(context):
    command = context.command
    if isinstance(command, click.Group):
        rest = [*context._protected_args, *context.args]
        name, found, rest = command.resolve_command(context, rest)
        with found.make_context(name, rest, parent=context) as inside:
            _follow(inside)


def helps():
    """All help of all commands, their actions and their options."""
    text = app.app.get_help(click.Context(app.app, info_name="vbraille"))
    for words, command in commands():
        context = click.Context(command, info_name=" ".join(words))
        context.meta["vbraille.help_all"] = True
        text += command.get_help(context)
    return text + "".join(_old_help(name) for name in app.HELP if app._is_old(name))


def _old_help(name):
    from vbraille.cli.old.commandtable import ACTIONS, COMMANDS
    from vbraille.cli.old.parser import CommandParser

    text = ""
    for row in (COMMANDS[name], *ACTIONS.get(name, {}).values()):
        parser = CommandParser(prog=f"vbraille {name}x", command=row)
        parser.complete()
        text += parser.format_help()
    return text
