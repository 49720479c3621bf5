"""The command line without its commands: whether words can be given, and what help there is."""

import click

from vbraille.cli import app


def commands():
    """All commands and their actions, with the words that call them."""
    context = click.Context(app.app, info_name="vbraille")
    for name in app.HELP:
        command = app.app.get_command(context, name)
        yield (name,), command
        if isinstance(command, click.Group):
            for action in command.list_commands(context):
                yield (name, action), command.get_command(context, action)


def parsed(words):
    """The command that words call, without calling it; a refusal is raised."""
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
    return text
