"""Scene files are read, or refused in one sentence with the file, the line and the element."""

import contextlib
import os
import re

import pytest
from hypothesis import given
from hypothesis import strategies as st

from vbraille.errors import InputError
from vbraille.scene.converting import write_scene
from vbraille.scene.patterns import Circle, Stroke
from vbraille.scene.reading import MOST_BYTES, open_scene
from vbraille.scene.signals import Speed

CANVAS = "[canvas]\nwidth_mm = 200\nheight_mm = 100\n"
CIRCLE = '[[elements]]\nkind = "circle"\ncenter_mm = [10, 20]\nradius_mm = 5\n'
STROKE = "stroke = {}\n"


def write(tmp_path, text, name="a.scene"):
    path = tmp_path / name
    if isinstance(text, bytes):
        path.write_bytes(text)
    else:
        path.write_text(text, encoding="utf-8")
    return path


def refusal(path):
    with pytest.raises(InputError) as caught:
        open_scene(path)
    return str(caught.value)


def element(kind, *lines):
    return f'{CANVAS}[[elements]]\nkind = "{kind}"\n' + "".join(f"{line}\n" for line in lines)


def test_a_scene_is_read_with_its_lines_and_without_its_names(tmp_path):
    path = write(
        tmp_path,
        f'title = "Moon"\n{CANVAS}\n# the moon\n{CIRCLE}{STROKE}id = "moon"\n'
        '[[elements]]\nkind = "use"\nname = "moon"\nmove_mm = [1, 2]\n',
    )
    opened = open_scene(path)
    assert opened.written.title == opened.resolved.title == "Moon"
    assert [one.id for one in opened.written.elements] == ["moon", ""]
    assert opened.resolved.elements[1].center_mm == (11.0, 22.0)
    assert opened.places == (f"{path} line 7", f"{path} line 13")
    assert opened.folder == tmp_path
    assert opened.warnings == ()


def test_texts_may_have_several_lines_and_french_spaces(tmp_path):
    path = write(
        tmp_path, f'description = """\nOui\u202f!\nNon\u00a0?"""\n{CANVAS}{CIRCLE}{STROKE}'
    )
    assert open_scene(path).written.description == "Oui\u202f!\nNon\u00a0?"


