import hashlib
import io
import os
import subprocess
import sys
import xml.etree.ElementTree as ET
from dataclasses import replace
from functools import cache
from itertools import pairwise

import numpy as np
import pytest
from matplotlib import rc_context
from matplotlib.collections import PatchCollection
from matplotlib.text import Text
from PIL import Image

from tests.pictures.charts import CHARTS, bars, matrix, path, rise, runs
from tests.tiers import by_tier, heavy
from vbraille.pictures.charts import Bars, Matrix, Paths, Rises, Runs, Series
from vbraille.pictures.drawcharts import draw_chart
from vbraille.pictures.figurefiles import to_bytes

drawn = cache(draw_chart)  # for who only looks at it
KINDS = pytest.mark.parametrize("chart", CHARTS, ids=lambda chart: type(chart).__name__)
DIGESTS = """
import hashlib
from tests.pictures.charts import CHARTS
from vbraille.pictures.drawcharts import draw_chart
from vbraille.pictures.figurefiles import to_bytes
for chart in CHARTS:
    figure = draw_chart(chart)
    for kind, dpi in (("svg", 0), ("png", 40)):
        print(hashlib.sha256(to_bytes(figure, kind, dpi)).hexdigest())
"""


def digests(chart):
    figure = draw_chart(chart)
    contents = to_bytes(figure, "svg"), to_bytes(figure, "png", 40)
    return [hashlib.sha256(content).hexdigest() for content in contents]


def drawn_bars(axes):
    return [bar for container in axes.containers for bar in getattr(container, "patches", [])]


def words(figure):
    return [text.get_text() for text in figure.findobj(Text) if text.get_text().strip()]


def patches(axes):
    """Collections of patches, without those of lines."""
    return [each for each in axes.collections if isinstance(each, PatchCollection)]


def cells(collection):
    """Column and row of each cell that a collection draws."""
    return [tuple(path.vertices.min(axis=0).astype(int)) for path in collection.get_paths()]


def overlaps(figure):
    """Labels of groups, rows and columns that lie upon each other."""
    for axes in figure.axes:
        for axis in (axes.xaxis, axes.yaxis):
            boxes = [
                label.get_window_extent()
                for label in axis.get_ticklabels()
                if label.get_visible() and label.get_text()
            ]
            for one, other in pairwise(boxes):
                if one.overlaps(other):
                    yield axes, axis


@pytest.mark.no_cover
@KINDS
def test_charts_are_grey(chart):
    pixels = Image.open(io.BytesIO(to_bytes(drawn(chart), "png", 30)))
    assert pixels.mode == "L"  # greys alone, of one byte
    assert len(pixels.getcolors()) > 2


@pytest.mark.no_cover
@KINDS
def test_every_axis_is_labelled(chart):
    figure = drawn(chart)
    assert figure.get_suptitle() == chart.title
    assert figure.axes[-1].get_xlabel()
    assert all(axes.get_ylabel() or figure.get_supylabel() for axes in figure.axes)


def test_bars_are_a_series_beside_the_other_with_hatches_of_their_own():
    names = [f"T = {n} %" for n in range(6)]
    figure = draw_chart(bars(names=names))
    assert [axes.get_ylabel() for axes in figure.axes] == ["legibility (%)", "reading time (s)"]
    for axes in figure.axes:
        found = drawn_bars(axes)
        assert len(found) == 3 * 6
        assert len({(bar.get_facecolor(), bar.get_hatch()) for bar in found}) == 6
        places = sorted((bar.get_x(), bar.get_x() + bar.get_width()) for bar in found)
        for (_, end), (start, _) in pairwise(places):
            assert start >= end - 1e-9
    (legend,) = figure.legends
    assert [text.get_text() for text in legend.get_texts()] == names


@pytest.mark.no_cover
def test_bars_have_their_intervals():
    axes = draw_chart(bars(names=["all"])).axes[0]
    (spread,) = axes.collections
    ends = [segment[:, 1].tolist() for segment in spread.get_segments()]
    assert ends == [[32, 46], [37, 51], [42, 56]]


def test_one_series_needs_no_legend():
    assert not draw_chart(bars(names=["all"])).legends


