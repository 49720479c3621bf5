"""Reading of SVG files: what is refused, quickly, and what drawing programs write is not."""

import pytest

from tests.tiers import by_tier
from vbraille.errors import InputError
from vbraille.scene.svg.document import MOST_ELEMENTS, name_of, read_tree

NS = 'xmlns="http://www.w3.org/2000/svg"'
# As Adobe Illustrator begins its files.
ILLUSTRATOR = """<?xml version="1.0" encoding="utf-8"?>
<!-- Generator: Adobe Illustrator 24.0.1, SVG Export Plug-In . SVG Version: 6.00 Build 0)  -->
<!DOCTYPE svg PUBLIC "-//W3C//DTD SVG 1.1//EN" "http://www.w3.org/Graphics/SVG/1.1/DTD/svg11.dtd" [
	<!ENTITY ns_extend "http://ns.adobe.com/Extensibility/1.0/">
	<!ENTITY ns_svg "http://www.w3.org/2000/svg">
	<!ENTITY ns_xlink "http://www.w3.org/1999/xlink">
]>
<svg version="1.1" xmlns:x="&ns_extend;" xmlns="&ns_svg;" xmlns:xlink="&ns_xlink;">
<g id="river"/>
</svg>
"""
LAUGHS = "".join(
    f'<!ENTITY lol{n} "{f"&lol{n - 1};" * 10}">' if n else '<!ENTITY lol0 "lol">' for n in range(10)
)
COUNT = by_tier(MOST_ELEMENTS + 1, 1_000_000, 1_000_000)
BAD = {
    "entities of entities": (
        f"<!DOCTYPE svg [{LAUGHS}]><svg {NS}>&lol9;</svg>",
        "entities that cannot be replaced",
    ),
    "entity of a file": (
        f'<!DOCTYPE svg [<!ENTITY x SYSTEM "file:///etc/passwd">]><svg {NS}>&x;</svg>',
        "entities that cannot be replaced",
    ),
    "entities of the type itself": (
        f'<!DOCTYPE svg [<!ENTITY % x SYSTEM "http://localhost/x"> %x;]><svg {NS}/>',
        "entities that cannot be replaced",
    ),
    "too many elements": (f"<svg {NS}>{'<g/>' * COUNT}</svg>", "more than 50000 elements"),
    "far too deep": (f"<svg {NS}>{'<g>' * 100_000}", "far too deep; ungroup"),
    "not well formed": (f"<svg {NS}><g></svg>", "not well-formed XML: Opening and ending tag"),
    "unknown entity": (f"<svg {NS}>&nbsp;</svg>", "nbsp"),
    "no XML": ("Once upon a time", "not well-formed"),
    "another document": ("<html><svg/></html>", "is not SVG: it is a document of html"),
    "unknown encoding": ('<?xml version="1.0" encoding="idna"?><svg/>', "idna"),
}


def saved(folder, text):
    path = folder / "plan.svg"
    path.write_bytes(text if isinstance(text, bytes) else text.encode())
    return path


@pytest.mark.parametrize("kind", BAD)
def test_bad_drawings_are_one_sentence(tmp_path, kind):
    text, said = BAD[kind]
    path = saved(tmp_path, text)
    with pytest.raises(InputError) as refused:
        read_tree(path)
    message = str(refused.value)
    assert message.startswith(str(path))
    assert said in message
    assert message.isprintable()
    assert len(message) < 250 + len(str(path))


@pytest.mark.parametrize(
    ("content", "said"),
    [(b"\x1f\x8b\x08\0", "compressed"), (b"<svg>\xff</svg>", "character encoding"), (b"", "empty")],
)
def test_bad_bytes_are_one_sentence(tmp_path, content, said):
    with pytest.raises(InputError, match=said):
        read_tree(saved(tmp_path, content))


def test_files_of_illustrator_are_read_with_their_lines(tmp_path):
    root = read_tree(saved(tmp_path, ILLUSTRATOR))
    assert [name_of(child) for child in root] == ["g"]
    line = ILLUSTRATOR[: ILLUSTRATOR.index("<g")].count("\n") + 1
    assert root[0].sourceline == line


@pytest.mark.parametrize("encoding", ["utf-8", "utf-8-sig", "utf-16", "iso-8859-1", "windows-1252"])
def test_encodings(tmp_path, encoding):
    named = encoding.removesuffix("-sig")
    text = f'<?xml version="1.0" encoding="{named}"?><svg {NS} id="Élan"/>'
    assert read_tree(saved(tmp_path, text.encode(encoding))).get("id") == "Élan"
