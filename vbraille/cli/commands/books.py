"""``vbraille books``: the books that were read."""

from __future__ import annotations

import click

from vbraille.cli import options
from vbraille.cli.printing import say, show


@options.command(
    "books 2",
    click.argument("number", type=options.whole(1), required=False),
    options.option("--forget", is_flag=True, help="Delete what is kept of the book."),
    options.json,
)
@click.pass_context
def command(ctx: click.Context, number: int | None, forget: bool, json: bool) -> None:
    """With a number, go on with that book, with the options of its last reading."""
    from vbraille.reading.places import Places, places_path

    if number and not forget:
        from vbraille.cli.commands.read import command as reading
        from vbraille.cli.commands.read import read

        with reading.make_context("read", [], parent=ctx.parent) as inside:
            read(inside, number)
        return
    places = Places(places_path(), lambda sentence: say(sentence, aside=True))
    if forget:
        if not number:
            raise click.UsageError("--forget needs the number of a book")
        book = places.numbered(number)
        places.forget(book.digest)
        say(f"{book.title}: forgotten")
        return
    rows = [
        {
            "number": number,
            "title": book.title,
            "percent": round(100 * book.share),
            "path": str(book.path),
        }
        for number, book in enumerate(places.listed(), 1)
    ]
    lines = ["{number}: {title}, {percent} percent ({path})".format(**row) for row in rows]
    show(lines or ["no books yet; vbraille read FILE begins one"], rows, as_json=json)
