"""``vbraille settings``."""

from __future__ import annotations

from typing import Any

import click

from vbraille.cli import options
from vbraille.cli.printing import say, show
from vbraille.cli.settings import SHARED, Context, origin, style_options


@options.command(
    "settings --profile evening",
    click.argument("name", metavar="[COMMAND]", default="read"),
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
        settings, inside.shows_all = inside.settings, True
        del inside.params["profile"]
        rows = _rows(inside, model)
    there = settings.path.exists()
    lines = [f"settings file: {settings.path}{'' if there else ' (not there)'}"]
    lines.append(f"profile: {settings.profile}")
    lines += [
        f"{row['name'].replace('_', ' ')}: {_said(row['value'])} ({row['from']})" for row in rows
    ]
    for table in ("keys", "buttons"):
        for key, value in settings.table(table).items():
            said = ", ".join(value) if isinstance(value, list) else value
            lines.append(f"{table} {key}: {said} ({settings.where(table, key)})")
    kept = {"file": str(settings.path), "there": there, "profile": settings.profile}
    show(lines, {**kept, "settings": rows}, as_json=json)


def _rows(inside: Context, model: str | None) -> list[dict[str, Any]]:
    """Name, value and origin of each option of a command that a settings file may have."""
    known = [param for param in inside.command.params if param.name in SHARED]
    for param in known:
        param.handle_parse_result(inside, {}, [])
    params = inside.params
    for name, value in params.items():  # what is not given is a mark of click's own
        params[name] = value if isinstance(value, str | int | float) else None
    style = style_options(inside, model or params.get("model") or "stress2")
    rows = []
    for param in known:
        name = param.name or ""
        usual = params[name], origin(inside, param) or "default"
        value, place = style.get(name, usual)
        rows.append({"name": name, "value": value, "from": place})
    return rows


def _said(value: object) -> str:
    if isinstance(value, bool):
        return "yes" if value else "no"
    return "not set" if value is None else f"{value:g}" if isinstance(value, float) else str(value)
