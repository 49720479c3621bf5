"""Scene files and what they include: put together, or refused in a sentence with file and line."""

import pytest

from vbraille.errors import InputError
from vbraille.scene.reading import open_scene

CANVAS = "[canvas]\nwidth_mm = 200\nheight_mm = 100\n"
DOT = '[[elements]]\nkind = "dots"\ncenters_mm = [[5, 5]]\n'


def write(folder, **files):
    for name, text in files.items():
        path = folder / f"{name}.scene"
        path.parent.mkdir(exist_ok=True)
        path.write_text(text, encoding="utf-8")
    return folder / "main.scene"


def refusal(path):
    with pytest.raises(InputError) as caught:
        open_scene(path)
    return str(caught.value)


def test_elements_of_included_files_stand_before_the_files_own(tmp_path):
    path = write(
        tmp_path,
        main=f'include = ["one.scene", "two.scene"]\n{CANVAS}{DOT}id = "own"\n',
        one=f'{DOT}id = "first"\n',
        two=f'{DOT}id = "second"\n{DOT}id = "third"\n',
    )
    opened = open_scene(path)
    assert [element.id for element in opened.resolved.elements] == [
        "first",
        "second",
        "third",
        "own",
    ]
    assert [place.removeprefix(f"{tmp_path}/") for place in opened.places] == [
        "one.scene line 1",
        "two.scene line 1",
        "two.scene line 5",
        "main.scene line 5",
    ]


def test_a_bank_without_canvas_gives_its_textures_to_others(tmp_path):
    path = write(
        tmp_path,
        main=f'include = ["bank.scene"]\n{CANVAS}[[elements]]\nkind = "use"\nname = "brick"\n',
        bank='[textures.brick]\nkind = "uniform"\nlevel = 0.25\n',
    )
    (element,) = open_scene(path).resolved.elements
    assert element.level == 0.25
    assert "bank.scene has no canvas; write [canvas]" in refusal(tmp_path / "bank.scene")


def test_a_file_that_two_others_include_counts_once(tmp_path):
    path = write(
        tmp_path,
        main=f'include = ["one.scene", "two.scene"]\n{CANVAS}',
        one='include = ["third.scene"]\n',
        two='include = ["third.scene"]\n',
        third=DOT,
    )
    assert len(open_scene(path).resolved.elements) == 1


def test_elements_that_are_put_together_otherwise_stay_together(tmp_path):
    path = write(
        tmp_path,
        main=f'include = ["one.scene"]\noperation = "maximum"\n{CANVAS}{DOT}',
        one=f'operation = "add"\n{DOT}{DOT}',
    )
    opened = open_scene(path)
    group, dots = opened.resolved.elements
    assert (group.operation, len(group.parts), dots.__class__.__name__) == ("add", 2, "Dots")
    assert [place.rpartition("/")[2] for place in opened.places] == [
        "one.scene line 2",
        "main.scene line 6",
    ]


def test_images_and_labels_of_an_included_file_keep_their_folder_and_language(tmp_path):
    (tmp_path / "parts").mkdir()
    write(
        tmp_path / "parts",
        one='language = "fr"\n[[elements]]\nkind = "label"\ntext = "eau"\nplace_mm = [1, 1]\n'
        '[[elements]]\nkind = "group"\nparts = [{kind = "image", file = "sea.png"}]\n',
    )
    path = write(tmp_path, main=f'include = ["parts/one.scene"]\n{CANVAS}')
    label, group = open_scene(path).resolved.elements
    assert label.table == "fr"
    assert group.parts[0].file == "parts/sea.png"


REFUSED = {
    "a cycle": (
        {"main": 'include = ["one.scene"]\n', "one": '# x\ninclude = ["main.scene"]\n'},
        "one.scene line 2: include 1: is 'main.scene', which includes this file",
    ),
    "a missing file": (
        {"main": 'include = [\n"one.scene",\n"no.scene"]\n', "one": ""},
        "main.scene line 1: include 2: is 'no.scene', which is no file; check t",
    ),
    "a folder": ({"main": 'include = ["."]\n'}, "is '.', which is no file"),
    "a remote file": (
        {"main": 'include = ["http://example.org/a.scene"]\n'},
        "give the name of a file, since nothing is fetched",
    ),
    "no name": ({"main": 'include = [" "]\n'}, "give the name of a file"),
    "a texture named twice": (
        {
            "main": 'include = ["one.scene"]\n[textures.a]\nkind = "uniform"\n',
            "one": '\n[textures.a]\nkind = "uniform"\n',
        },
        "main.scene line 2: a: is called a, as is one.scene line 2; give it ano",
    ),
    "an element named twice": (
        {"main": f'include = ["one.scene"]\n{CANVAS}{DOT}id = "a"\n', "one": f'{DOT}id = "a"\n'},
        "main.scene line 5: elements 1: is called a, as is one.scene line 1; gi",
    ),
    "a fault in what is included": (
        {"main": 'include = ["one.scene"]\n', "one": '[[elements]]\nkind = "circel"\n'},
        "one.scene line 2: kind: is 'circel'; did you mean circle?",
    ),
}


@pytest.mark.parametrize("case", REFUSED)
def test_what_cannot_be_included_is_refused_with_file_and_line(tmp_path, case):
    files, sentence = REFUSED[case]
    path = write(tmp_path, **files)
    assert sentence in refusal(path).replace(f"{tmp_path}/", "")


def test_more_files_than_there_may_be_are_refused(tmp_path):
    names = [f"f{number}" for number in range(101)]
    path = write(
        tmp_path,
        main=f"include = [{', '.join(f'{chr(34)}{name}.scene{chr(34)}' for name in names)}]\n",
        **dict.fromkeys(names, ""),
    )
    assert "one file more than the 100 that a scene can include" in refusal(path)
