"""Colours hold in the three common colour blindnesses and in grey."""

import re
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest

import vbraille.live

STEPS = 20
# Machado, Oliveira and Fernandes 2009, severity 1; they work on linear light. Grey is by luminance.
LUMINANCE = (0.2126, 0.7152, 0.0722)
EYES = {
    "all": np.eye(3),
    "protanopia": [
        [0.152286, 1.052583, -0.204868],
        [0.114503, 0.786281, 0.099216],
        [-0.003882, -0.048116, 1.051998],
    ],
    "deuteranopia": [
        [0.367322, 0.860646, -0.227968],
        [0.280085, 0.672501, 0.047413],
        [-0.011820, 0.042940, 0.968881],
    ],
    "tritanopia": [
        [1.255528, -0.076749, -0.178779],
        [-0.078411, 0.930809, 0.147602],
        [0.004733, 0.691367, 0.303900],
    ],
    "grey": [LUMINANCE] * 3,
}
TO_XYZ = np.array([[0.4124, 0.3576, 0.1805], [0.2126, 0.7152, 0.0722], [0.0193, 0.1192, 0.9505]])


def linear(hex_colour):
    value = np.array([int(hex_colour[n : n + 2], 16) for n in (1, 3, 5)]) / 255
    return np.where(value <= 0.04045, value / 12.92, ((value + 0.055) / 1.055) ** 2.4)


def lab(rgb):
    ratio = TO_XYZ @ np.clip(rgb, 0, 1) / [0.9505, 1.0, 1.089]
    f = np.where(ratio > 0.008856, np.cbrt(ratio), 7.787 * ratio + 16 / 116)
    return np.array([116 * f[1] - 16, 500 * (f[0] - f[1]), 200 * (f[1] - f[2])])


def contrast(one, other):
    bright, dim = sorted((LUMINANCE @ linear(c) for c in (one, other)), reverse=True)
    return (bright + 0.05) / (dim + 0.05)


def palette(scheme):
    """Colours as `palette.js` has them: the stops of the ramp, and those with names."""
    text = (Path(vbraille.live.__file__).parent / "page/palette.js").read_text()
    body = re.search(rf"export const {scheme} = {{(.*?)}};", text, re.DOTALL)[1]
    stops = re.findall("#[0-9a-f]{6}", re.search(r"ramp: \[(.*?)\]", body)[1])
    return stops, dict(re.findall(r'(\w+): "(#[0-9a-f]{6})"', body))


def paper(scheme):
    text = (Path(vbraille.live.__file__).parent / "page/style.css").read_text()
    return re.findall("--paper: (#[0-9a-f]{6})", text)[scheme == "DARK"]


def ramp(stops):
    """The steps between the stops, as the page makes them."""
    places = np.linspace(0, len(stops) - 1, STEPS + 1)
    channels = np.array([[int(stop[n : n + 2], 16) for n in (1, 3, 5)] for stop in stops])
    mixed = [np.interp(places, range(len(stops)), channels[:, n]).round() for n in range(3)]
    return ["#" + "".join(f"{int(v):02x}" for v in colour) for colour in zip(*mixed, strict=True)]


@pytest.mark.parametrize("scheme", ["LIGHT", "DARK"])
@pytest.mark.parametrize("eye", EYES)
def test_steps_of_deflection_can_be_told_apart_and_keep_their_order(scheme, eye):
    seen = [lab(np.array(EYES[eye]) @ linear(colour)) for colour in ramp(palette(scheme)[0])]
    apart = [np.linalg.norm(b - a) for a, b in pairwise(seen)]
    assert min(apart) > 2.3  # a difference that is just noticed
    lightness = [colour[0] for colour in seen]
    assert sorted(lightness, reverse=scheme == "LIGHT") == lightness


@pytest.mark.parametrize("scheme", ["LIGHT", "DARK"])
@pytest.mark.parametrize("eye", [eye for eye in EYES if eye != "grey"])
def test_stretched_and_pressed_have_two_hues_for_every_eye(scheme, eye):
    """In grey the shape tells them: what is stretched stands and is filled."""
    named = palette(scheme)[1]
    one, other = (lab(np.array(EYES[eye]) @ linear(named[name])) for name in ("stretch", "press"))
    assert np.linalg.norm(one - other) > 25


@pytest.mark.parametrize("scheme", ["LIGHT", "DARK"])
def test_what_is_measured_stands_out_from_the_paper(scheme):
    for name, colour in palette(scheme)[1].items():
        assert contrast(colour, paper(scheme)) > 4.5, name
