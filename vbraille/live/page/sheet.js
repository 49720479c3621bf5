/**
 * The page to scale: its lines with cells, dots and print, rulers in mm, and the array where the
 * finger is. What stands still is one drawing, and the array another over it.
 */

import { DOTS, distances, dotX, dotY, endOf, placeOf, under } from "./braille.js";
import { fixed, html, put, ruler, svg } from "./drawing.js";
import { onScheme, stepOf, steps } from "./palette.js";

/** @typedef {import("./messages.js").State} State */
/** @typedef {import("./messages.js").Frame} Frame */
/** @typedef {import("./messages.js").LineShown} LineShown */
/** @typedef {import("./braille.js").Distances} Distances */

const LEAST_PX_MM = 3.4; // below that, a part of the line is shown, which follows the finger
const MOST_PX_MM = 9;
const LEFT_PX = 62;
const LEFT_NARROW_PX = 40;
const TOP_PX = 46;
const RIGHT_PX = 14;
const LEAST_FINGER_PX = 32; // to be hit by a real finger

export class Sheet {
  /** @type {State | null} */
  #state = null;
  /** @type {Frame | null} */
  #frame = null;
  #px_mm = 4;
  #left = 0; // what the view shows: the left edge, in mm
  #top = 0;
  #wide = 1;
  #high = 1;
  #most = 0; // the tallest page so far, so that nothing below it jumps
  /** @type {SVGRectElement[]} */
  #contactors = [];
  /** @type {number[]} */
  #steps = [];