def test_what_is_missing_is_told_at_its_place():
    figure = draw_chart(bars(missing=[1]))
    for axes in figure.axes:
        assert len(drawn_bars(axes)) == 2 * 2
        assert [text.get_text() for text in axes.texts] == ["n/a", "n/a"]
        assert [round(text.xy[0]) for text in axes.texts] == [1, 1]


def test_a_panel_without_any_value_has_no_scale():
    nothing = Bars("Chosen", "width (mm)", ("1",), (("chosen (%)", (Series("x", (None,)),)),))
    (axes,) = draw_chart(nothing).axes
    assert [text.get_text() for text in axes.texts] == ["n/a"]
    assert not axes.get_yticks().size


@pytest.mark.no_cover
@pytest.mark.parametrize(
    ("groups", "names"),
    [
        (["S1", "S2", "S3"], ["one"]),
        (["AB", "a participant of three words", "CN"], ["one", "two"]),
        # As many bars as these take long; thirty groups stand as close.
        pytest.param(
            list("abcdefghijklmnopqrstuvwxyz"), ["T = 0 %", "T = 25 %", "T = 100 %"], marks=heavy
        ),
        ([f"participant-{n}" for n in range(30)], ["one"]),
    ],
    ids=["3", "words", "26", "30"],
)
def test_groups_labels_do_not_overlap(groups, names):
    figure = draw_chart(bars(groups, names))
    assert not list(overlaps(figure))
    assert figure.get_figwidth() <= 22


def test_runs_have_a_dot_a_trial_and_the_average():
    chart = runs(trials=12)
    (axes,) = draw_chart(chart).axes
    dots, curve = axes.get_lines()
    trial, percent = np.nanmean(np.reshape(dots.get_data(), (2, 12, 3)), axis=2)
    assert trial == pytest.approx(range(1, 13))
    assert percent.tolist() == [100 * right for right in chart.runs[0].correct]
    assert np.isnan(curve.get_ydata()[:9]).all()
    assert curve.get_ydata()[9:] == pytest.approx([70, 80, 80])


@pytest.mark.no_cover
def test_many_runs_share_their_axes_and_stay_apart():
    figure = draw_chart(runs(20, trials=80))
    assert len([axes for axes in figure.axes if axes.axison]) == 20
    assert len({axes.get_ylim() for axes in figure.axes}) == 1
    assert not list(overlaps(figure))
    assert sum(bool(axes.get_xlabel()) for axes in figure.axes) == 4
    assert len(to_bytes(figure, "svg")) < 200_000  # small enough to be within a page


def test_the_lowest_of_a_grid_with_a_gap_are_labelled():
    figure = draw_chart(runs(5))
    labelled = [bool(axes.get_xlabel()) for axes in figure.axes]
    assert labelled == [False, False, True, True, True, False]
    assert [axes.axison for axes in figure.axes] == [True] * 5 + [False]


def test_a_path_is_dotted_where_it_is_not_of_the_trial():
    chart = Paths("Reading patterns", (path(start_s=1, end_s=6.5),))
    (axes,) = draw_chart(chart).axes
    styles = {"--": [], ":": [], "-": []}
    for line in axes.get_lines():
        styles[line.get_linestyle()].append(line)
    assert [line.get_xdata()[0] for line in styles["--"]] == [0, 4, 10.5]
    assert [tuple(line.get_ydata()[[0, -1]]) for line in styles["-"]] == [(1, 6.5)] * 2
    ends = [tuple(line.get_ydata()[[0, -1]]) for line in styles[":"]]
    assert ends == [(0, 1)] * 2 + [(6.5, 8)] * 2
    left, right = styles["-"]
    assert right.get_xdata() - left.get_xdata() == pytest.approx(7.7)
    (band,) = axes.collections
    assert len(band.get_paths()[0].vertices) < 2500  # a long path is thinned


@pytest.mark.no_cover
@pytest.mark.parametrize(("start_s", "end_s"), [(-1, 9), (0, 8), (3, 3)])
def test_paths_of_any_part_are_drawn(start_s, end_s):
    draw_chart(Paths("Reading patterns", (path(start_s, end_s),)))


def test_an_empty_path_has_its_dots_alone():
    empty = replace(path(), time_s=(), x_mm=())
    (axes,) = draw_chart(Paths("Reading patterns", (empty,))).axes
    assert len(axes.get_lines()) == 3


