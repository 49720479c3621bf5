import pytest

from tests.engine.test_loop import info


@pytest.mark.parametrize(
    ("field", "value"),
    [
        ("levels", 1),
        ("rest_side", "up"),
        ("rows", 0),
        ("columns", 0),
        ("column_pitch_mm", 0.0),
        ("travel_mm", float("nan")),
        ("counts_per_mm", -1.0),
        ("rate_hz", 0.0),
    ],
)
def test_info_checks_itself(field, value):
    with pytest.raises(ValueError, match=field.split("_")[0]):
        info(**{field: value})


def test_span():
    assert info().span_mm == pytest.approx(10.8)