  /** @param {HTMLElement} figure */
  constructor(figure) {
    this.still = svg("svg", { "aria-hidden": "true", class: "still" });
    this.moving = svg("svg", { class: "moving" });
    this.marks = svg("g", { class: "marks" });
    this.hairline = svg("g", { class: "hairline" });
    this.array = svg("g", { class: "array", id: "finger" });
    this.moving.append(this.marks, this.hairline, this.array);
    figure.append(html("div", { class: "layers" }, this.still, this.moving));
    const layers = /** @type {HTMLElement} */ (figure.firstElementChild);
    new ResizeObserver(() => this.show(this.#state)).observe(layers);
    onScheme(() => this.show(this.#state));
  }

  /**
   * Where on the page something on the screen is, in mm.
   * @param {MouseEvent} event
   */
  point(event) {
    const box = this.moving.getBoundingClientRect();
    return {
      x: this.#left + (event.clientX - box.left) / this.#px_mm,
      y: this.#top + (event.clientY - box.top) / this.#px_mm,
    };
  }

  /**
   * Draws what stands still.
   * @param {State | null} state
   */
  show(state) {
    this.#state = state;
    const width = this.still.parentElement?.clientWidth ?? 0;
    const array = state?.array;
    if (!state || !array || width === 0) return;
    const d = distances(state);
    const half = (array.columns * array.column_pitch_mm) / 2;
    const ends = d ? state.lines.map((line) => endOf(d, line)) : [];
    const right = Math.max(...ends, ends.length ? 0 : array.travel_mm) + half * 0.6;
    const pad = width < 560 ? LEFT_NARROW_PX : LEFT_PX;
    const from = Math.min(0, ...state.lines.map((line) => line.start_mm)) - half;
    const fit = (width - pad - RIGHT_PX) / (right - from);
    this.#px_mm = Math.min(Math.max(fit, LEAST_PX_MM), MOST_PX_MM);
    this.#wide = width / this.#px_mm;
    const px = 1 / this.#px_mm;
    this.span = { from, right, pad: pad * px };
    const top = Math.min(...state.lines.map((line) => line.top_mm), Infinity);
    const bottom = Math.max(...state.lines.map((line) => line.top_mm + (d ? d.line + this.#below(d) : 0)), -Infinity);
    const first = Number.isFinite(top) ? top : 0;
    const tall = Math.max(Number.isFinite(bottom) ? bottom - first : 0, this.#tallOf(state, d));
    this.#most = state.lines.length ? Math.max(this.#most, tall) : tall;
    if (this.#most > 3 * tall) this.#most = tall;
    this.#top = first - TOP_PX * px;
    this.#high = this.#most + (TOP_PX + 14) * px;
    if (fit >= LEAST_PX_MM) this.#left = from - pad * px;
    this.#draw(state, d, first);
    this.#contact(state);
    this.#look(this.#left);
    if (this.#frame) this.move(state, this.#frame);
  }

  /**
   * Height of what is shown where there are no lines.
   * @param {State} state
   * @param {Distances | null} d
   */
  #tallOf(state, d) {
    const array = /** @type {import("./messages.js").ArrayShown} */ (state.array);
    return Math.max(array.height_mm && !state.lines.length ? array.height_mm : 0, d?.line ?? 0,
      state.lines.length ? 0 : array.rows * array.row_pitch_mm + 6);
  }

  /**
   * @param {State} state
   * @param {Distances | null} d
   * @param {number} first
   */
  #draw(state, d, first) {
    const px = 1 / this.#px_mm;
    const { right } = this.span ?? { right: 0 };
    const from = Math.min(0, ...state.lines.map((line) => line.start_mm));
    const group = svg("g", { "font-size": 12 * px });
    const end = Math.max(right, state.array?.travel_mm && !state.lines.length ? state.array.travel_mm : 0);
    for (const line of d ? state.lines : []) group.append(this.#line(/** @type {Distances} */ (d), line));
    group.append(ruler(Math.floor(from / 10) * 10, end, first - 6 * px, false, this.#px_mm));
    const side = ruler(first, first + this.#most, 0, true, this.#px_mm);
    side.classList.add("side");
    const wide = (this.span?.pad ?? 0) - 4 * px;
    side.prepend(svg("rect", { class: "margin", x: 4 * px - wide, y: first - TOP_PX * px, width: wide, height: this.#high }));
    side.append(svg("text", { x: -4 * px, y: first - 18 * px, "text-anchor": "end", class: "unit" }, "mm"));
    group.append(side);
    this.still.replaceChildren(group);
    this.side = side;
  }

  /**
   * A line: its band, dots and print.
   * @param {Distances} d
   * @param {LineShown} line
   */
  #line(d, line) {
    const px = 1 / this.#px_mm;
    const group = svg("g", { class: line.under ? "line under" : "line", "data-line": line.number });
    const end = Math.max(endOf(d, line), line.start_mm + d.pitch);
    const eight = line.cells.some((mask) => mask > 0x3f);
    const size = Math.min(d.width / 2, d.rows * 0.48);
    // The print has all the room to the dots of the next line, and the band goes around both.
    const over = Math.max(dotY(d, line, 0) - size - line.top_mm - 0.6, 0);
    if (line.under) {
      group.append(svg("rect", {
        class: "band", x: line.start_mm - d.pitch / 4, y: line.top_mm + over, width: end - line.start_mm + d.pitch / 2,
        height: d.line, rx: 4 * px,
      }));
    }
    let raised = "";
    let flat = "";
    line.cells.forEach((mask, cell) => {
      DOTS.slice(0, eight ? 8 : 6).forEach(([column, row], dot) => {
        const [x, y] = [dotX(d, line, cell, column), dotY(d, line, row)];
        if ((mask >> dot) & 1) raised += circle(x, y, size);
        else flat += circle(x, y, Math.min(0.28, size * 0.3));
      });
    });
    group.append(svg("path", { class: "flat", d: flat }), svg("path", { class: "raised", d: raised }));
    const below = dotY(d, line, eight ? 3 : 2) + size;
    const room = d.line - (below - dotY(d, line, 0) + size);
    const height = Math.min(room * 0.74, 16 * px);
    if (height * this.#px_mm >= 7) group.append(this.#print(d, line, below + room * 0.42 + height * 0.34, height));
    return group;
  }

  /**
   * The print, each piece under the cells that stand for it.
   * @param {Distances} d
   * @param {LineShown} line
   * @param {number} y
   * @param {number} height
   */
  #print(d, line, y, height) {
    const group = svg("g", { class: "gloss", "font-size": height });
    for (let cell = 0; cell < line.cells.length; cell++) {
      const [from, to] = line.sources[cell] ?? [0, 0];
      if (to <= from) continue;
      let last = cell;
      while (line.sources[last + 1]?.[0] === from && line.sources[last + 1]?.[1] === to) last++;
      const words = line.text.slice(from, to).trim();
      const room = (last - cell + 1) * d.pitch - 0.8;
      const text = svg("text", {
        x: (dotX(d, line, cell, 0) + dotX(d, line, last, 1)) / 2, y, "text-anchor": "middle",
      }, words);
      if (words.length * height * 0.56 > room) {
        text.setAttribute("textLength", String(room));
        text.setAttribute("lengthAdjust", "spacingAndGlyphs");
      }
      if (words) group.append(text);
      cell = last;
    }
    return group;
  }

  /**
   * Makes the array, as large as it is.
   * @param {State} state
   */
  #contact(state) {
    const array = /** @type {import("./messages.js").ArrayShown} */ (state.array);
    const px = 1 / this.#px_mm;
    const [wide, high] = [array.columns * array.column_pitch_mm, array.rows * array.row_pitch_mm];
    const hit = [Math.max(wide, LEAST_FINGER_PX * px), Math.max(high, LEAST_FINGER_PX * px)];
    this.#contactors = [];
    this.#steps = [];
    const group = svg("g", { class: "contactors" });
    const seats = svg("path", { class: "seats", "stroke-width": 0.5 * px });
    group.append(seats);
    let outline = "";
    if (!state.blind) {
      for (let row = 0; row < array.rows; row++) {
        for (let column = 0; column < array.columns; column++) {
          const mark = svg("rect", {
            x: (column - (array.columns - 1) / 2 - 0.3) * array.column_pitch_mm,
            y: (row - (array.rows - 1) / 2 - 0.32) * array.row_pitch_mm,
            width: 0.6 * array.column_pitch_mm, height: 0.64 * array.row_pitch_mm, visibility: "hidden",
          });
          const [w, h] = [0.6 * array.column_pitch_mm, 0.64 * array.row_pitch_mm];
          outline += `M${mark.getAttribute("x")} ${mark.getAttribute("y")}h${w}v${h}h${-w}z`;
          this.#contactors.push(mark);
          group.append(mark);
        }
      }
    }
    seats.setAttribute("d", outline);
    const frame = { x: -wide / 2, y: -high / 2, width: wide, height: high, rx: 3 * px };
    const grown = { x: frame.x - 3 * px, y: frame.y - 3 * px, width: wide + 6 * px, height: high + 6 * px, rx: 5 * px };
    this.array.replaceChildren(
      svg("rect", { class: "hit", x: -hit[0] / 2, y: -hit[1] / 2, width: hit[0], height: hit[1] }),
      svg("rect", { class: "ring", ...grown }),
      svg("rect", { class: "frame", ...frame }),
      group,
    );
    const to = this.#top + (TOP_PX - 6) * px;
    this.hairline.replaceChildren(
      svg("path", { d: `M0 ${to}V${this.#top + this.#high}`, class: "thread" }),
      svg("path", { d: `M0 ${to}l${-5 * px} ${-8 * px}h${10 * px}z`, class: "pointer" }),
    );
    this.marks.replaceChildren(svg("rect", { class: "word" }), svg("rect", { class: "cell" }));
  }

  /**
   * Turns the view so that it begins at a place.
   * @param {number} left
   */
  #look(left) {
    this.#left = left;
    const box = [left, this.#top, this.#wide, this.#high].map((value) => value.toFixed(3)).join(" ");
    const height = String(Math.round(this.#high * this.#px_mm));
    for (const drawing of [this.still, this.moving]) {
      put(drawing, "viewBox", box);
      put(drawing, "height", height);
    }
    const at = left + (this.span?.pad ?? 0) - 10 / this.#px_mm;
    if (this.side) put(this.side, "transform", `translate(${at.toFixed(3)} 0)`);
  }

  /**
   * Moves the array to where a frame has it.
   * @param {State} state
   * @param {Frame} frame
   */
  move(state, frame) {
    this.#frame = frame;
    if (!state.array || !this.span) return;
    const known = Number.isFinite(frame.x_mm);
    put(this.moving, "visibility", known ? "visible" : "hidden");
    if (!known) return;
    const { x, y, theta } = placeOf(state, frame);
    this.#follow(x);
    const turn = theta ? ` rotate(${((-theta * 180) / Math.PI).toFixed(2)})` : "";
    put(this.array, "transform", `translate(${x.toFixed(2)} ${y.toFixed(2)})${turn}`);
    put(this.hairline, "transform", `translate(${x.toFixed(2)} 0)`);
    this.#mark(state, frame);
    this.#deflect(state, frame);
  }

  /**
   * Keeps the finger in view where the line is longer than that: by leaps, not by sliding.
   * @param {number} x
   */
  #follow(x) {
    const { from, right, pad } = this.span ?? { from: 0, right: 0, pad: 0 };
    const inner = this.#wide - pad - RIGHT_PX / this.#px_mm;
    if (inner >= right - from) return;
    const at = (x - this.#left - pad) / inner;
    if (at > 0.12 && at < 0.82) return;
    const left = Math.min(Math.max(x - 0.25 * inner, from), right - inner) - pad;
    if (Math.abs(left - this.#left) > 1e-6) this.#look(left);
  }

  /**
   * @param {State} state
   * @param {Frame} frame
   */
  #mark(state, frame) {
    const [word, cell] = this.marks.children;
    if (!word || !cell) return;
    const d = distances(state);
    const here = state.blind || !d ? null : under(state, frame);
    const show = (/** @type {Element} */ mark, /** @type {[number, number] | null} */ cells) => {
      put(mark, "visibility", cells && here && d ? "inherit" : "hidden");
      if (!cells || !here || !d) return;
      const [from, to] = [dotX(d, here.line, cells[0], 0) - d.width / 2, dotX(d, here.line, cells[1], 1) + d.width / 2];
      const thick = (mark === cell ? 2.6 : 1.2) / this.#px_mm;
      put(mark, "x", from.toFixed(2));
      put(mark, "width", (to - from).toFixed(2));
      put(mark, "y", (here.line.top_mm + d.line + this.#below(d) - thick).toFixed(2));
      put(mark, "height", thick.toFixed(3));
    };
    show(cell, here && here.cell >= 0 ? [here.cell, here.cell] : null);
    show(word, here && here.word[1] > here.word[0] ? cellsOf(here.line, here.word) : null);
  }

  /**
   * How far below a line its band goes, to the dots of the next.
   * @param {Distances} d
   */
  #below(d) {
    return Math.max((d.line - d.width) / 2 - d.rows - 0.6, 0);
  }

  /**
   * @param {State} state
   * @param {Frame} frame
   */
  #deflect(state, frame) {
    const array = /** @type {import("./messages.js").ArrayShown} */ (state.array);
    const fits = frame.deflections.length === this.#contactors.length;
    const palette = steps();
    const way = (array.rest_right ? -1 : 1) * array.swing_mm;
    this.#contactors.forEach((mark, n) => {
      const step = fits ? stepOf(frame.deflections[n]) : 0;
      if (this.#steps[n] === step) return;
      this.#steps[n] = step;
      mark.setAttribute("visibility", step ? "inherit" : "hidden"); // at rest, the dots below are seen
      mark.setAttribute("fill", palette[step]);
      mark.setAttribute("transform", `translate(${((frame.deflections[n] - 0.5) * way).toFixed(3)})`);
    });
  }

  /** Words for the scale. */
  get scale() {
    return `1 mm is ${fixed(this.#px_mm, 1)} pixels here`;
  }
}

/**
 * The first and the last cell of a piece of the text; null if it has none.
 * @param {LineShown} line
 * @param {[number, number]} piece
 * @returns {[number, number] | null}
 */
function cellsOf(line, [from, to]) {
  const inside = line.sources.flatMap(([a, b], cell) => (b > a && a < to && b > from ? [cell] : []));
  return inside.length ? [inside[0], inside[inside.length - 1]] : null;
}

/**
 * @param {number} x
 * @param {number} y
 * @param {number} r
 */
export const circle = (x, y, r) =>
  `M${(x - r).toFixed(2)} ${y.toFixed(2)}a${r} ${r} 0 1 0 ${2 * r} 0a${r} ${r} 0 1 0 ${-2 * r} 0`;
