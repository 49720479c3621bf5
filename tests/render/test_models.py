import subprocess
import sys

import pytest

from tests.shown import STRESS2_ARRAY, VBD_ARRAY
from vbraille import geometry
from vbraille.render import (
    MAPPINGS,
    MODELS,
    STRESS2,
    VBD,
    Profile,
    Tuning,
    single_row,
)


def test_models_by_name():
    assert MODELS == {"vbd": VBD, "stress2": STRESS2}
    assert (VBD.title, STRESS2.title) == ("VBD", "STReSS²")


def test_the_vbd_as_the_source_has_it():
    assert VBD.display is VBD_ARRAY
    assert VBD.style.profile is Profile.HALF_SINE
    assert VBD.style.mapping == single_row(1)
    assert VBD.style.geometry is geometry.VBD
    assert VBD.style.tuning == Tuning(texture=0.0, contrast=1.0)
    assert VBD.display.rest_side == "left"


def test_the_stress2_as_the_source_prefers_it():
    assert STRESS2.display is STRESS2_ARRAY
    assert STRESS2.style.profile is Profile.RAISED_COSINE
    assert STRESS2.style.mapping is MAPPINGS["alternate"]
    assert STRESS2.style.geometry is geometry.STRESS2
    assert STRESS2.style.tuning == Tuning(texture=1.0, contrast=1.0, cycles=7)
    assert STRESS2.display.rest_side == "right"


@pytest.mark.parametrize("model", MODELS.values(), ids=MODELS)
def test_a_model_fits_its_array(model):
    assert model.style.mapping.rows == model.display.rows


@pytest.mark.parametrize("cycles", [1, 7, 11])
def test_the_texture_of_the_vbd_has_an_eighth_of_the_wavelength(cycles):
    # The dot is half a wave of 2 W; k is the STReSS²'s alone.
    assert Profile.HALF_SINE.texture_period_mm(2.0, cycles) == 2 * 2.0 / 8


@pytest.mark.parametrize(("cycles", "period_mm"), [(1, 2.6), (5, 0.52), (7, 2 * 1.3 / 7)])
def test_the_texture_of_the_stress2_has_k_waves_a_dot(cycles, period_mm):
    assert Profile.RAISED_COSINE.texture_period_mm(2.6, cycles) == pytest.approx(period_mm)


def test_models_can_be_asked_without_compiling_kernels():
    loaded = subprocess.run(
        [sys.executable, "-c", "import sys, vbraille.render; print('numba' in sys.modules)"],
        capture_output=True,
        text=True,
        check=True,
    )
    assert loaded.stdout.strip() == "False"
