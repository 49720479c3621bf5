"""Motions: their samples, how they are made, and hands recorded in files."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from vbraille.errors import InputError
from vbraille.simulation.motion import Motion, Way
from vbraille.simulation.recorded import MAX_GAP_S, load_recorded

HEADER = "t_s,x_mm\n"


@pytest.fixture
def load(tmp_path):
    """Load a recording of the given text or bytes."""

    def load_text(text):
        path = tmp_path / "hand.csv"
        path.write_bytes(text if isinstance(text, bytes) else text.encode())
        return load_recorded(path)

    return load_text


@pytest.mark.parametrize("t_s", [[0, 1, 1], [0, 2, 1], [0], [1, 2], [0, np.nan]])
def test_the_times_of_a_motion_begin_at_0_and_increase(t_s):
    with pytest.raises(ValueError, match="begin at 0 and increase"):
        Motion(np.array(t_s, float), np.zeros(len(t_s)))


def test_a_way_keeps_its_speeds_and_waits():
    way = Way(1.0)
    way.move(6.0, 10.0)
    way.move(6.0, 10.0)
    way.wait(0.25)
    way.move(5.0, 2.0)
    assert way.x_mm == 5.0
    np.testing.assert_allclose(way.motion().t_s, [0, 0.5, 0.75, 1.25])
    np.testing.assert_allclose(way.motion().x_mm, [1, 6, 6, 5])


def test_time_increases_however_short_a_movement():
    way = Way(0.0)
    way.wait(1000.0)
    way.move(5e-324, 1000.0)
    assert way.motion().x_mm[-1] == 5e-324


@pytest.mark.parametrize(
    "text",
    [
        HEADER + "3,1\n3.1,2.5\n3.5,-4\n",
        "3,1\n3.1,2.5\n3.5,-4\n",
        "\ufeff" + HEADER + "3,1\r\n3.1,2.5\r\n3.5,-4",
        'x_mm,t_s\n1,"3"\n2.5,3.1\n-4,3.5\n',
        "t_s;x_mm\n3;1\n3.1;2.5\n3.5;-4\n",
        "\n t_s , x_mm \n3 , 1\n\n3.1,2.5\n  \n3.5,-4\n",
    ],
)
def test_columns_are_found_by_name_or_are_two(load, text):
    hand = load(text)
    np.testing.assert_allclose(hand.motion.t_s, [0, 0.1, 0.5])
    assert list(hand.motion.x_mm) == [1, 2.5, -4]


@pytest.mark.parametrize(
    ("text", "y_mm", "theta_rad"),
    [
        ("0,1,7\n0.1,2,8\n", [7, 8], None),
        ("0,1,7,90\n0.1,2,8,-180\n", [7, 8], [np.pi / 2, -np.pi]),
        ("t_s,theta_deg,x_mm\n0,90,1\n0.1,-180,2\n", None, [np.pi / 2, -np.pi]),
        ("y_mm,x_mm,t_s\n7,1,0\n8,2,0.1\n", [7, 8], None),
        ("t_s,x_mm\n0,1\n0.1,2\n", None, None),
    ],
)
def test_a_second_axis_and_the_angle_may_be_there(load, text, y_mm, theta_rad):
    motion = load(text).motion
    assert list(motion.x_mm) == [1, 2]
    for got, want in ((motion.y_mm, y_mm), (motion.theta_rad, theta_rad)):
        if want is None:
            assert got is None
        else:
            np.testing.assert_allclose(got, want)


@given(
    steps=st.lists(
        st.tuples(st.floats(0.001, MAX_GAP_S), st.floats(-300, 300)), min_size=2, max_size=20
    )
)
def test_what_was_written_is_read(tmp_path_factory, steps):
    t_s = np.cumsum([step for step, _ in steps])
    x_mm = np.array([place for _, place in steps])
    path = tmp_path_factory.mktemp("hand") / "hand.csv"
    rows = np.column_stack((t_s, x_mm)).tolist()
    path.write_text(HEADER + "".join(f"{t!r},{x!r}\n" for t, x in rows))
    read = load_recorded(path).motion
    np.testing.assert_array_equal(read.t_s, t_s - t_s[0])
    np.testing.assert_array_equal(read.x_mm, x_mm)


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("", "is empty"),
        ("\n\n", "is empty"),
        (HEADER, "fewer than 2 samples"),
        ("0,1\n", "fewer than 2 samples"),
        ("time,x_mm\n0,1\n", "names a column 'time'"),
        ("t_s,y_mm\n0,1\n", "does not name a column x_mm"),
        ("t_s,x_mm,t_s\n0,1,0\n", "two columns 't_s'"),
        ("0,1,2,3,4\n", "line 1"),
        ("0\n0.1\n", "does not name a column x_mm"),
        ("t_s,x_mm,theta_rad\n0,1,2\n", "names a column 'theta_rad', which hands do not have"),
        ("t_s,x_mm,theta_deg\n0,1,\n0.1,1,2\n", "line 2: theta_deg is ''"),
        ("0,1,inf\n0.1,1,2\n", "line 1: y_mm is 'inf'; give a number from -10000 to 10000"),
        ("0,1,2,4e5\n0.1,1,2,3\n", "line 1: theta_deg is '4e5'"),
        (HEADER + "0,1\n0,1,2,5\n", "line 3"),
        (HEADER + "0,1\n\n0.1,nan\n", "line 4: x_mm is 'nan'"),
        ("nan,1\n0.1,1\n", "names a column 'nan'"),
        (HEADER + "nan,1\n0.1,1\n", "line 2: t_s is 'nan'; give a number"),
        (HEADER + "0,1\n0.1,1e5\n", "line 3: x_mm is '1e5'"),
        (HEADER + "0,1\n0,1\n", "line 3: t_s is 0 s later"),
        (HEADER + "1,1\n0.9,1\n", "line 3: t_s is -0.1 s later"),
        (HEADER + "0,1\n0.1,1\n0.9,1\n", "line 4: t_s is 0.8 s later"),
        (HEADER + "-1e308,1\n1e308,1\n", "line 2: t_s is '-1e308'"),
        (HEADER.encode() + b"0,1\n0.1,\xff\n", "line 3"),
        (HEADER + '0,"' + "1" * 200_000, "line 2"),
        (HEADER + "0," + "x" * 10_000 + "\n0.1,1\n", "line 2: x_mm is"),
    ],
)
def test_a_bad_recording_is_told_in_one_sentence(load, text, said):
    with pytest.raises(InputError) as caught:
        load(text)
    message = str(caught.value)
    assert said in message
    assert "hand.csv" in message
    assert "\n" not in message
    assert len(message) < 1000


def test_a_file_that_cannot_be_read_is_told(tmp_path):
    with pytest.raises(InputError, match=r"there is no file .*; check the name"):
        load_recorded(tmp_path / "none.csv")
    with pytest.raises(InputError, match="is a directory"):
        load_recorded(tmp_path)
