"""Audio maps of OpenLatero's files: masks that are not felt, with sounds that are heard there."""

import wave

import numpy as np
import pytest
from PIL import Image as Picture

from vbraille.pictures.index import SceneIndex
from vbraille.pictures.loading import load_scene
from vbraille.render.braille.models import STRESS2
from vbraille.render.compiling import SceneMap
from vbraille.scene.converting import convert_scene
from vbraille.scene.patterns import Image

SOUND = """<sound><audiofile>{file}</audiofile><mask><imgfile type="gray">mask.png</imgfile>
<position>50,50</position><width units="mm">40</width><height units="mm">40</height></mask>
</sound>"""
CIRCLE = """<Pattern type="Circle"><center>200,120</center><radius>20</radius></Pattern>"""


def loaded(folder, *files, operation="max"):
    sounds = "".join(SOUND.format(file=file) for file in files)
    audio = f'<Pattern type="Audio">{sounds}</Pattern>'
    path = folder / "a.gen"
    path.write_text(
        '<laterographics_xml type="Generator"><Generator type="Canvas"><Pattern type="Group">'
        f"<operation>{operation}</operation>{audio}{CIRCLE}</Pattern></Generator>"
        "</laterographics_xml>"
    )
    Picture.new("L", (10, 10), 255).save(folder / "mask.png")
    with wave.open(str(folder / "lake.wav"), "wb") as file:
        file.setparams((1, 2, 8000, 0, "NONE", ""))
        file.writeframes(bytes(16))
    return load_scene(path, STRESS2.style)


@pytest.mark.parametrize("operation", ["max", "add", "overwrite"])
def test_a_sound_is_heard_in_its_mask_and_nothing_is_felt_of_it(tmp_path, operation):
    scene = loaded(tmp_path, "lake.wav", operation=operation)
    assert not any("lake" in note for note in scene.notes)
    index = SceneIndex(scene.scene, scene.assets, scene.boxes())
    spot = index.where(70.0, 70.0)
    assert spot is not None
    assert (spot.element.name, spot.element.pattern.sound) == ("lake", "lake.wav")
    assert index.where(120.0, 70.0) is None
    places = np.linspace(20.0, 220.0, 101)
    felt = SceneMap(scene.scene, scene.assets).deflections(places, places)
    assert not felt[places < 95].any()
    assert felt.any()


@pytest.mark.parametrize("file", ["no.wav", "mask.png", ""])
def test_a_sound_that_cannot_be_played_is_left_out_with_a_remark(tmp_path, file):
    scene = loaded(tmp_path, file)
    assert not any(isinstance(element, Image) for element in scene.scene.elements)
    assert any("sound" in note and "left out" in note for note in scene.notes)


def test_a_converted_scene_has_the_sound(tmp_path):
    loaded(tmp_path, "lake.wav")
    (tmp_path / "deep").mkdir()
    text = convert_scene(tmp_path / "a.gen", folder=tmp_path / "deep").text
    assert 'sound = "../lake.wav"' in text
