"""``vbraille completion``."""

from __future__ import annotations

import click

from vbraille.cli import options


@options.command(
    "completion bash", click.argument("shell", type=click.Choice(["bash", "zsh", "fish"]))
)
@click.pass_context
def command(ctx: click.Context, shell: str) -> None:
    """It completes commands, options and values."""
    from click.shell_completion import get_completion_class

    script = get_completion_class(shell)
    assert script is not None  # they are click's own
    click.echo(script(ctx.find_root().command, {}, "vbraille", "_VBRAILLE_COMPLETE").source())
