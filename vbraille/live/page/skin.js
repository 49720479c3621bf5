/**
 * The array enlarged: where each actuator leans and what passes beneath it, and beside that how
 * the skin between neighbours is stretched or pressed.
 */

import { DOTS, distances, dotX, dotY, lineUnder, placeOf } from "./braille.js";
import { Canvas, onSharpness } from "./canvas.js";
import { fixed, html, ruler, short, svg, write } from "./drawing.js";
import { STEPS, colours, onScheme, stepOf, steps } from "./palette.js";

/** @typedef {import("./messages.js").State} State */
/** @typedef {import("./messages.js").Frame} Frame */
/** @typedef {import("./messages.js").ArrayShown} ArrayShown */

const LEFT_PX = 58;
const TOP_PX = 30;
const MOST_HIGH_PX = 250;
const NICE = [1, 2, 3, 4, 5, 8, 10, 15, 20, 30, 50];

/**
 * Strain between each actuator and its right neighbour: how much further apart they are than at
 * rest, as a share of the pitch.
 * @param {ArrayShown} array
 * @param {ArrayLike<number>} deflections
 * @returns {number[]} row by row, columns - 1 in each
 */
export function strains(array, deflections) {
  const way = (array.rest_right ? -1 : 1) * (array.swing_mm / array.column_pitch_mm);
  const found = [];
  for (let row = 0; row < array.rows; row++) {
    for (let column = 0; column + 1 < array.columns; column++) {
      const n = row * array.columns + column;
      found.push((deflections[n + 1] - deflections[n]) * way);
    }
  }
  return found;
}

/**
 * Words for the dots that a row of actuators shows, such as "dots 1 4".
 * @param {[number, number] | undefined} shown
 */
export function rowWords(shown) {
  if (!shown) return "";
  const dots = DOTS.flatMap(([column, row], dot) => (shown[column] === row ? [dot + 1] : []));
  return dots.length ? `dot${dots.length > 1 ? "s" : ""} ${dots.join(" ")}` : "";
}

export class Skin {
  /** @type {State | null} */
  #state = null;
  /** @type {Frame | null} */
  #frame = null;
  #px_mm = 20;
  #times = 1;
  /** @type {SVGGElement[]} */
  #cells = [];
  /** Middle of each actuator's seat, in mm from the middle of the array. */
  #seats = { x: new Float64Array(0), y: new Float64Array(0), wide: 0, high: 0 };
  #slots = new Path2D();
  #lines = new Path2D();
  #corner = { x: 0, y: 0 }; // of the drawing, in mm
  #made = "";
  #dots = "";
  #flat = new Path2D();
  #raised = new Path2D();
  #ink = { paper: "", edge: "", hair: "", beneath: "" };
  #leaning = new Canvas(true);
  #strained = new Canvas(true);
  chosen = { row: 0, column: 0 };
  #first = true;
  /** Called when another actuator is chosen. */
  onchoose = () => {};

