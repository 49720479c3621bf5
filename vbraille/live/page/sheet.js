/**
 * The page to scale: its lines with cells, dots and print, pictures, rulers in mm, and the array where
 * the finger is. What stands still is one drawing; the array is moved over it as a whole, so that
 * neither is drawn again for that.
 */

import { DOTS, distances, dotX, dotY, endOf, placeOf, under } from "./braille.js";
import { onScheme, stepOf, steps } from "./colours.js";
import { Canvas, clamp, html, onResolution, put, ruler, svg } from "./elements.js";

const LEAST_PX_MM = 2.5; // below that a part of the line is shown, which follows the finger
const MOST_PX_MM = 9;
const TOP_PX = 46;
const RIGHT_PX = 14;
const LEAST_FINGER_PX = 32; // to be hit by a real finger

/** A number of pixels of the page that falls on whole pixels of the screen. */
const whole = (px) => Math.round(px * devicePixelRatio) / devicePixelRatio;

const circle = (x, y, r) => `M${(x - r).toFixed(2)} ${y.toFixed(2)}a${r} ${r} 0 1 0 ${2 * r} 0a${r} ${r} 0 1 0 ${-2 * r} 0`;

/** A tactile picture from above, on its canvas. */
function picture(scene) {
  const at = { x: -scene.left_mm, y: -scene.top_mm, width: scene.width_mm, height: scene.height_mm };
  const image = scene.image ? [svg("image", { ...at, href: scene.image, class: "on", preserveAspectRatio: "none" })] : [];
  return svg("g", { class: "scene" }, svg("rect", { class: "canvas", ...at }), ...image);
}

/** The first and the last cell of a piece of the print; null if it has none. */
function cellsOf(line, piece) {
  const [from, to] = piece;
  const inside = line.sources.flatMap(([a, b], cell) => (b > a && a < to && b > from ? [cell] : []));
  return inside.length ? [inside[0], inside[inside.length - 1]] : null;
}

/** Gives a small drawing its place in pixels around the point that it is moved by. */
function size(drawing, left, top, wide, high, unit) {
  const box = [left, top, wide, high].map((px) => px * unit).join(" ");
  for (const [name, value] of Object.entries({ width: wide, height: high, viewBox: box })) drawing.setAttribute(name, String(value));
  [drawing.style.left, drawing.style.top] = [`${left}px`, `${top}px`];
}

export class Sheet {
  #state = null;
  #frame = null;
  #px_mm = 4;
  #view = { left: 0, top: 0, wide: 1, high: 1 }; // what is seen, in mm
  #most = 0; // height of the tallest page so far, so that nothing below it jumps
  #contactors = new Canvas(false);
  #steps = []; // the colour in which each contactor is drawn; it is not moved by less, either
  #moved = "";
  #marked = "";
  #known = null;

