"""The gallery of docs/graphics.md: its pictures are those that the program draws, in words too."""

import re
from typing import get_args

import numpy as np
import pytest
from PIL import Image, ImageSequence

from tests.pictures.gallery import GALLERY, PICTURES, ROOT, SCENES
from tests.tiers import by_tier
from vbraille.scene.patterns import AnyPattern, Group, Operation
from vbraille.scene.reading import open_scene
from vbraille.scene.traversal import each

PAGE = (ROOT / "docs/graphics.md").read_text(encoding="utf-8")
EVERYDAY = ("pictured.png", "pictured-raised.png", "operators.png", "images.png", "labelled.png")
DRAWN = [shown for shown in GALLERY if by_tier(shown.name in EVERYDAY, True, True)]


def maps_of(path):
    with Image.open(path) as image:
        frames = [np.array(frame.convert("L"), float) for frame in ImageSequence.Iterator(image)]
    return np.array(frames)


@pytest.mark.parametrize("shown", DRAWN, ids=lambda shown: shown.name)
def test_the_program_draws_each_picture_again(shown, call, tmp_path):
    done = call(*shown.command(tmp_path))
    assert (done.code, done.err) == (0, "")
    kept, drawn = maps_of(PICTURES / shown.name), maps_of(tmp_path / shown.name)
    assert kept.shape == drawn.shape
    # A gray may be rounded otherwise elsewhere, and edges of drawings may be smoothed otherwise.
    assert np.abs(kept - drawn).mean() < 0.3
    assert (np.abs(kept - drawn) > 2).mean() < 0.01


def test_each_picture_stands_on_the_page_with_what_its_scene_says():
    found = re.findall(r"!\[([^\]]*)\]\(images/graphics/(.*)\)", PAGE)
    told = {name: " ".join(words.split()) for words, name in found}
    assert sorted(told) == sorted(shown.name for shown in GALLERY)
    for shown in GALLERY:
        if not shown.more:
            scene = open_scene(SCENES / f"{shown.scene}.scene").written
            assert told[shown.name] == scene.description.strip(), shown.name


def test_pictures_are_small_and_none_is_left_over():
    sizes = {path.name: path.stat().st_size for path in PICTURES.iterdir()}
    assert sorted(sizes) == sorted(shown.name for shown in GALLERY)
    assert max(sizes.values()) <= 15_000
    assert sum(sizes.values()) <= 1_500_000


def test_each_figure_of_the_source_has_a_picture():
    found = set()
    for span in re.findall(r"figs?\. ([0-9., -]*[0-9])", PAGE):
        for part in span.split(", "):
            ends = [int(end) for end in re.findall(r"8\.([0-9]+)", part)]
            found |= set(range(ends[0], ends[-1] + 1)) if ends else set()
    assert set(range(2, 29)) - {8} <= found


def test_each_kind_of_pattern_and_of_group_has_a_picture():
    shown = set()
    for name in {picture.scene for picture in GALLERY}:
        written = open_scene(SCENES / f"{name}.scene").written
        for part in each(*written.elements):
            shown.add(part.__struct_config__.tag)
            if isinstance(part, Group):
                shown.add(part.operation)
    kinds = {kind.__struct_config__.tag for kind in get_args(AnyPattern)}
    assert kinds | set(get_args(Operation)) <= shown
