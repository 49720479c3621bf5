"""Statistics of chapter 6 of the thesis, recomputed from their t or F and degrees of freedom.

A value stands as it is printed, and so it is any that would be printed so. What the print has
wrong is said beside it: Lévesque 2009, tables 6.5-6.7 and the supplement.
"""

import pytest
from scipy import stats

# F, its degrees of freedom, and p.
OF_F = [
    ("2.364", 10, 80, "0.017"),  # shape: method × size × shape
    ("6.723", 10, 80, "<0.001"),
    ("4.420", 5, 40, "0.003"),
    ("0.693", 2, 16, "0.514"),  # method × size, in the text and in the supplement
    ("0.698", 2, 16, "0.512"),
    ("7.955", 2, 16, "0.004"),
    ("8.884", 1, 8, "0.018"),
    ("4.862", 5, 40, "0.001"),
    ("28.47", 1, 8, "0.001"),
    ("8.88", 1, 8, "0.018"),
    ("1.000", 2, 16, "0.390"),  # table 6.5: diamond, small and large
    ("3.045", 2, 16, "0.076"),
    ("0.698", 2, 16, "0.512"),  # square, large
    ("2.098", 2, 16, "0.155"),  # right triangle
    ("0.113", 2, 16, "0.894"),
    ("2.197", 2, 16, "0.143"),  # inverted triangle
    ("0.842", 2, 16, "0.449"),
    ("9.455", 2, 16, "0.002"),  # circle
    ("11.11", 2, 16, "0.001"),
    ("26.76", 2, 16, "0.000"),  # plus
    ("8.258", 2, 16, "0.003"),
    ("2.75", 10, 90, "0.005"),  # fine orientation
    ("11.64", 5, 45, "<0.001"),
    ("1.925", 2, 18, "0.175"),  # and the effect of the wavelength on each
    ("1.976", 2, 18, "0.168"),
    ("0.336", 2, 18, "0.719"),
    ("0.088", 2, 18, "0.916"),
    ("7.042", 2, 18, "0.006"),
    ("5.062", 2, 18, "0.018"),
]
# The same of t.
OF_T = [
    ("2.489", 8, "<0.05"),  # shape: gratings against dots, against vibration, and of sizes
    ("5.335", 8, "<0.05"),
    ("1.167", 8, "0.277"),
    ("2.981", 8, "<0.05"),
    ("3.279", 9, "<0.05"),  # fine orientation: wavelengths
    ("1.111", 9, "0.295"),
    ("1.495", 9, "0.169"),
    ("2.000", 8, "0.081"),  # table 6.7: diamond, by vibrations, gratings and dots
    ("0.426", 8, "0.681"),
    ("0.512", 8, "0.622"),
    ("2.449", 8, "0.040"),  # square
    ("4.472", 8, "0.002"),
    ("0.450", 8, "0.665"),
    ("0.894", 8, "0.397"),  # right triangle
    ("0.686", 8, "0.512"),
    ("1.155", 8, "0.282"),
    ("2.000", 8, "0.081"),  # inverted triangle
    ("0.555", 8, "0.594"),
    ("3.464", 8, "0.009"),
    ("0.426", 8, "0.681"),  # circle
    ("1.315", 8, "0.225"),
    ("1.414", 8, "0.195"),
    ("2.828", 8, "0.022"),  # plus
    ("2.828", 8, "0.022"),
    ("0.710", 8, "0.498"),
    ("3.000", 9, "0.015"),  # fine orientation: 4 mm against 6, ±30°
    ("3.674", 9, "0.005"),
    ("3.597", 9, "0.006"),  # 4 mm against 8
    ("2.250", 9, "0.051"),
    ("0.391", 9, "0.705"),  # 6 mm against 8
    ("0.000", 9, "1.000"),
    ("0.224", 14, "0.826"),  # icons: time, shape, orientation, frequency, icon
    ("0.098", 14, "0.924"),
    ("0.451", 14, "0.659"),
    ("1.831", 14, "0.088"),
    ("0.870", 14, "0.399"),
]