  /**
   * @param {HTMLElement} leaning
   * @param {HTMLElement} strained
   * @param {HTMLElement} note
   * @param {string} heading id of the heading that names it
   */
  constructor(leaning, strained, note, heading = "touch-heading") {
    this.heading = heading;
    this.left = svg("svg", { class: "skin" });
    this.right = svg("svg", {
      class: "skin", role: "img", "aria-label": "Strain of the skin between neighbours, a bar for each; the same stands in a table below",
    });
    this.ring = html("div", { class: "chosen", hidden: "" });
    this.legend = html("div", { class: "legend" });
    this.key = html("div", { class: "legend" });
    this.note = note;
    write(this.key, "Bars between neighbours will show the strain of the skin: up where it is stretched, down where it is pressed.");
    leaning.append(html("div", { class: "over" }, this.left, this.#leaning.element, this.ring), html("figcaption", {}, this.legend));
    strained.append(html("div", { class: "over" }, this.right, this.#strained.element), html("figcaption", {}, this.key));
    this.figure = leaning;
    new ResizeObserver(() => this.#again()).observe(leaning);
    onScheme(() => this.#again());
    onSharpness(() => this.#again());
    // Not of the drawing itself: that would make it a stop of the tabulator key.
    leaning.addEventListener("keydown", (event) => this.#key(event));
    leaning.addEventListener("focusin", (event) => this.#focused(event));
  }

  #again() {
    this.#made = "";
    if (this.#state) this.show(this.#state);
    if (this.#state && this.#frame) this.move(this.#state, this.#frame);
  }

  /**
   * Draws what stands still.
   * @param {State} state
   */
  show(state) {
    this.#state = state;
    const array = state.array;
    const width = this.figure.clientWidth;
    if (!array || width === 0 || state.blind) return;
    const made = JSON.stringify([array, state.rows_shown, width]);
    if (made !== this.#made) {
      this.#made = made;
      this.#make(state, array, width);
    }
  }

  /**
   * Height of a row as it is drawn: a single row has no pitch of its own.
   * @param {ArrayShown} array
   */
  #rowOf(array) {
    return array.rows === 1 ? Math.max(array.row_pitch_mm, 2.6 * array.column_pitch_mm) : array.row_pitch_mm;
  }

  /**
   * @param {State} state
   * @param {ArrayShown} array
   * @param {number} width
   */
  #make(state, array, width) {
    const pitch = array.column_pitch_mm;
    const row_mm = this.#rowOf(array);
    const wide = (array.columns + 0.6) * pitch;
    const high = (array.rows + 0.5) * row_mm;
    this.#px_mm = Math.min((width - LEFT_PX) / wide, MOST_HIGH_PX / high);
    const px = 1 / this.#px_mm;
    const room = (0.56 * pitch) / (array.swing_mm || 1);
    this.#times = NICE.findLast((times) => times <= room) ?? 1;
    const box = [-wide / 2 - LEFT_PX * px, -high / 2 - TOP_PX * px, wide + LEFT_PX * px, high + (TOP_PX + 2) * px];
    for (const drawing of [this.left, this.right]) {
      drawing.setAttribute("viewBox", box.map((value) => value.toFixed(3)).join(" "));
      drawing.setAttribute("width", (box[2] * this.#px_mm).toFixed(3));
      drawing.setAttribute("height", (box[3] * this.#px_mm).toFixed(3));
      drawing.setAttribute("font-size", String(11.5 * px));
      drawing.setAttribute("stroke-width", String(px));
    }
    const x = (/** @type {number} */ column) => (column - (array.columns - 1) / 2) * pitch;
    const y = (/** @type {number} */ row) => (row - (array.rows - 1) / 2) * row_mm;
    const scales = () => {
      const group = svg("g", { "aria-hidden": "true" });
      group.append(ruler(-Math.floor(wide / 2), Math.floor(wide / 2), -high / 2 - 4 * px, false, this.#px_mm));
      group.append(svg("text", { x: -wide / 2 - LEFT_PX * px, y: -high / 2 - 16 * px, class: "unit" }, "mm"));
      for (let row = 0; row < array.rows; row++) {
        const words = rowWords(state.rows_shown[row]) || `row ${row + 1}`;
        group.append(svg("text", {
          x: -wide / 2 - 10 * px, y: y(row) + 4 * px, "text-anchor": "end", class: "row",
        }, words));
      }
      return group;
    };
    const grid = svg("g", { role: "grid", "aria-labelledby": this.heading, class: "actuators" });
    const count = array.rows * array.columns;
    this.#cells = [];
    this.#seats = { x: new Float64Array(count), y: new Float64Array(count), wide: 0.36 * pitch, high: 0.62 * row_mm };
    this.#dots = "";
    this.#corner = { x: box[0], y: box[1] };
    for (const canvas of [this.#leaning, this.#strained]) {
      canvas.fit(-wide / 2, -high / 2, wide * this.#px_mm, high * this.#px_mm, this.#px_mm);
    }
    const style = getComputedStyle(this.figure);
    const ink = (/** @type {string} */ name) => style.getPropertyValue(`--${name}`).trim();
    this.#ink = { paper: ink("paper"), edge: ink("edge"), hair: ink("hair"), beneath: ink("beneath") };
    const slot = (array.swing_mm * this.#times) / 2;
    const h = this.#seats.high;
    let slots = "";
    for (let row = 0; row < array.rows; row++) {
      const line = svg("g", { role: "row" });
      for (let column = 0; column < array.columns; column++) {
        const rest = x(column) + (array.rest_right ? slot : -slot);
        this.#seats.x[this.#cells.length] = x(column);
        this.#seats.y[this.#cells.length] = y(row);
        slots += `M${x(column) - slot} ${y(row)}h${2 * slot}M${rest} ${y(row) - h / 2}v${h}`;
        const cell = svg("g", {
          role: "gridcell", class: "actuator", tabindex: -1, "data-row": row, "data-column": column,
          "aria-label": `row ${row + 1}, column ${column + 1}`,
        },
        svg("rect", { class: "hit", x: x(column) - pitch / 2, y: y(row) - row_mm / 2, width: pitch, height: row_mm }));
        cell.addEventListener("click", () => this.choose(row, column, true));
        this.#cells.push(cell);
        line.append(cell);
      }
      grid.append(line);
    }
    this.#slots = new Path2D(slots);
    this.left.replaceChildren(scales(), grid);
    this.#strain(array, row_mm, scales(), wide);
    this.#words(array);
    const { row, column } = this.#first ? { row: 0, column: array.columns >> 1 } : this.chosen;
    this.#first = false;
    this.choose(Math.min(row, array.rows - 1), Math.min(column, array.columns - 1), false);
    this.tell();
  }

  /**
   * @param {ArrayShown} array
   * @param {number} row_mm
   * @param {SVGGElement} scales
   * @param {number} wide
   */
  #strain(array, row_mm, scales, wide) {
    const most = array.swing_mm / array.column_pitch_mm || 1;
    this.unit = (0.44 * row_mm) / most; // mm on the drawing for a strain of 1
    let lines = "";
    for (let n = 0; n < this.#seats.y.length; n += array.columns) lines += `M${-wide / 2} ${this.#seats.y[n]}h${wide}`;
    this.#lines = new Path2D(lines);
    this.right.replaceChildren(scales);
  }

  /** @param {ArrayShown} array */
  #words(array) {
    const side = array.rest_right ? "right" : "left";
    this.note.textContent =
      `${array.name}: ${array.rows} × ${array.columns} actuators, ${short(array.column_pitch_mm)} mm apart` +
      (array.rows > 1 ? ` and ${short(array.row_pitch_mm)} mm from row to row` : "");
    const bar = svg("svg", { class: "ramp", viewBox: `0 0 ${STEPS + 1} 1`, preserveAspectRatio: "none", "aria-hidden": "true" });
    steps().forEach((colour, n) => bar.append(svg("rect", { x: n, width: 1.02, height: 1, fill: colour })));
    this.legend.replaceChildren(
      html("span", { class: "keys" }, "rest 0", bar, "1 full swing"),
      html("span", {}, `${short(array.swing_mm)} mm, drawn × ${this.#times} sideways; at rest they stand at the ${side}`),
    );
    const most = (100 * array.swing_mm) / array.column_pitch_mm;
    const swatch = (/** @type {string} */ kind) => svg("svg", { class: "swatch", viewBox: "0 0 10 12", "aria-hidden": "true" },
      svg("rect", { x: 1, y: 1, width: 8, height: 10, "stroke-width": 1.4, ...this.#look(kind === "stretch") }));
    this.key.replaceChildren(
      html("span", { class: "keys" }, swatch("stretch"), "up: stretched", swatch("press"), "down: pressed"),
      html("span", {}, `strain of the skin between neighbours; the tallest bar there can be is ${fixed(most, 1)} %`),
    );
  }

  /**
   * What a bar looks like: stretched is filled, pressed is hollow.
   * @param {boolean} stretched
   */
  #look(stretched) {
    const { stretch, press } = colours();
    return stretched ? { fill: stretch, stroke: "none" } : { fill: "none", stroke: press };
  }

  /**
   * Collects the dots that pass beneath the array; only those near it, which are few.
   * @param {State} state
   * @param {Frame} frame
   */
  #near(state, frame) {
    const d = distances(state);
    const array = state.array;
    if (!d || !array) return;
    const reach = Math.hypot(array.columns * array.column_pitch_mm, array.rows * this.#rowOf(array)) / 2 + d.width;
    const two = array.height_mm > 0;
    const near = (/** @type {import("./messages.js").LineShown} */ line) =>
      two ? Math.abs(line.top_mm + d.line / 2 - frame.y_mm) < reach + d.line : line.under;
    const lines = state.lines.filter(near);
    const first = (/** @type {number} */ start) => Math.floor((frame.x_mm - reach - start) / d.pitch);
    const count = Math.ceil((2 * reach) / d.pitch) + 1;
    const made = `${state.number} ${lines.map((line) => `${line.number}:${first(line.start_mm)}`).join()}`;
    if (made === this.#dots) return;
    this.#dots = made;
    this.#flat = new Path2D();
    this.#raised = new Path2D();
    for (const line of lines) {
      const from = Math.max(first(line.start_mm), 0);
      line.cells.slice(from, from + count).forEach((mask, n) => {
        DOTS.slice(0, mask > 0x3f ? 8 : 6).forEach(([column, row], dot) => {
          const path = (mask >> dot) & 1 ? this.#raised : this.#flat;
          const [x, y] = [dotX(d, line, from + n, column), dotY(d, line, row)];
          path.moveTo(x + d.width / 2, y);
          path.arc(x, y, d.width / 2, 0, 2 * Math.PI);
        });
      });
    }
  }

  /**
   * Shows a frame.
   * @param {State} state
   * @param {Frame} frame
   */
  move(state, frame) {
    this.#frame = frame;
    const array = state.array;
    if (!array || frame.deflections.length !== this.#cells.length || state.blind) return;
    const pen = this.#leaning.begin(this.#ink.paper);
    pen.lineWidth = 1 / this.#px_mm;
    if (Number.isFinite(frame.x_mm) && (array.height_mm > 0 || lineUnder(state, frame))) this.#below(pen, state, frame);
    pen.strokeStyle = this.#ink.edge;
    pen.stroke(this.#slots);
    const palette = steps();
    const way = (array.rest_right ? -1 : 1) * array.swing_mm * this.#times;
    const { x, y, wide, high } = this.#seats;
    for (let n = 0; n < x.length; n++) {
      const deflection = frame.deflections[n];
      const left = x[n] + (deflection - 0.5) * way - wide / 2;
      pen.fillStyle = palette[stepOf(deflection)];
      pen.fillRect(left, y[n] - high / 2, wide, high);
      pen.strokeRect(left, y[n] - high / 2, wide, high);
    }
    this.#stretch(array, frame);
  }

  /**
   * Draws the dots beneath the array.
   * @param {CanvasRenderingContext2D} pen
   * @param {State} state
   * @param {Frame} frame
   */
  #below(pen, state, frame) {
    this.#near(state, frame);
    const { x, y, theta } = placeOf(state, frame);
    pen.save();
    if (theta) pen.rotate(theta);
    pen.translate(-x, -y);
    pen.strokeStyle = this.#ink.hair;
    pen.stroke(this.#flat);
    pen.fillStyle = this.#ink.beneath;
    pen.fill(this.#raised);
    pen.strokeStyle = this.#ink.edge;
    pen.stroke(this.#raised);
    pen.restore();
  }

  /**
   * Draws the strain: a bar between neighbours.
   * @param {ArrayShown} array
   * @param {Frame} frame
   */
  #stretch(array, frame) {
    const pen = this.#strained.begin(this.#ink.paper);
    pen.lineWidth = 1 / this.#px_mm;
    const { stretch, press } = colours();
    const unit = this.unit ?? 1;
    const wide = 0.62 * array.column_pitch_mm;
    const { x, y } = this.#seats;
    pen.strokeStyle = this.#ink.hair;
    pen.stroke(this.#lines);
    pen.fillStyle = this.#ink.edge;
    const [seat, thick] = [0.1 * array.column_pitch_mm, 2 / this.#px_mm];
    for (let n = 0; n < x.length; n++) pen.fillRect(x[n] - seat / 2, y[n] - thick / 2, seat, thick);
    pen.fillStyle = stretch;
    pen.strokeStyle = press;
    strains(array, frame.deflections).forEach((strain, bar) => {
      const n = bar + Math.floor(bar / (array.columns - 1));
      const [left, high] = [x[n] + 0.19 * array.column_pitch_mm, strain * unit];
      if (Math.abs(high) * this.#px_mm < 0.25) return; // less than anybody sees
      if (high > 0) pen.fillRect(left, y[n] - high, wide, high);
      else pen.strokeRect(left, y[n], wide, -high);
    });
  }

  /** The two drawings of now, side by side, as one picture. */
  picture() {
    const [left, right] = [this.#leaning.element, this.#strained.element];
    const made = html("canvas", { width: left.width + right.width + 16, height: Math.max(left.height, right.height) });
    const pen = /** @type {CanvasRenderingContext2D} */ (made.getContext("2d"));
    pen.fillStyle = this.#ink.paper;
    pen.fillRect(0, 0, made.width, made.height);
    pen.drawImage(left, 0, 0);
    pen.drawImage(right, left.width + 16, 0);
    return made;
  }

  /** Writes what is drawn into the elements, as text; a few times a second. */
  tell() {
    const deflections = this.#frame?.deflections;
    if (deflections?.length !== this.#cells.length) return;
    this.#cells.forEach((cell, n) => cell.setAttribute("data-deflection", deflections[n].toFixed(4)));
  }

  /**
   * Chooses the actuator that is followed.
   * @param {number} row
   * @param {number} column
   * @param {boolean} focus
   */
  choose(row, column, focus) {
    const array = this.#state?.array;
    if (!array) return;
    this.chosen = { row, column };
    this.#cells.forEach((cell, n) => {
      const here = n === row * array.columns + column;
      cell.setAttribute("tabindex", here ? "0" : "-1");
      cell.setAttribute("aria-selected", String(here));
      if (here) this.#name(cell, n);
      if (here && focus) cell.focus();
    });
    const n = row * array.columns + column;
    this.ring.hidden = false;
    const [wide, high] = [array.column_pitch_mm, this.#rowOf(array)];
    const corner = [this.#seats.x[n] - wide / 2 - this.#corner.x, this.#seats.y[n] - high / 2 - this.#corner.y];
    const px = [...corner, wide, high].map((mm, at) => `${(mm * this.#px_mm + (at < 2 ? 1 : -2)).toFixed(2)}px`);
    [this.ring.style.left, this.ring.style.top, this.ring.style.width, this.ring.style.height] = px;
    this.onchoose();
  }

  /**
   * Names an actuator with what it does now.
   * @param {SVGGElement} cell
   * @param {number} n
   */
  #name(cell, n) {
    const { row, column } = cell.dataset;
    const shown = rowWords(this.#state?.rows_shown[Number(row)]);
    const deflection = this.#frame?.deflections[n];
    cell.setAttribute("aria-label", `row ${Number(row) + 1}, column ${Number(column) + 1}` +
      (shown ? `, ${shown}` : "") + (deflection === undefined ? "" : `: deflection ${fixed(deflection, 2)}`));
  }

  /** @param {FocusEvent} event */
  #focused(event) {
    const cell = event.target instanceof Element ? event.target.closest(".actuator") : null;
    const n = this.#cells.indexOf(/** @type {SVGGElement} */ (cell));
    if (n >= 0) this.#name(this.#cells[n], n);
  }

  /** @param {KeyboardEvent} event */
  #key(event) {
    const array = this.#state?.array;
    if (!array || event.altKey || event.ctrlKey || event.metaKey) return;
    let { row, column } = this.chosen;
    if (event.key === "ArrowRight") column += 1;
    else if (event.key === "ArrowLeft") column -= 1;
    else if (event.key === "ArrowDown") row += 1;
    else if (event.key === "ArrowUp") row -= 1;
    else if (event.key === "Home") column = 0;
    else if (event.key === "End") column = array.columns - 1;
    else return;
    event.preventDefault();
    row = Math.min(Math.max(row, 0), array.rows - 1);
    column = Math.min(Math.max(column, 0), array.columns - 1);
    this.choose(row, column, true);
  }
}
