"""``vbraille settings``."""

from __future__ import annotations

from typing import Any

import click

from vbraille.cli import options
from vbraille.cli.printing import print_json, say
from vbraille.cli.settings import STYLE, Context, origin, style_options


@click.command(cls=options.Command, epilog="Example: vbraille settings --profile evening")
@click.argument("name", metavar="[COMMAND]", default="read")
@options.takes(
    options.profile,
    options.model(group=options.FIRST, help="Display whose part of the profile is shown."),
    options.settings(group=options.FIRST),
    options.option("--where", is_flag=True, help="Print the path of the settings file."),
    options.json,
)
@click.pass_context
def command(ctx: click.Context, name: str, model: str | None, where: bool, json: bool,
            **chosen: Any) -> None:  # fmt: skip
    """The settings are those of COMMAND, or of read."""
    from vbraille.files import settings_path

    if where:
        say(str(settings_path(chosen["settings"])))
        return
    root = ctx.find_root()
    group = root.command
    assert isinstance(group, click.Group)
    other = group.get_command(root, name)
    if other is None:
        raise click.UsageError(f"unknown command {name!r}; vbraille --help lists them", ctx)
    with Context(other, root, name) as inside:
        inside.params |= chosen
        rows = _rows(inside, model)
    settings = inside.settings
    there = settings.path.exists()
    if json:
        kept = {"file": str(settings.path), "there": there, "profile": settings.profile}
        print_json({**kept, "settings": rows})
        return
    say(f"settings file: {settings.path}{'' if there else ' (not there)'}")
    say(f"profile: {settings.profile}")
    for row in rows:
        say(f"{row['name'].replace('_', ' ')}: {_said(row['value'])} ({row['from']})")
    for table in ("keys", "buttons"):
        for key, value in settings.table(table).items():
            said = ", ".join(value) if isinstance(value, list) else value
            say(f"{table} {key}: {said} ({settings.where(table, key)})")


def _rows(inside: Context, model: str | None) -> list[dict[str, Any]]:
    """Name, value and origin of each option of a command that a settings file may have."""
    rows = []
    known = [param for param in inside.command.params if param.name in options.SHARED]
    for param in known:
        param.handle_parse_result(inside, {}, [])
        value = inside.params.get(param.name or "")
        inside.params[param.name or ""] = value if isinstance(value, str | int | float) else None
    style = style_options(inside, model or inside.params.get("model") or "stress2")
    for param in known:
        name = param.name or ""
        row = {
            "name": name,
            "value": inside.params[name],
            "from": origin(inside, param) or "default",
        }
        if name in STYLE and name in style:
            row["value"], row["from"] = style[name]
        rows.append(row)
    return rows


def _said(value: object) -> str:
    if isinstance(value, bool):
        return "yes" if value else "no"
    return "not set" if value is None else f"{value:g}" if isinstance(value, float) else str(value)
