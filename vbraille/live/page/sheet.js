/**
 * The page to scale: its lines with cells, dots and print, rulers in mm, and the array where the
 * finger is. What stands still is one drawing, and the array another that is moved over it as a
 * whole, so that neither is drawn again for that.
 */

import { DOTS, distances, dotX, dotY, endOf, placeOf, under } from "./braille.js";
import { Canvas, onSharpness, whole } from "./canvas.js";
import { fixed, html, put, ruler, svg } from "./drawing.js";
import { onScheme, stepOf, steps } from "./palette.js";

/** @typedef {import("./messages.js").State} State */
/** @typedef {import("./messages.js").Frame} Frame */
/** @typedef {import("./messages.js").LineShown} LineShown */
/** @typedef {import("./braille.js").Distances} Distances */

const LEAST_PX_MM = 2.5; // below that, a part of the line is shown, which follows the finger
const MOST_PX_MM = 9;
const LEFT_PX = 62;
const LEFT_NARROW_PX = 40;
const TOP_PX = 46;
const RIGHT_PX = 14;
const LEAST_FINGER_PX = 32; // to be hit by a real finger

/**
 * A tactile picture from above, on its canvas, with the layers that are off drawn faintly.
 * @param {import("./messages.js").SceneShown} scene
 */
function picture(scene) {
  const { width_mm: width, height_mm: height, image, off_image: off } = scene;
  const at = { x: -scene.left_mm, y: -scene.top_mm, width, height, preserveAspectRatio: "none" };
  return svg("g", { class: "scene" }, svg("rect", { class: "canvas", x: at.x, y: at.y, width, height }),
    ...(image ? [svg("image", { ...at, href: image })] : []),
    ...(off ? [svg("image", { ...at, href: off, class: "off" })] : []));
}

/**
 * A picture that is larger than the carriage goes: what that reaches.
 * @param {import("./messages.js").SceneShown} scene
 * @param {import("./messages.js").ArrayShown} array
 */