def test_a_rise_has_its_answers_its_curve_and_its_threshold():
    bare = replace(rise(), curve=(), threshold=None)
    whole, none = draw_chart(Rises("Thresholds", (rise(), bare))).axes
    (dots,) = whole.collections
    assert dots.get_offsets()[:, 1].tolist() == pytest.approx([52, 60, 82, 97])
    assert dots.get_sizes()[0] > dots.get_sizes()[-1]  # of more trials
    curve, interval, threshold = whole.get_lines()
    assert curve.get_ydata()[0] == pytest.approx(100 * rise().curve[0][1])
    assert list(interval.get_xdata()) == [0.22, 0.41]
    assert list(threshold.get_xdata()) == [0.3]
    assert not none.get_lines()


def test_matrix_prints_counts_and_frames_errors():
    (axes,) = draw_chart(matrix()).axes
    counts = {text.get_position(): text.get_text() for text in axes.texts}
    assert counts == {
        (0.5, 0.5): "30",
        (1.5, 0.5): "5",
        (0.5, 1.5): "10",
        (1.5, 1.5): "28",
        (2.5, 1.5): "4",
    }
    shaded, thin, thick = patches(axes)
    assert cells(shaded) == [(0, 0), (1, 1)]
    assert (cells(thin), cells(thick)) == ([(1, 0)], [(0, 1)])
    assert thick.get_linewidth()[0] > 2 * thin.get_linewidth()[0] > 0
    assert not thin.get_facecolor().size  # a frame alone


def test_a_row_without_a_right_answer_has_no_shade():
    (axes,) = draw_chart(matrix(diagonal=(None, 1))).axes
    assert cells(patches(axes)[0]) == [(1, 1)]


