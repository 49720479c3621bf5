"""Sample books of every form, and what is judged of a command that was given one."""

from pathlib import Path

FILES = Path(__file__).parent.parent / "translate" / "documents" / "files"
SAMPLES = sorted(
    path.name
    for path in FILES.iterdir()
    if path.name != "README.md"
    and path.suffix in (".epub", ".docx", ".odt", ".rtf", ".html", ".md", ".xml", ".brf", ".pef")
)


def sentence(said, *, partly=False):
    """The sentence of what was refused, perhaps after a part of it that could be read."""
    assert partly or said.out == ""
    *before, last = said.err.split("\n")[:-1]
    assert not [line for line in before if not line.startswith(("line width: ", "device: "))]
    assert last.startswith("vbraille: ")
    assert "fault of vbraille" not in last
    assert "Traceback" not in said.err
    assert last.isprintable()
    return last.removeprefix("vbraille: ")


def usable(said):
    """Whether it was read: something is printed, or else one sentence says why not."""
    if said.code == 0:
        assert said.out.strip(), "an empty book without a word about it"
        assert "fault of vbraille" not in said.err
        return True
    assert said.code in (1, 2)
    sentence(said, partly=True)  # what is damaged may come late in the book
    return False