function within(scene, array) {
  const reach = { width: Math.max(array.travel_mm, 1), height: array.height_mm || scene.height_mm };
  return svg("svg", { ...reach, overflow: "hidden" }, picture(scene));
}

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
  #contactors = new Canvas(false);
  /** @type {number[]} */
  #steps = []; // the colour in which each contactor is drawn; it is not moved by less, either
  #moved = ""; // what stands in the drawing, so that only what changes is touched
  #marked = "";
  /** @type {boolean | null} */
  #known = null;

  /** @param {HTMLElement} figure */
  constructor(figure) {
    this.still = svg("svg", { "aria-hidden": "true", class: "still" });
    this.marks = html("div", { class: "marks" }, html("div"), html("div"));
    this.hairline = svg("svg", { class: "hairline", "aria-hidden": "true" });
    this.outline = svg("svg", { "aria-hidden": "true" });
    this.array = html("div", { class: "array", id: "finger" }, this.outline, this.#contactors.element);
    this.moving = html("div", { class: "moving" }, this.marks, this.hairline, this.array);
    figure.append(html("div", { class: "layers" }, this.still, this.moving));
    const layers = /** @type {HTMLElement} */ (figure.firstElementChild);
    new ResizeObserver(() => this.show(this.#state)).observe(layers);
    onScheme(() => this.show(this.#state));
    onSharpness(() => this.show(this.#state));
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
    if (ends.length) ends.push(...state.figures.map((figure) => figure.width_mm - figure.left_mm));
    const right = Math.max(...ends, ends.length ? 0 : array.travel_mm) + half * 0.6;
    const pad = width < 560 ? LEFT_NARROW_PX : LEFT_PX;
    const from = Math.min(0, ...state.lines.map((line) => line.start_mm)) - half;
    const fit = (width - pad - RIGHT_PX) / (right - from);
    this.#px_mm = Math.min(Math.max(fit, LEAST_PX_MM), MOST_PX_MM);
    this.#wide = width / this.#px_mm;
    const px = 1 / this.#px_mm;
    this.span = { from, right, pad: pad * px };
    const top = Math.min(...state.lines.map((line) => line.top_mm), Infinity);
    const bottoms = state.figures.map((figure) => figure.height_mm - figure.top_mm);
    const bottom = Math.max(...state.lines.map((line) => line.top_mm + (d ? d.line + this.#below(d) : 0)), ...bottoms, -Infinity);
    const first = Number.isFinite(top) ? top : 0;
    const tall = Math.max(Number.isFinite(bottom) ? bottom - first : 0, this.#tallOf(state, d));
    this.#most = state.lines.length ? Math.max(this.#most, tall) : tall;
    if (this.#most > 3 * tall) this.#most = tall;
    this.#top = first - TOP_PX * px;
    this.#high = Math.ceil(this.#most * this.#px_mm + TOP_PX + 14) * px;
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
      array.height_mm || (state.scene?.height_mm ?? 0),
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
    if (state.scene && state.array) group.append(within(state.scene, state.array));
    group.append(...state.figures.map(picture));
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
    this.#steps = [];
    this.#moved = this.#marked = "";
    let seats = "";
    const [w, h] = [0.6 * array.column_pitch_mm, 0.64 * array.row_pitch_mm];
    for (let row = 0; row < array.rows && !state.blind; row++) {
      for (let column = 0; column < array.columns; column++) {
        const [x, y] = this.#seat(array, row, column);
        seats += `M${x} ${y}h${w}v${h}h${-w}z`;
      }
    }
    const frame = { x: -wide / 2, y: -high / 2, width: wide, height: high, rx: 3 * px };
    const grown = { x: frame.x - 3 * px, y: frame.y - 3 * px, width: wide + 6 * px, height: high + 6 * px, rx: 5 * px };
    // As wide as an even number of pixels, so that its middle falls on a whole one.
    const even = (/** @type {number} */ mm) => 2 * Math.ceil((mm * this.#px_mm) / 2 + 5);
    const [box, tall] = [even(hit[0]), even(hit[1])];
    sized(this.outline, -box / 2, -tall / 2, box, tall, px);
    this.outline.replaceChildren(
      svg("rect", { class: "hit", x: -hit[0] / 2, y: -hit[1] / 2, width: hit[0], height: hit[1] }),
      svg("rect", { class: "ring", ...grown }),
      svg("rect", { class: "frame", ...frame }),
      svg("path", { class: "seats", "stroke-width": 0.5 * px, d: seats }),
    );
    this.#contactors.fit(-box / 2 * px, -tall / 2 * px, box, tall, this.#px_mm);
    const { style: canvas } = this.#contactors.element;
    [canvas.left, canvas.top] = [`${-box / 2}px`, `${-tall / 2}px`];
    const to = TOP_PX - 6;
    const down = Math.round(this.#high * this.#px_mm);
    sized(this.hairline, -6, 0, 12, down, 1);
    this.hairline.replaceChildren(
      svg("path", { d: `M0 ${to}V${down}`, class: "thread" }),
      svg("path", { d: `M0 ${to}l-5 -8h10z`, class: "pointer" }),
    );
  }

  /**
   * The upper left corner of a contactor in the middle of its swing, from the array's middle.
   * @param {import("./messages.js").ArrayShown} array
   * @param {number} row
   * @param {number} column
   */
  #seat(array, row, column) {
    return [
      (column - (array.columns - 1) / 2 - 0.3) * array.column_pitch_mm,
      (row - (array.rows - 1) / 2 - 0.32) * array.row_pitch_mm,
    ];
  }

  /**
   * Turns the view so that it begins at a place.
   * @param {number} left
   */
  #look(left) {
    this.#left = left;
    const box = [left, this.#top, this.#wide, this.#high].map((value) => value.toFixed(3)).join(" ");
    const height = String(Math.round(this.#high * this.#px_mm));
    put(this.still, "viewBox", box);
    put(this.still, "height", height);
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
    if (known !== this.#known) this.moving.style.visibility = (this.#known = known) ? "visible" : "hidden";
    if (!known) return;
    const { x, y, theta } = placeOf(state, frame);
    this.#follow(x);
    const [right, down] = [whole((x - this.#left) * this.#px_mm), whole((y - this.#top) * this.#px_mm)];
    const turn = theta ? ` rotate(${(-theta).toFixed(4)}rad)` : "";
    const moved = `translate(${right}px, ${down}px)${turn}`;
    if (moved !== this.#moved) {
      this.array.style.transform = this.#moved = moved;
      this.hairline.style.transform = `translate(${right}px)`;
    }
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
    const [word, cell] = /** @type {HTMLCollectionOf<HTMLElement>} */ (this.marks.children);
    const d = distances(state);
    const here = state.blind || !d ? null : under(state, frame);
    const marked = here && d ? `${here.line.number} ${here.line.start_mm} ${here.cell} ${this.#left}` : "";
    if (marked === this.#marked) return;
    this.#marked = marked;
    const show = (/** @type {HTMLElement} */ mark, /** @type {number} */ thick, /** @type {[number, number] | null} */ cells) => {
      mark.hidden = !cells;
      if (!cells || !here || !d) return;
      const [from, to] = [dotX(d, here.line, cells[0], 0) - d.width / 2, dotX(d, here.line, cells[1], 1) + d.width / 2];
      const bottom = (here.line.top_mm + d.line + this.#below(d) - this.#top) * this.#px_mm;
      mark.style.left = `${((from - this.#left) * this.#px_mm).toFixed(2)}px`;
      mark.style.width = `${((to - from) * this.#px_mm).toFixed(2)}px`;
      mark.style.top = `${(bottom - thick).toFixed(2)}px`;
      mark.style.height = `${thick}px`;
    };
    show(cell, 2.6, here && here.cell >= 0 ? [here.cell, here.cell] : null);
    show(word, 1.2, here && here.word[1] > here.word[0] ? cellsOf(here.line, here.word) : null);
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
    const palette = steps();
    const way = (array.rest_right ? -1 : 1) * array.swing_mm;
    const fits = frame.deflections.length === array.rows * array.columns;
    const wanted = fits ? Array.from(frame.deflections, stepOf) : [];
    if (wanted.length === this.#steps.length && wanted.every((step, n) => step === this.#steps[n])) return;
    this.#steps = wanted;
    const pen = this.#contactors.begin();
    const [w, h] = [0.6 * array.column_pitch_mm, 0.64 * array.row_pitch_mm];
    wanted.forEach((step, n) => {
      if (!step) return; // at rest, the dots below are seen
      const [x, y] = this.#seat(array, Math.floor(n / array.columns), n % array.columns);
      pen.fillStyle = palette[step];
      pen.fillRect(x + (frame.deflections[n] - 0.5) * way, y, w, h);
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
 * Gives a small drawing its place around the point that it is moved by, and its scale.
 * @param {SVGSVGElement} drawing
 * @param {number} left in pixels
 * @param {number} top
 * @param {number} wide
 * @param {number} high
 * @param {number} unit of its coordinates, for a pixel
 */
function sized(drawing, left, top, wide, high, unit) {
  drawing.setAttribute("width", String(wide));
  drawing.setAttribute("height", String(high));
  drawing.setAttribute("viewBox", [left, top, wide, high].map((px) => px * unit).join(" "));
  drawing.style.left = `${left}px`;
  drawing.style.top = `${top}px`;
}

/**
 * @param {number} x
 * @param {number} y
 * @param {number} r
 */
const circle = (x, y, r) =>
  `M${(x - r).toFixed(2)} ${y.toFixed(2)}a${r} ${r} 0 1 0 ${2 * r} 0a${r} ${r} 0 1 0 ${-2 * r} 0`;
