import xml.etree.ElementTree as ET
from functools import cache

import numpy as np
import pytest
from matplotlib import rc_context

from tests.pictures.tables import TABLES, make_line, make_page
from vbraille.pictures import draw
from vbraille.pictures.figurefiles import to_bytes
from vbraille.render import MAPPINGS

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
    assert "full swing" in words or table.kind == "page"
    for axes in figure.axes:
        assert axes.get_xlabel() or figure.get_supxlabel()
    assert any(axes.get_ylabel() for axes in figure.axes) or figure.get_supylabel()


def test_curves_stand_one_below_the_other_a_panel_for_each_method_or_width():
    panels = [axes for axes in drawn(TABLES[1]).axes if axes.axison]
    assert [axes.get_title() for axes in panels] == [
        f"method {name}" for name, each in MAPPINGS.items() if each.rows <= 6
    ]
    for axes in panels:
        assert len(curves(axes)) == 6
        tops = [line.get_ydata().max() for line in curves(axes)]
        assert tops == sorted(tops, reverse=True)  # row 0 is the far one
    assert [len(curves(axes)) for axes in drawn(TABLES[2]).axes] == [12]
    widths = [axes.get_title() for axes in drawn(TABLES[3]).axes]
    assert widths == ["dot width 0.5", "dot width 1.0", "dot width 2.0"]


def test_page_fills_each_actuator_up_to_its_deflection():
    table = TABLES[4]
    close = drawn(table).axes[1]
    boxes, fills = (
        np.array([one.get_height() for one in bars.patches]) for bars in close.containers
    )
    deflections = table.where("what", "actuator")["deflection"]
    assert deflections.max() > 0.5
    assert fills / boxes == pytest.approx(deflections)


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


def written(figure, kind):
    return to_bytes(figure, kind, "a title")


@pytest.mark.no_cover
@KINDS
def test_svg_parses_and_its_text_stays_text(table):
    content = to_bytes(drawn(table), "svg", table.title).decode()
    assert ET.fromstring(content).tag == "{http://www.w3.org/2000/svg}svg"
    assert content.count(table.title) >= 2  # as text and as the file's title


@pytest.mark.no_cover
@pytest.mark.parametrize("kind", ["png", "svg"])
def test_figures_have_the_same_bytes_again_whatever_the_readers_matplotlibrc(kind):
    content = written(draw.draw(PROFILE), kind)
    with rc_context({"font.size": 30, "savefig.dpi": 10, "lines.linewidth": 9}):
        assert written(draw.draw(PROFILE), kind) == content
    assert content.startswith(b"\x89PNG\r\n\x1a\n" if kind == "png" else b"<?xml")