REFUSED = {
    "no canvas": ("", "a.scene has no canvas; write [canvas] with width_mm and height_mm"),
    "an image in the net": (
        element("image", 'file = "http://a.org/b.png"', "width_mm = 5"),
        "line 6: file is 'http://a.org/b.png'; give the name of a file, since n",
    ),
    "spokes that fade over no length": (
        element("axial-grating", "center_mm = [1, 1]", "ridge_deg = 9", "fade_mm = [0, 5e-324]"),
        "line 8: fade is from a smaller to a larger length, from 0 to 100 mm",
    ),
    "dots that fill the memory": (
        element(
            "path",
            "contours_mm = [" + "[[-9000, 0], [9000, 0]]," * 20 + "]",
            "dots = {separation_mm = 0, dot = {radius_mm = 0.05}}",
        ),
        "line 4: elements 1: makes it more than 200000 dots along shapes; set t",
    ),
    "a misspelt kind": (
        element("cirle"),
        "line 5: kind: is 'cirle'; did you mean circle?",
    ),
    "no kind": (f"{CANVAS}[[elements]]\n", "line 4: elements 1: kind is missing"),
    "a misspelt key": (
        element("circle", "center_mm = [1, 2]", "radius = 3", "stroke = {}"),
        "line 7: radius: unknown key; did you mean radius_mm?",
    ),
    "a key of another kind, within parts that several kinds have": (
        f"{CANVAS}{CIRCLE}"
        'fill.texture = {kind = "group", parts = [{kind = "linear-grating", angle_deg = 9}]}\n',
        "line 8: angle_deg: unknown key; did you mean wave_angle_deg?",
    ),
    "nan": (
        f"{CANVAS}{CIRCLE}stroke.width_mm = nan\n",
        "line 8: width_mm: is nan; it must be a number",
    ),
    "a polygon that crosses itself": (
        element("polygon", "vertices_mm = [[0, 0], [9, 9], [9, 0], [0, 9]]", "stroke = {}"),
        "line 6: vertices make edges that cross or touch, those after number 1",
    ),
    "a polygon that is closed twice": (
        element("polygon", "vertices_mm = [[0, 0], [9, 9], [9, 0], [0, 0]]", "stroke = {}"),
        "line 6: vertices, number 4 is the first place; leave it out",
    ),
    "a shape that is not drawn": (
        CANVAS + CIRCLE,
        "line 4: elements 1: a shape needs a stroke, dots or a fill; add one",
    ),
    "a place of three numbers": (
        element("circle", "center_mm = [1, 2, 3]", "radius_mm = 3", "stroke = {}"),
        "line 6: center_mm: must be a list in brackets of length 2, not 3",
    ),
    "a texture that is none": (
        f"{CANVAS}[textures]\na = 3\n",
        "line 5: a: must be a table, not a whole number",
    ),
    "uses that lead back": (
        f'{CANVAS}[textures.a]\nkind = "use"\nname = "b"\n[textures.b]\nkind = "use"\nname = "a"\n',
        "line 7: b: uses itself: a, b, a; leave one of these uses out",
    ),
    "a canvas that is too large": (
        "[canvas]\nwidth_mm = 20000\nheight_mm = 5\n",
        "line 2: width is 20000 mm; it must be 1 to 10000 mm",
    ),
    "a control character": (
        f'title = "\\u001b[2J"\n{CANVAS}',
        "line 1: title: has control characters; leave them out",
    ),
    "groups that nest too deep": (
        CANVAS
        + "".join(f'[[elements{".parts" * n}]]\nkind = "group"\n' for n in range(40))
        + f'[[elements{".parts" * 40}]]\nkind = "uniform"\n',
        "line 68: parts 1: nests more than 32 deep; make it flatter",
    ),
    "brackets that nest too deep": (
        CANVAS + "elements = [" + "{kind=1,parts=[" * 3000,
        "a.scene is not TOML: maximum recursion depth exceeded",
    ),
    "a blend of one": (
        element(
            "group",
            'operation = "blend"',
            'parts = [{kind = "uniform"}]',
            'by = {kind = "uniform"}',
        ),
        "line 7: parts are 1; a blend has two",
    ),
    "not UTF-8": (b'title = "\n\xe9"\n', "a.scene is not UTF-8 in line 2; save it as UTF-8"),
    "a huge file": (
        b"#" * (MOST_BYTES + 1),
        "a.scene is too large for a scene; at most 8 MB",
    ),
}


@pytest.mark.parametrize("case", REFUSED)
def test_what_cannot_be_used_is_refused_in_one_sentence(tmp_path, case):
    text, sentence = REFUSED[case]
    said = refusal(write(tmp_path, text)).replace(f"{tmp_path}/", "")
    assert sentence in said
    assert "\n" not in said


def test_values_that_programs_make_are_checked_too():
    for center_mm, said in (((1, 2, 3), "center has 3 numbers"), ((1, 2e4), "center, y is 20000")):
        with pytest.raises(ValueError, match=said):
            Circle(center_mm=center_mm, radius_mm=5, stroke=Stroke())


def test_a_folder_and_a_file_that_is_not_there_are_refused(tmp_path):
    assert refusal(tmp_path) == f"{tmp_path} is a directory; give a scene in it"
    assert refusal(tmp_path / "no.scene").startswith("there is no file ")
    assert "cannot be read" in refusal("a\0b")


def test_a_pipe_is_refused_and_not_waited_for(tmp_path):
    path = tmp_path / "a.scene"
    os.mkfifo(path)
    assert refusal(path) == f"{path} is no ordinary file; give one that is"


