"""``vbraille keys``: the keys for reading."""

from __future__ import annotations

from typing import Any

import click

from vbraille.cli import options
from vbraille.cli.printing import show


@options.command(
    "keys --keys nvda",
    options.keys,
    options.option("--of", type=click.Choice(["book", "picture", "game", "tuning", "screen"]),
                   default="book", show_default=True, help="What the keys are for."),
    options.json,
    options.settings,
)  # fmt: skip
@click.pass_context
def command(ctx: click.Context, keys: str, of: str, json: bool, **_: Any) -> None:
    """With your own keys from the settings file."""
    from vbraille.cli.settings import settings_of
    from vbraille.reading.commands import Where, bindings, own_keys, spoken, table

    where, settings = Where[of.upper()], settings_of(ctx)
    own = own_keys(settings.table("keys"), settings.table("buttons")) if of == "book" else {}
    bound = bindings(keys, where, own)
    rows = [
        {
            "command": each.name,
            "keys": [spoken(key) for key, found in bound.items() if found is each],
            "help": each.help,
        }
        for each in table(where)
    ]
    lines = (
        f"{' or '.join(row['keys']) or 'no key'}: {row['help']} ({row['command']})" for row in rows
    )
    show(lines, rows, as_json=json)
