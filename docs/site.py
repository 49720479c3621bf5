"""Hooks of mkdocs: the pages beside docs/ join the site, and links between them and docs/ hold."""

import re
from pathlib import Path

from mkdocs.structure.files import File

ROOT = Path(__file__).parents[1]
# Pages of the repository's first folder, by their names in the site.
BESIDE = {
    "README.md": "index.md",
    **{name: name for name in ("CONTRIBUTING.md", "CHANGELOG.md", "SECURITY.md")},
}
FILES = (
    "CITATION.cff",
    "packaging/70-vbraille.rules",
    "packaging/95-vbraille-rtprio.conf",
)
_LINK = re.compile(r"(\]\()(\.\./|docs/)?([^):#\s]+)")


def _target(page, link):
    """The link as the site has it; `page` is the name of its page there."""
    opening, folder, name = link.groups()
    beside = page in BESIDE.values()
    if (folder == "../" and not beside) or (folder is None and beside):
        return opening + BESIDE.get(name, name)
    if folder == "docs/" and beside:
        return opening + name
    return link[0]


def on_files(files, config):
    """Add the pages and files beside docs/."""
    for name, shown in {**BESIDE, **{name: name for name in FILES}}.items():
        content = (ROOT / name).read_text(encoding="utf-8")
        files.append(File.generated(config, shown, content=content))
    return files


def on_page_markdown(markdown, page, **_):
    """Lead links to where the site has their pages."""
    return _LINK.sub(lambda link: _target(page.file.src_uri, link), markdown)