def test_a_scene_without_elements_is_one(tmp_path):
    assert open_scene(write(tmp_path, CANVAS)).resolved.elements == ()


# Changes to a sound file: something left out, doubled, or put in place of something else.
SOUND = element(
    "polygon",
    "vertices_mm = [[0, 0], [9, 0], [9, 9]]",
    "stroke = {width_mm = 3, vibration = {frequency_hz = 20}}",
    "[elements.fill]",
    "gap_mm = 1",
    '[elements.fill.texture]\nkind = "group"\noperation = "maximum"',
    'parts = [{kind = "linear-grating", ridge_mm = 2}, {kind = "use", name = "stock:grid"}]',
)
TOKENS = re.findall(r"\w+|[^\w\s]|\s+", SOUND)
changes = st.lists(
    st.tuples(
        st.integers(0, len(TOKENS) - 1),
        st.sampled_from(["", "0", "-1", "nan", "1e400", "[]", "{}", '"x"', "true", *TOKENS]),
    ),
    min_size=1,
    max_size=3,
)


@given(changes)
def test_a_changed_file_is_read_or_refused_in_a_sentence(tmp_path_factory, changed):
    tokens = list(TOKENS)
    for place, token in changed:
        tokens[place] = token
    path = write(tmp_path_factory.getbasetemp(), "".join(tokens), "changed.scene")
    with contextlib.suppress(InputError):
        open_scene(path)


ANSWERS = {
    "an unknown signal": (
        'factor = "slw"\n[signals.slow]\nkind = "speed"\n',
        "line 9: factor: is 'slw', which is no signal here; the nearest is slow",
    ),
    "an unknown part of a signal": (
        '[signals.both]\nkind = "product"\nof = ["slow", "x"]\n[signals.slow]\nkind = "speed"\n',
        "line 9: both: is 'x', which is no signal here",
    ),
    "a circle": (
        '[signals.a]\nkind = "inverse"\nof = "b"\n[signals.b]\nkind = "inverse"\nof = "a"\n',
        "line 9: a: is made of itself: a, b, a; leave one out",
    ),
    "keys with other levels": (
        '[signals.a]\nkind = "switch"\n[signals.b]\nkind = "switch"\nlevels = [0, 0.5, 1]\n',
        "line 11: b: has 3 levels, and a, of the same key 1, 2; give both as ma",
    ),
    "too many": (
        "".join(f'[signals.s{n}]\nkind = "speed"\n' for n in range(9)),
        "line 25: s8: is one signal more than the 8 there can be",
    ),
}


@pytest.mark.parametrize("name", ANSWERS)
def test_signals_that_cannot_be_are_one_sentence_with_the_line(tmp_path, name):
    path = tmp_path / "a.scene"
    written, says = ANSWERS[name]
    head = "[canvas]\nwidth_mm = 50\nheight_mm = 50\n[[elements]]\n"
    circle = 'kind = "circle"\ncenter_mm = [25, 25]\nradius_mm = 9\nstroke = {}\n'
    path.write_text(f"{head}{circle}{written}")
    with pytest.raises(InputError) as refused:
        open_scene(path)
    assert says in str(refused.value)


def test_signals_of_an_included_file_are_there_and_written_again(tmp_path):
    bank = tmp_path / "bank.scene"
    bank.write_text('[signals.slow]\nkind = "speed"\ndelay_s = 0.5\n')
    path = tmp_path / "a.scene"
    path.write_text(
        'include = ["bank.scene"]\ncanvas = { width_mm = 50, height_mm = 50 }\n'
        '[[elements]]\nkind = "uniform"\nfactor = "slow"\n'
    )
    scene = open_scene(path).written
    assert scene.signals == {"slow": Speed(delay_s=0.5)}
    path.write_text(write_scene(scene))
    assert open_scene(path).written == scene