@pytest.mark.no_cover
def test_a_matrix_of_letters_is_legible():
    counts = tuple(tuple(row * column % 7 // 5 * 12 for column in range(27)) for row in range(26))
    figure = draw_chart(matrix(counts, tuple(range(26))))
    (axes,) = figure.axes
    assert not list(overlaps(figure))
    cell = axes.get_window_extent().width / 27
    assert max(text.get_window_extent().width for text in axes.texts) < 0.9 * cell
    assert min(text.get_fontsize() for text in axes.texts) >= 6.5
    width, height = figure.get_size_inches()
    assert width <= 6.7  # A4 within margins of 20 mm
    assert height <= 10.1
    assert len(to_bytes(figure, "svg")) < 200_000


@heavy  # as many texts as a matrix of letters, which is tested in every run
def test_large_counts_have_room_in_their_cells():
    counts = tuple((15_387,) * 26 for _ in range(26))
    (axes,) = draw_chart(matrix(counts, tuple(range(26)))).axes
    cell = axes.get_window_extent().width / 26
    assert max(text.get_window_extent().width for text in axes.texts) < cell


LONG = "a participant whose pseudonym is as long as anybody would ever have it"


@pytest.mark.no_cover
@pytest.mark.parametrize(
    "chart",
    [
        bars(groups=[LONG, "b", "c"], names=[LONG, "two"]),
        bars(groups=[f"{LONG} {n}" for n in range(12)], names=["one"]),
        Runs("Over time", (replace(runs().runs[0], name=LONG),) * by_tier(4, 12, 12)),
        Paths("Patterns", (replace(path(), name=LONG),) * 3),
        replace(matrix(), rows=(LONG, "b"), columns=(LONG, "b", "c")),
        Rises("Thresholds", (replace(rise(), name=LONG),) * 3),
    ],
    ids=["bars", "many bars", "runs", "paths", "matrix", "rises"],
)
def test_no_label_is_cut_short(chart):
    figure = draw_chart(chart)
    told = [word for word in words(figure) if " ".join(word.split()).startswith(LONG)]
    assert told
    assert not any("…" in word for word in words(figure))
    assert not list(overlaps(figure))
    figure.draw_without_rendering()  # places the legend's words
    box = figure.bbox
    for text in figure.findobj(Text):
        if text.get_visible() and " ".join(text.get_text().split()).startswith(LONG):
            extent = text.get_window_extent()
            assert (extent.p0 >= box.p0 - 1).all()
            assert (extent.p1 <= box.p1 + 1).all()


def test_each_participant_is_a_point_upon_the_bar():
    own = ((30.0, 40.0, None), (50.0, 60.0, 70.0))
    chart = Bars(
        "Means", "level", ("x", "y", "z"),
        (("legibility (%)", (Series("mean", (40.0, 50.0, 70.0), points=own),)),),
    )  # fmt: skip
    (axes,) = draw_chart(chart).axes
    first, second = axes.get_lines()
    assert second.get_ydata().tolist() == [50, 60, 70]
    assert first.get_ydata()[:2].tolist() == [30, 40]
    assert np.isnan(first.get_ydata()[2])
    assert first.get_marker() == "o"
    assert first.get_linewidth() > 0  # joined, as one bar stands in a group
    assert first.get_xdata()[0] < second.get_xdata()[0]  # beside each other
    assert abs(second.get_xdata()[0]) < 0.4  # upon the bar


# Matplotlib writes all of them in one way: the others are here for what they draw.
@pytest.mark.parametrize(
    "chart",
    [pytest.param(chart, marks=() if isinstance(chart, Matrix) else heavy) for chart in CHARTS],
    ids=lambda chart: type(chart).__name__,
)
def test_a_pdf_has_no_date_and_is_the_same_again(chart):
    first, again = (to_bytes(draw_chart(chart), "pdf") for _ in range(2))
    assert first == again
    assert first.startswith(b"%PDF")
    assert b"CreationDate" not in first
    assert b"/Type3" not in first.replace(b" ", b"")  # letters stay letters


@pytest.mark.no_cover
@KINDS
def test_figures_fit_upon_a4(chart):
    width, height = drawn(chart).get_size_inches()
    assert min(width, height) <= 7.2
    assert max(width, height) <= 10.1


NASTY = "$x$ <&> \udc80\0\n_y"


@pytest.mark.no_cover
@pytest.mark.parametrize(
    "chart",
    [
        replace(bars(groups=[NASTY, "_b", "c"], names=["_hidden", NASTY]), title=NASTY),
        Runs(NASTY, (replace(runs().runs[0], name=NASTY),)),
        Paths(NASTY, (replace(path(), name=NASTY),)),
        replace(matrix(), title=NASTY, down=NASTY, across=NASTY, rows=(NASTY, "b")),
        Rises(NASTY, (replace(rise(), name=NASTY, across=NASTY),)),
    ],
    ids=["bars", "runs", "paths", "matrix", "rises"],
)
def test_any_name_is_drawn_as_it_is(chart):
    figure = draw_chart(chart)
    assert sum("$x$ <&> \\udc80\\x00" in word for word in words(figure)) > 1
    assert ET.fromstring(to_bytes(figure, "svg")).tag == "{http://www.w3.org/2000/svg}svg"


def test_a_legend_has_names_that_begin_with_an_underscore():
    (legend,) = draw_chart(bars(names=["_hidden", "b"])).legends
    assert [text.get_text() for text in legend.get_texts()] == ["_hidden", "b"]


def test_what_the_font_has_not_stays_text():
    figure = draw_chart(bars(groups=["読む", "b", "c"], names=["all"]))
    assert "読む".encode() in to_bytes(figure, "svg")
    to_bytes(figure, "png", 40)


def test_a_long_title_has_several_lines():
    figure = draw_chart(replace(bars(), title="Legibility and reading time " * 5))
    assert figure.get_suptitle().count("\n") >= 1
    assert b"Legibility and reading time Legibility" in to_bytes(figure, "svg")


@pytest.mark.no_cover
def test_the_same_chart_gives_the_same_bytes_in_every_process():
    run = subprocess.run(
        [sys.executable, "-W", "error", "-c", DIGESTS],
        env=os.environ | {"PYTHONHASHSEED": "4711"},
        capture_output=True,
        text=True,
        check=True,
    )
    with rc_context({"font.size": 30, "text.parse_math": True}):
        assert run.stdout.split() == [digest for chart in CHARTS for digest in digests(chart)]


def test_both_files_of_a_figure_are_the_same_in_any_order():
    figure = draw_chart(CHARTS[1])
    first = to_bytes(figure, "svg")
    to_bytes(figure, "png")
    assert to_bytes(figure, "svg") == first
