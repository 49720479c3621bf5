"""Pictures of the live view for the README: ``python -m tests.live.screenshots [NAME …]``."""

from __future__ import annotations

import io
import sys
from pathlib import Path
from typing import NamedTuple

from PIL import Image
from playwright.sync_api import sync_playwright

from tests.live.page.showing import Served, launch, until
from tests.live.scenes import Scene

FOLDER = Path(__file__).parents[2] / "docs/images"
MOST_BYTES = 150_000
_FILLED_MS = 5600  # until the traces are full
# Stops by a button when six actuators have moved by half of their swing.
_STOP = """(button) => new Promise((done) => {
  const look = () => {
    if (vbraille.last.deflections.filter((value) => value > 0.5).length < 6) {
      return requestAnimationFrame(look);
    }
    document.querySelector(button).click();
    done();
  };
  look();
})"""


class Picture(NamedTuple):
    """How a picture is taken."""

    scene: str = "live"
    scheme: str = "light"
    width: int = 1280
    height: int = 1020
    scale: int = 1


PICTURES = {
    "light": Picture(),
    "dark": Picture(scheme="dark"),
    "phone": Picture(width=390, height=1000, scale=2),
    "playback": Picture(scene="playback"),
}


def main(names: list[str]) -> None:
    """Take the pictures."""
    FOLDER.mkdir(exist_ok=True)
    with sync_playwright() as playwright:
        browser = launch(playwright)
        for name in names or list(PICTURES):
            how = PICTURES[name]
            with Served(Scene(how.scene)) as served:
                context = browser.new_context(
                    viewport={"width": how.width, "height": how.height},
                    color_scheme=how.scheme,  # pyright: ignore[reportArgumentType]
                    device_scale_factor=how.scale,
                )
                page = context.new_page()
                page.goto(served.steering)
                until(page, "Boolean(window.vbraille && vbraille.drawn)")
                if how.scene == "playback":
                    page.get_by_role("button", name="Play", exact=True).click()
                page.wait_for_timeout(_FILLED_MS)
                page.evaluate(_STOP, "#transport .play" if how.scene == "playback" else "#freeze")
                page.wait_for_timeout(200)
                taken = page.screenshot()
                context.close()
            image = Image.open(io.BytesIO(taken)).convert("RGB")
            # Rare colours are what the picture is about.
            few = image.quantize(256, method=Image.Quantize.MAXCOVERAGE, dither=Image.Dither.NONE)
            few.save(FOLDER / f"live-{name}.png", optimize=True)
            size = (FOLDER / f"live-{name}.png").stat().st_size
            print(f"docs/images/live-{name}.png: {size / 1000:.0f} kB")
            assert size < MOST_BYTES
        browser.close()


if __name__ == "__main__":
    main(sys.argv[1:])
