import xml.etree.ElementTree as ET
from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from matplotlib import rc_context
from matplotlib.colors import to_rgb
from matplotlib.figure import Figure

from tests.pictures.tables import TABLES, make_line, make_page
from vbraille.errors import InputError
from vbraille.pictures import draw
from vbraille.pictures.series import mapping, profile, strain
from vbraille.render import MAPPINGS, STRESS2, VBD, Tuning

drawn = cache(draw.draw)  # for who only looks at it
KINDS = pytest.mark.parametrize("table", TABLES, ids=lambda table: table.kind)
PROFILE = TABLES[0]


def texts(figure):
    """Titles of the figure and its axes, and the labels of its axes."""
    found = [figure.get_suptitle(), figure.get_supxlabel(), figure.get_supylabel()]
    for axes in figure.axes:
        found += [axes.get_title(), axes.get_xlabel(), axes.get_ylabel()]
    return found


def curves(axes):
    return [line for line in axes.get_lines() if len(line.get_xdata()) > 2]


@pytest.mark.no_cover
@KINDS
def test_every_axis_is_labelled_with_its_unit(table):
    figure = drawn(table)
    assert figure.get_suptitle() == table.title
    words = " ".join(texts(figure))
    assert "(mm)" in words
    assert ("µm" if table.kind == "resolution" else "full swing") in words
    for axes in figure.axes:
        assert axes.get_xlabel() or figure.get_supxlabel()
    assert any(axes.get_ylabel() for axes in figure.axes) or figure.get_supylabel()


@pytest.mark.no_cover
@KINDS
def test_pictures_are_grey(table):
    figure = drawn(table)
    colours = [line.get_color() for axes in figure.axes for line in axes.get_lines()]
    for axes in figure.axes:
        for collection in axes.collections:
            colours += [tuple(colour[:3]) for colour in collection.get_edgecolor()]
    for colour in colours:
        assert len(set(to_rgb(colour))) == 1


def test_profile_draws_a_panel_a_level():
    figure = draw.draw(profile(STRESS2))
    assert [axes.get_title() for axes in figure.axes] == ["T = 0 %", "T = 25 %", "T = 100 %"]
    for axes in figure.axes:
        (curve,) = curves(axes)
        assert curve.get_ydata().max() == pytest.approx(1, abs=1e-3)


def test_mapping_draws_six_rows_a_method():
    figure = drawn(TABLES[1])
    panels = [axes for axes in figure.axes if axes.axison]
    assert [axes.get_title() for axes in panels] == [
        n for n, each in MAPPINGS.items() if each.rows <= 6
    ]
    for axes in panels:
        assert len(curves(axes)) == 6
        tops = [line.get_ydata().max() for line in curves(axes)]
        assert tops == sorted(tops, reverse=True)  # row 0 is the far one


def test_mapping_draws_one_method_too():
    table = mapping(STRESS2.style, methods=[MAPPINGS["paired"], MAPPINGS["compact"]])
    assert [axes.get_title() for axes in draw.draw(table).axes] == ["paired", "compact"]
    four = mapping(STRESS2.style, methods=list(MAPPINGS.values())[:4])
    assert sum(axes.axison for axes in draw.draw(four).axes) == 4


def test_wave_draws_twelve_curves_and_the_array_at_four_positions():
    *snapshots, wave = drawn(TABLES[2]).axes
    assert len(curves(wave)) == 12
    assert len(snapshots) == 4
    # the dot wanders from the right end of the array to the left one
    highest = [int(np.argmax(curves(axes)[0].get_ydata())) for axes in snapshots]
    assert highest == sorted(highest, reverse=True)
    assert highest[0] == 11
    assert highest[-1] == 0


def test_strain_tells_the_two_neighbours_apart_by_line_style():
    figure = drawn(TABLES[3])
    upper, lower = figure.axes[:3], figure.axes[3:]
    titles = [axes.get_title() for axes in upper]
    assert titles == ["W = 0.5 mm < ε", "W = 1 mm > ε", "W = 2 mm > 2ε"]
    assert len({line.get_linestyle() for line in curves(upper[0])}) == 2
    assert "per mm" in lower[0].get_ylabel()


def test_strain_of_a_dot_as_wide_as_the_pitch_is_named_so():
    figure = draw.draw(strain(replace(VBD.style.geometry, dot_width_mm=0.7), Tuning()))
    assert figure.axes[1].get_title() == "W = 0.7 mm = ε"


