"""A reader of drawings."""

import pytest

from tests.scene.svg.plans import NS
from vbraille.scene.svg.drawing import read_svg


@pytest.fixture
def read(tmp_path):
    """Read a drawing of 100 by 50 mm whose units are millimetres."""

    def reading(inside, head='width="100mm" height="50mm" viewBox="0 0 100 50"', looks=None):
        path = tmp_path / "plan.svg"
        path.write_text(f"<svg {NS} {head}>\n{inside}\n</svg>")
        return read_svg(path, looks)

    return reading
