"""The command line without its commands: whether words can be given, and what help there is."""

import click

from vbraille.cli import app


def parsed(words):
    """The command that words call, without calling it; a refusal is raised."""
    if app._is_old(words[0]):
        from vbraille.cli.old.parser import parse

        return parse(words).command
    with app.app.make_context("vbraille", list(words)) as context:
        _follow(context, [*context._protected_args, *context.args])
    return words[0]


def _follow(context, words):
    command = context.command
    if isinstance(command, click.Group):
        name, found, rest = command.resolve_command(context, words)
        with found.make_context(name, rest, parent=context) as inside:
            _follow(inside, [*getattr(inside, "_protected_args", ()), *inside.args])


def helps():
    """All help of all commands, their actions and their options."""
    with app.app.make_context("vbraille", ["read"]) as context:
        return _helps(app.app, context)


def _helps(command, context):
    if isinstance(command, click.Group):
        text = command.get_help(context)
        for name in command.list_commands(context):
            if context.parent is None and app._is_old(name):
                text += _old_help(name)
                continue
            found = command.get_command(context, name)
            with click.Context(found, context, name) as inside:
                text += _helps(found, inside)
        return text
    context.meta["vbraille.help_all"] = True
    return command.get_help(context)


def _old_help(name):
    from vbraille.cli.old.commandtable import ACTIONS, COMMANDS
    from vbraille.cli.old.parser import CommandParser

    text = ""
    for row in (COMMANDS[name], *ACTIONS.get(name, {}).values()):
        parser = CommandParser(prog=f"vbraille {name}x", command=row)
        parser.complete()
        text += parser.format_help()
    return text