  constructor(figure) {
    this.still = svg("svg", { "aria-hidden": "true", class: "still" });
    this.marks = html("div", { class: "marks" }, html("div"), html("div"));
    this.hairline = svg("svg", { class: "hairline", "aria-hidden": "true" });
    this.outline = svg("svg", { "aria-hidden": "true" });
    this.array = html("div", { class: "array", id: "finger" }, this.outline, this.#contactors.element);
    this.moving = html("div", { class: "moving" }, this.marks, this.hairline, this.array);
    figure.append(html("div", { class: "layers" }, this.still, this.moving));
    const again = () => this.show(this.#state);
    new ResizeObserver(again).observe(figure);
    onScheme(again);
    onResolution(again);
  }

  /** Where on the page something on the screen is, in mm. */
  point(event) {
    const box = this.moving.getBoundingClientRect();
    return { x: this.#view.left + (event.clientX - box.left) / this.#px_mm, y: this.#view.top + (event.clientY - box.top) / this.#px_mm };
  }

  /** Draws what stands still. */
  show(state) {
    this.#state = state;
    const width = this.still.parentElement.clientWidth;
    if (!state?.array || !width) return;
    const { array, lines } = state;
    const d = distances(state);
    const half = (array.columns * array.column_pitch_mm) / 2;
    const start = Math.min(0, ...lines.map((line) => line.start_mm));
    const ends = d && lines.length ? [0, ...lines.map((line) => endOf(d, line))] : [array.travel_mm];
    const right = Math.max(...ends) + 0.6 * half;
    const pad_px = width < 560 ? 40 : 62;
    const fit = (width - pad_px - RIGHT_PX) / (right - start + half);
    const px_mm = (this.#px_mm = clamp(fit, LEAST_PX_MM, MOST_PX_MM));
    this.span = { from: start - half, right, pad: pad_px / px_mm, start };
    const first = lines.length ? Math.min(...lines.map((line) => line.top_mm)) : 0;
    const bottoms = lines.map((line) => line.top_mm + (d ? d.line + this.#below(d) : 0));
    const alone = array.height_mm || state.scene?.height_mm || array.rows * array.row_pitch_mm + 6;
    const tall = Math.max(...bottoms.map((bottom) => bottom - first), d?.line ?? 0, lines.length ? array.height_mm : alone);
    this.#most = lines.length && this.#most < 3 * tall ? Math.max(this.#most, tall) : tall;
    const left = fit < LEAST_PX_MM ? this.#view.left : this.span.from - this.span.pad;
    this.#view = { left, top: first - TOP_PX / px_mm, wide: width / px_mm, high: Math.ceil(this.#most * px_mm + TOP_PX + 14) / px_mm };
    this.#draw(state, d, first);
    this.#contact(state);
    this.#look(left);
    if (this.#frame) this.move(state, this.#frame);
  }

  #draw(state, d, first) {
    const px = 1 / this.#px_mm;
    const { start, right, pad } = this.span;
    const group = svg("g", { "font-size": 12 * px });
    if (state.scene) {
      // A picture that is larger than the carriage goes: what that reaches.
      const reach = { width: Math.max(state.array.travel_mm, 1), height: state.array.height_mm || state.scene.height_mm };
      group.append(svg("svg", { ...reach, overflow: "hidden" }, picture(state.scene)));
    }
    group.append(...(d ? state.lines.map((line) => this.#line(d, line)) : []));
    group.append(ruler(Math.floor(start / 10) * 10, right, first - 6 * px, false, this.#px_mm));
    this.side = ruler(first, first + this.#most, 0, true, this.#px_mm);
    const margin = { x: 8 * px - pad, y: first - TOP_PX * px, width: pad - 4 * px, height: this.#view.high };
    this.side.prepend(svg("rect", { class: "margin", ...margin }));
    this.side.append(svg("text", { x: -4 * px, y: first - 18 * px, "text-anchor": "end", class: "unit" }, "mm"));
    this.still.replaceChildren(svg("g", {}, group, this.side));
    this.side.setAttribute("font-size", String(12 * px));
  }

  /** A line: its band, dots and print. */
  #line(d, line) {
    const px = 1 / this.#px_mm;
    const group = svg("g", { class: line.under ? "line under" : "line", "data-line": line.number });
    const rows = line.cells.some((mask) => mask > 0x3f) ? 8 : 6;
    const radius = Math.min(d.width / 2, d.rows * 0.48);
    if (line.under) {
      // The print has all the room to the dots of the next line, and the band goes around both.
      const over = Math.max(dotY(d, line, 0) - radius - line.top_mm - 0.6, 0);
      const width = Math.max(endOf(d, line), line.start_mm + d.pitch) - line.start_mm + d.pitch / 2;
      group.append(svg("rect", { class: "band", x: line.start_mm - d.pitch / 4, y: line.top_mm + over, width, height: d.line, rx: 4 * px }));
    }
    let [raised, flat] = ["", ""];
    line.cells.forEach((mask, cell) => {
      DOTS.slice(0, rows).forEach(([column, row], dot) => {
        const [x, y] = [dotX(d, line, cell, column), dotY(d, line, row)];
        if ((mask >> dot) & 1) raised += circle(x, y, radius);
        else flat += circle(x, y, Math.min(0.28, radius * 0.3));
      });
    });
    group.append(svg("path", { class: "flat", d: flat }), svg("path", { class: "raised", d: raised }));
    const below = dotY(d, line, rows === 8 ? 3 : 2) + radius;
    const room = d.line - (below - dotY(d, line, 0) + radius);
    const height = Math.min(room * 0.74, 16 * px);
    if (height * this.#px_mm >= 7) group.append(this.#print(d, line, below + room * 0.42 + height * 0.34, height));
    return group;
  }

  /** The print, each piece under the cells that stand for it. */
  #print(d, line, y, height) {
    const group = svg("g", { class: "gloss", "font-size": height });
    for (let cell = 0, last = 0; cell < line.cells.length; cell = last + 1) {
      last = cell;
      const [from, to] = line.sources[cell] ?? [0, 0];
      const words = line.text.slice(from, to).trim();
      while (to > from && line.sources[last + 1]?.[0] === from && line.sources[last + 1][1] === to) last++;
      if (!words) continue;
      const room = (last - cell + 1) * d.pitch - 0.8;
      const x = (dotX(d, line, cell, 0) + dotX(d, line, last, 1)) / 2;
      const narrow = words.length * height * 0.56 > room ? { textLength: room, lengthAdjust: "spacingAndGlyphs" } : {};
      group.append(svg("text", { x, y, "text-anchor": "middle", ...narrow }, words));
    }
    return group;
  }

  /** Makes the array, as large as it is. */
  #contact(state) {
    const { array } = state;
    const px = 1 / this.#px_mm;
    const [wide, high] = [array.columns * array.column_pitch_mm, array.rows * array.row_pitch_mm];
    const hit = { width: Math.max(wide, LEAST_FINGER_PX * px), height: Math.max(high, LEAST_FINGER_PX * px) };
    // As wide as an even number of pixels, so that its middle falls on a whole one.
    const [box, tall] = [hit.width, hit.height].map((mm) => 2 * Math.ceil((mm * this.#px_mm) / 2 + 5));
    this.#steps = [];
    this.#moved = this.#marked = "";
    const [w, h] = [0.6 * array.column_pitch_mm, 0.64 * array.row_pitch_mm];
    const seats = state.blind ? "" : this.#seats(array).map(([x, y]) => `M${x} ${y}h${w}v${h}h${-w}z`).join("");
    const around = (more, kind, radius) => svg("rect", {
      class: kind, x: -wide / 2 - more, y: -high / 2 - more, width: wide + 2 * more, height: high + 2 * more, rx: radius,
    });
    size(this.outline, -box / 2, -tall / 2, box, tall, px);
    this.outline.replaceChildren(svg("rect", { class: "hit", x: -hit.width / 2, y: -hit.height / 2, ...hit }),
      around(3 * px, "ring", 5 * px), around(0, "frame", 3 * px), svg("path", { class: "seats", "stroke-width": 0.5 * px, d: seats }));
    this.#contactors.fit((-box / 2) * px, (-tall / 2) * px, box, tall, this.#px_mm);
    const { style } = this.#contactors.element;
    [style.left, style.top] = [`${-box / 2}px`, `${-tall / 2}px`];
    const down = Math.round(this.#view.high * this.#px_mm);
    size(this.hairline, -6, 0, 12, down, 1);
    this.hairline.replaceChildren(svg("path", { d: `M0 ${TOP_PX - 6}V${down}`, class: "thread" }),
      svg("path", { d: `M0 ${TOP_PX - 6}l-5 -8h10z`, class: "pointer" }));
  }

  /** Upper left corners of the contactors in the middle of their swing, from the array's middle, row by row. */
  #seats(array) {
    return Array.from({ length: array.rows * array.columns }, (_, n) => [
      ((n % array.columns) - (array.columns - 1) / 2 - 0.3) * array.column_pitch_mm,
      (Math.floor(n / array.columns) - (array.rows - 1) / 2 - 0.32) * array.row_pitch_mm,
    ]);
  }

  /** Turns the view so that it begins at a place. */
  #look(left) {
    const view = (this.#view = { ...this.#view, left });
    put(this.still, "viewBox", [left, view.top, view.wide, view.high].map((value) => value.toFixed(3)).join(" "));
    put(this.still, "height", Math.round(view.high * this.#px_mm));
    put(this.side, "transform", `translate(${(left + this.span.pad - 10 / this.#px_mm).toFixed(3)} 0)`);
  }

  /** Moves the array to where a frame has it. */
  move(state, frame) {
    this.#frame = frame;
    if (!state.array || !this.span) return;
    const known = Number.isFinite(frame.x_mm);
    if (known !== this.#known) this.moving.style.visibility = (this.#known = known) ? "visible" : "hidden";
    if (!known) return;
    const { x, y, theta } = placeOf(state, frame);
    this.#follow(x);
    const right = whole((x - this.#view.left) * this.#px_mm);
    const moved = `translate(${right}px, ${whole((y - this.#view.top) * this.#px_mm)}px) rotate(${(-theta).toFixed(4)}rad)`;
    if (moved !== this.#moved) {
      this.array.style.transform = this.#moved = moved;
      this.hairline.style.transform = `translate(${right}px)`;
    }
    this.#mark(state, frame);
    this.#deflect(state.array, frame.deflections);
  }

  /** Keeps the finger in view where the line is longer than that: by leaps, not by sliding. */
  #follow(x) {
    const { from, right, pad } = this.span;
    const inner = this.#view.wide - pad - RIGHT_PX / this.#px_mm;
    const at = (x - this.#view.left - pad) / inner;
    if (inner >= right - from || (at > 0.12 && at < 0.82)) return;
    const left = clamp(x - 0.25 * inner, from, right - inner) - pad;
    if (Math.abs(left - this.#view.left) > 1e-6) this.#look(left);
  }

  /** Underlines the cell and the word under the finger. */
  #mark(state, frame) {
    const d = distances(state);
    const here = state.blind || !d ? null : under(state, frame);
    const marked = here ? `${here.line.number} ${here.line.start_mm} ${here.cell} ${this.#view.left}` : "";
    if (marked === this.#marked) return;
    this.#marked = marked;
    const show = (mark, thick, cells) => {
      mark.hidden = !cells;
      if (!cells) return;
      const [from, to] = [dotX(d, here.line, cells[0], 0) - d.width / 2, dotX(d, here.line, cells[1], 1) + d.width / 2];
      const bottom = (here.line.top_mm + d.line + this.#below(d) - this.#view.top) * this.#px_mm;
      const [left, width] = [from - this.#view.left, to - from].map((mm) => mm * this.#px_mm);
      for (const [name, px] of Object.entries({ left, width, top: bottom - thick, height: thick })) mark.style[name] = `${px.toFixed(2)}px`;
    };
    show(this.marks.children[0], 2.6, here && here.cell >= 0 ? [here.cell, here.cell] : null);
    show(this.marks.children[1], 1.2, here && cellsOf(here.line, here.word));
  }

  /** How far below a line its band goes, to the dots of the next. */
  #below(d) {
    return Math.max((d.line - d.width) / 2 - d.rows - 0.6, 0);
  }

  #deflect(array, deflections) {
    const wanted = deflections.length === array.rows * array.columns ? Array.from(deflections, stepOf) : [];
    if (wanted.length === this.#steps.length && wanted.every((step, n) => step === this.#steps[n])) return;
    this.#steps = wanted;
    const pen = this.#contactors.begin();
    const way = (array.rest_right ? -1 : 1) * array.swing_mm;
    const seats = this.#seats(array);
    wanted.forEach((step, n) => {
      if (!step) return; // at rest, the dots below are seen
      pen.fillStyle = steps()[step];
      pen.fillRect(seats[n][0] + (deflections[n] - 0.5) * way, seats[n][1], 0.6 * array.column_pitch_mm, 0.64 * array.row_pitch_mm);
    });
  }
}
