"""The pictures of docs/graphics.md; ``python -m tests.pictures.gallery`` draws them again."""

from pathlib import Path
from typing import NamedTuple

from vbraille.cli.app import main

ROOT = Path(__file__).parents[2]
SCENES = ROOT / "texts/scenes/gallery"
PICTURES = ROOT / "docs/images/graphics"


class Shown(NamedTuple):
    """A picture of the gallery: its scene's name, what its file's name has more, and options."""

    scene: str
    more: str = ""
    options: tuple[str, ...] = ()
    kind: str = "png"

    @property
    def name(self) -> str:
        return f"{self.scene}{self.more}.{self.kind}"

    def command(self, folder: Path) -> list[str]:
        """Command that draws it into a folder."""
        scene = SCENES / f"{self.scene}.scene"
        return ["map", str(scene), "--out", str(folder / self.name), "--force", *self.options]


COARSE, FINE = ("--resolution", "3"), ("--resolution", "8")
LARGE = {"bank": "2.5", "distortions": "2.8", "layers": "2.5", "mixed": "3"}  # would be above 15 kB
GALLERY = [
    *(
        Shown(path.stem, options=("--resolution", LARGE.get(path.stem, "4")))
        for path in sorted(SCENES.glob("*.scene"))
    ),
    Shown("pictured", "-sequence", ("--frames", "4", *COARSE), "gif"),
    Shown("pictured", "-array", ("--array", "14,27", "--resolution", "2.6", "--rulers")),
    Shown("pictured", "-outline", ("--outline", "--resolution", "5")),
    Shown("joints", "-outline", ("--outline", *FINE)),
    Shown("markers", "-outline", ("--outline", *FINE)),
    Shown("dotted", "-outline", ("--outline", *FINE)),
    Shown("labelled", "-outline", ("--outline", "--resolution", "5")),
    Shown("directions", "-signal", ("--signal", "along", "--resolution", "2.2")),
]

if __name__ == "__main__":
    PICTURES.mkdir(parents=True, exist_ok=True)
    for shown in GALLERY:
        assert main(shown.command(PICTURES)) == 0
