/**
 * What changes with each frame is drawn in pixels, over or under a drawing in mm that stands still:
 * that takes a browser a fraction of the time. Such a canvas is as sharp as the screen, at every zoom,
 * and sharper on paper.
 */

import { html } from "./drawing.js";

const PAPER = 4; // pixels of a canvas for one of the page when it is printed
const MOST = 4; // beyond that no eye sees a difference, and memory grows by the square

/** @type {Set<() => void>} */
const redraw = new Set();
let printing = false;

/** Pixels of a canvas for one of the page. */
const sharpness = () => Math.min(printing ? Math.max(PAPER, devicePixelRatio) : devicePixelRatio, MOST);

/**
 * A number of pixels of the page as it falls on whole pixels of the screen.
 * @param {number} px
 */
export const whole = (px) => Math.round(px * devicePixelRatio) / devicePixelRatio;

/**
 * Call when canvases have to be made anew, in another sharpness.
 * @param {() => void} then
 */
export function onSharpness(then) {
  redraw.add(then);
}

function sharpen() {
  for (const then of redraw) then();
}

/** The screen's pixels change with the zoom, and when the window goes to another screen. */
function watch() {
  const same = matchMedia(`(resolution: ${devicePixelRatio}dppx)`);
  same.addEventListener("change", () => (watch(), sharpen()), { once: true });
}
watch();
addEventListener("beforeprint", () => ((printing = true), sharpen()));
addEventListener("afterprint", () => ((printing = false), sharpen()));

export class Canvas {
  #scale = 1;
  #left = 0;
  #top = 0;

  /** @param {boolean} ground whether it has a ground of its own; nothing beneath is seen then */
  constructor(ground) {
    this.ground = ground;
    this.element = html("canvas", { "aria-hidden": "true", hidden: "" });
    this.pen = /** @type {CanvasRenderingContext2D} */ (this.element.getContext("2d", { alpha: !ground }));
  }

  /**
   * Gives the canvas its size, and says what it shows.
   * @param {number} left its left edge, in mm
   * @param {number} top
   * @param {number} wide_px
   * @param {number} high_px
   * @param {number} px_mm
   */
  fit(left, top, wide_px, high_px, px_mm) {
    const sharp = sharpness();
    [this.#left, this.#top, this.#scale] = [left, top, px_mm * sharp];
    const { element } = this;
    element.hidden = false; // before that, one with a ground would be black
    element.width = Math.max(Math.ceil(wide_px * sharp), 1);
    element.height = Math.max(Math.ceil(high_px * sharp), 1);
    element.style.width = `${element.width / sharp}px`;
    element.style.height = `${element.height / sharp}px`;
  }

  /**
   * Wipes it; then the pen draws in mm.
   * @param {string} paper the colour of its ground
   */
  begin(paper = "") {
    const { pen } = this;
    pen.setTransform(1, 0, 0, 1, 0, 0);
    if (this.ground) {
      pen.fillStyle = printing ? "#fff" : paper;
      pen.fillRect(0, 0, this.element.width, this.element.height);
    } else pen.clearRect(0, 0, this.element.width, this.element.height);
    const scale = this.#scale;
    pen.setTransform(scale, 0, 0, scale, -this.#left * scale, -this.#top * scale);
    return pen;
  }
}