def interval(printed):
    """Values that are printed so."""
    half = 0.5 * 10.0 ** -len(printed.partition(".")[2])
    return float(printed) - half, float(printed) + half


def agrees(printed, least, most):
    """Whether a p between two is printed so."""
    if printed.startswith("<"):
        return most < float(printed[1:])
    low, high = interval(printed)
    return least <= high and most >= low


@pytest.mark.parametrize(("f", "of", "error", "p"), OF_F)
def test_p_of_f_is_as_printed(f, of, error, p):
    low, high = interval(f)
    assert agrees(p, stats.f.sf(high, of, error), stats.f.sf(max(low, 0.0), of, error))


@pytest.mark.parametrize(("t", "degrees", "p"), OF_T)
def test_p_of_t_is_as_printed(t, degrees, p):
    low, high = interval(t)
    assert agrees(p, 2 * stats.t.sf(high, degrees), 2 * stats.t.sf(max(low, 0.0), degrees))


def test_what_is_printed_wrong_is_what_was_found():
    # Table 6.5, square of 2 cm: F of 0.271 has no p of 0.000; tables 6.2 and 6.6 give an F of 13.
    assert f"{stats.f.sf(0.271, 2, 16):.2f}" == "0.77"
    assert f"{stats.f.sf(13.00, 2, 16):.4f}" == "0.0004"
    # Fine orientation, wavelength: 0.4 stands for 0.039.
    assert f"{stats.f.sf(3.92, 2, 18):.3f}" == "0.039"
    # Coarse orientation: 0.52 with degrees of freedom as printed, or of all ten subjects.
    assert (
        f"{stats.f.sf(0.67, 1.54, 14):.2f}" == f"{stats.f.sf(0.67, 1.54, 1.54 * 9):.2f}" == "0.49"
    )
    assert f"{1.54 * 9:.1f}" == "13.9"


# Table 6.6: t(8) of vibrations and gratings, gratings and dots, vibrations and dots. Its column of
# p is wrong throughout; these are recomputed.
TABLE_6_6 = {
    "square 2 cm": {"3.464": "0.009", "5.657": "0.0005", "1.155": "0.281"},
    "circle 2 cm": {"2.626": "0.030", "4.128": "0.003", "1.512": "0.169"},
    "circle 3 cm": {"3.780": "0.005", "4.082": "0.004", "0.000": "1.000"},
    "plus 2 cm": {"8.315": "<0.001", "5.488": "0.001", "1.633": "0.141"},
    "plus 3 cm": {"3.600": "0.007", "1.835": "0.104", "2.874": "0.021"},
}


@pytest.mark.parametrize("name", TABLE_6_6)
def test_p_of_table_6_6(name):
    for t, p in TABLE_6_6[name].items():
        test_p_of_t_is_as_printed(t, 8, p)


def test_an_f_of_one_degree_is_the_square_of_its_t():
    for t, f in (("5.335", "28.46"), ("2.981", "8.89")):
        assert f"{float(t) ** 2:.2f}" == f
        # What is printed is within what the rounding of both leaves.
    for t, printed in (("5.335", "28.47"), ("2.981", "8.88"), ("2.981", "8.884")):
        (low, high), (least, most) = interval(t), interval(printed)
        assert low**2 <= most
        assert least <= high**2


# Icons: right answers in shape, orientation, wavelength, all three, and answers after 40 s.
ICONS = {
    480: {425: "88.5", 460: "95.8", 426: "88.8", 377: "78.5", 56: "11.7"},
    288: {252: "87.5", 272: "94.4", 222: "77.1", 195: "67.7", 50: "17.4"},
}


@pytest.mark.parametrize("trials", ICONS)
def test_counts_of_icons_are_the_only_ones_that_give_what_is_printed(trials):
    assert trials == {480: 10, 288: 6}[trials] * 48
    for count, printed in ICONS[trials].items():
        found = [n for n in range(trials + 1) if f"{100 * n / trials:.1f}" == printed]
        assert found == [count], printed
