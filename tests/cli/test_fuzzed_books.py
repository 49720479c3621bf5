"""Books of every form with a few things wrong in them, by the command itself."""

import io
import zipfile

import pytest

from tests.cli.judging import FILES, SAMPLES, usable
from tests.tiers import by_tier


def rezipped(content, change):
    """The archive with each of its members changed, as far as that is so."""
    packed = io.BytesIO()
    with zipfile.ZipFile(io.BytesIO(content)) as source, zipfile.ZipFile(packed, "w") as out:
        for info in source.infolist():
            out.writestr(info, change(source.read(info)))
    return packed.getvalue()


def mutated(content, rng):
    """Bytes with a few things wrong: changed, left out, twice, or something put in."""
    pieces = [
        b"<",
        b">",
        b"&",
        b"\0",
        b"\xff",
        b"</p>",
        b"<table>",
        b"&#0;",
        b"{",
        b"}",
        b"]]>",
        b"\\u99999",
        b"\\bin9999 ",
        b'"',
        b"<!--",
        b"\f",
        b"<li>",
        b"-1",
        b"999999999",
    ]
    for _ in range(rng.integers(1, 6)):
        if not content:
            break
        at = int(rng.integers(len(content)))
        length = int(rng.integers(1, 40))
        match int(rng.integers(5)):
            case 0:
                content = content[:at] + bytes([rng.integers(256)]) + content[at + 1 :]
            case 1:
                content = content[:at] + content[at + length :]
            case 2:
                content = content[:at] + content[at : at + length] * 3 + content[at + length :]
            case 3:
                piece = pieces[rng.integers(len(pieces))]
                content = content[:at] + piece + content[at:]
            case 4:
                other = int(rng.integers(len(content)))
                content = content[:at] + content[other : other + length] + content[at:]
    return content


@pytest.mark.parametrize("name", SAMPLES)
def test_any_change_to_a_book_is_read_or_refused(call, tmp_path, rng, name):
    content = (FILES / name).read_bytes()
    path = tmp_path / name
    packed = content.startswith(b"PK")
    read = 0
    tries = by_tier(3, 100, 3_000)
    for number in range(tries):
        if packed and number % 3:
            share = rng.random()
            changed = rezipped(
                content, lambda c, s=share: mutated(c, rng) if rng.random() < s else c
            )
        else:
            changed = mutated(content, rng)
        path.write_bytes(changed)
        read += usable(call("page", path, "--format", "text"))
    if tries > 50:
        assert 0 < read < tries or not packed
