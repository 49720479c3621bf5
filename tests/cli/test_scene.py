"""`vbraille scene`: what it prints, a line for each thing, and how it fails."""

import json

from vbraille.scene.schema import schema_text

SCENE = """\
title = "Two moons"
description = \"\"\"
One of them
vibrates.\"\"\"
[canvas]
width_mm = 200
height_mm = 100
[[elements]]
kind = "circle"
id = "moon"
title = "The moon"
center_mm = [50, 50]
radius_mm = 10
stroke = {width_mm = 1.5, edge_mm = 0.5}
[[elements]]
kind = "use"
name = "moon"
move_mm = [80, 0]
vibration = {frequency_hz = 30}
"""


def write(folder, text):
    path = folder / "moons.scene"
    path.write_text(text, encoding="utf-8")
    return path


def test_check_says_what_there_is_a_line_for_each_thing(call, tmp_path):
    path = write(tmp_path, SCENE)
    done = call("scene", "check", path)
    assert (done.code, done.err) == (0, "")
    assert done.out.replace(f"{tmp_path}/", "") == (
        "title: Two moons\n"
        "description: One of them vibrates.\n"
        "canvas: 200 × 100 mm\n"
        "language: en\n"
        "elements: 2, combined by overwrite\n"
        "circle: 1\n"
        "use: 1\n"
        "different textures: 0\n"
        "element 1, circle The moon: 21.5 × 21.5 mm from 39.2, 39.2, moons.scene line 8\n"
        "element 2, use The moon: 21.5 × 21.5 mm from 119.2, 39.2, vibrates at 30 Hz, "
        "moons.scene line 15\n"
        "advice: moons.scene line 8: element 1, circle The moon (and 1 other) has a stroke of "
        "1.5 mm; from 2 to 10 mm they are felt best\n"
        "remarks: 1\n"
    )


def test_check_gives_the_same_as_json(call, tmp_path):
    done = call("scene", "check", write(tmp_path, SCENE), "--json")
    found = json.loads(done.out)
    assert done.code == 0
    assert found["canvas"] == {"width_mm": 200, "height_mm": 100}
    assert found["kinds"] == {"circle": 1, "use": 1}
    assert [one["vibration_hz"] for one in found["elements"]] == [[], [30.0]]
    assert len(found["advice"]) == 1


def test_check_measures_labels_as_they_are_felt(call, tmp_path):
    text = '[[elements]]\nkind = "label"\ntext = "sea"\nplace_mm = [195, 20]\n'
    path = write(tmp_path, f"[canvas]\nwidth_mm = 200\nheight_mm = 100\n{text}")
    done = call("scene", "check", path)
    assert done.code == 0
    assert "mm from 19" in done.out
    assert "mm beyond the canvas" in done.out


def test_a_scene_without_faults_has_no_remarks(call, tmp_path):
    path = write(tmp_path, SCENE.replace("1.5", "4.0"))
    done = call("scene", "check", path)
    assert done.code == 0
    assert done.out.endswith("\nremarks: none\n")


def test_a_fault_is_one_sentence_with_line_and_nearest_name(call, tmp_path):
    path = write(tmp_path, SCENE.replace('name = "moon"', 'name = "mon"'))
    done = call("scene", "check", path)
    assert (done.code, done.out) == (2, "")
    assert done.err == (
        f"vbraille: {path} line 17: name is 'mon', which nothing here is "
        "called; the nearest is moon\n"
    )


def test_schema_prints_the_schema(call):
    done = call("scene", "schema")
    assert (done.code, done.err) == (0, "")
    assert done.out == schema_text()