def test_page_fills_each_actuator_up_to_its_deflection():
    table = TABLES[4]
    close = drawn(table).axes[1]
    boxes, fills = close.collections[-2:]
    filled, whole = (
        np.array([np.ptp(path.vertices[:, 1]) for path in patches.get_paths()])
        for patches in (fills, boxes)
    )
    deflections = table.where("what", "actuator")["deflection"]
    assert deflections.max() > 0.5
    assert filled / whole == pytest.approx(deflections)


def test_page_draws_the_raised_dots_and_numbers_the_lines():
    whole = drawn(TABLES[4]).axes[0]
    rings, raised = whole.collections[:2]
    assert len(raised.get_paths()) == 4 + 1 + 2  # z, a, b
    assert len(rings.get_paths()) == 18 - 7
    assert [text.get_text() for text in whole.texts] == ["1", "2"]


@pytest.mark.no_cover
@pytest.mark.parametrize("lines", [[make_line("")], [make_line("⠁")] * 150], ids=["empty", "150"])
def test_pages_of_any_length_have_a_bounded_size(lines):
    height = draw.draw(make_page(lines)).get_size_inches()[1]
    assert 0 < height < 50


@pytest.mark.no_cover
@KINDS
def test_svg_parses_and_its_text_stays_text(table, tmp_path):
    draw.save(drawn(table), tmp_path / "a.SVG")
    content = (tmp_path / "a.SVG").read_text("utf-8")
    assert ET.fromstring(content).tag == "{http://www.w3.org/2000/svg}svg"
    assert content.count(table.title) >= 2  # as text and as the file's title


@pytest.mark.no_cover
@pytest.mark.parametrize("suffix", [".png", ".svg"])
def test_saving_twice_gives_the_same_bytes(suffix, tmp_path):
    first, second = tmp_path / f"a{suffix}", tmp_path / f"b{suffix}"
    draw.save(draw.draw(PROFILE), first)
    draw.save(draw.draw(PROFILE), second)
    content = first.read_bytes()
    assert content == second.read_bytes()
    assert content.startswith(b"\x89PNG\r\n\x1a\n" if suffix == ".png" else b"<?xml")
    assert sorted(path.name for path in tmp_path.iterdir()) == [first.name, second.name]


@pytest.mark.parametrize("name", ["picture.pdf", "picture", ".png"])
def test_another_suffix_is_refused_by_naming_the_two(name, tmp_path):
    with pytest.raises(InputError, match=r"\.png or \.svg"):
        draw.save(Figure(), tmp_path / name)
    assert not list(tmp_path.iterdir())


def test_a_folder_that_is_not_there_is_told_in_a_sentence(tmp_path):
    with pytest.raises(InputError, match=r"cannot write .*none/a\.png \(No such file"):
        draw.save(Figure(), tmp_path / "none" / "a.png")
    assert not list(tmp_path.iterdir())


def test_what_cannot_be_replaced_stays_and_nothing_is_left_beside_it(tmp_path):
    (tmp_path / "a.png").mkdir()
    with pytest.raises(InputError, match="cannot write"):
        draw.save(Figure(), tmp_path / "a.png")
    assert [path.name for path in tmp_path.iterdir()] == ["a.png"]


@pytest.mark.no_cover
def test_a_picture_that_cannot_be_drawn_leaves_the_old_one(tmp_path):
    path = tmp_path / "a.png"
    path.write_bytes(b"old")
    figure = Figure()
    figure.suptitle("$\\nothing$")  # not known to mathtext, which only the drawing finds
    with pytest.raises(ValueError, match="nothing"):
        draw.save(figure, path)
    assert path.read_bytes() == b"old"
    draw.save(draw.draw(PROFILE), path)
    assert path.read_bytes().startswith(b"\x89PNG")


@pytest.mark.no_cover
def test_a_matplotlibrc_of_the_readers_own_changes_nothing(tmp_path):
    draw.save(draw.draw(PROFILE), tmp_path / "a.svg")
    with rc_context({"font.size": 30, "savefig.dpi": 10, "lines.linewidth": 9}):
        draw.save(draw.draw(PROFILE), tmp_path / "b.svg")
    assert (tmp_path / "a.svg").read_bytes() == (tmp_path / "b.svg").read_bytes()
