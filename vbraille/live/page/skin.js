/**
 * The array enlarged: where each actuator leans and what passes beneath it, and below that how the
 * skin between neighbours is stretched or pressed.
 */

import { DOTS, distances, dotX, dotY, lineUnder, placeOf, rowWords } from "./braille.js";
import { STEPS, colours, onScheme, stepOf, steps } from "./colours.js";
import { Canvas, byId, clamp, fixed, html, onResolution, ruler, short, svg, write } from "./elements.js";

const LEFT_PX = 58;
const TOP_PX = 30;
const MOST_HIGH_PX = 250;
const NICE = [1, 2, 3, 4, 5, 8, 10, 15, 20, 30, 50];

/**
 * Strain between each actuator and its right neighbour: how much further apart they are than at rest,
 * as a share of the pitch; row by row, columns - 1 in each.
 */
export function strains(array, deflections) {
  const way = (array.rest_right ? -1 : 1) * (array.swing_mm / array.column_pitch_mm);
  const found = [];
  for (let n = 0; n < array.rows * array.columns; n++) {
    if ((n + 1) % array.columns) found.push((deflections[n + 1] - deflections[n]) * way);
  }
  return found;
}

export class Skin {
  chosen = { row: 0, column: 0 }; // the actuator that the keys have come to
  #state = null;
  #frame = null;
  #px_mm = 20;
  #row_mm = 1; // height of a row as it is drawn: a single row has no pitch of its own
  #cells = [];
  #seats = []; // middle of each actuator's swing, in mm from the middle of the array
  #slots = new Path2D();
  #lines = new Path2D();
  #made = "";
  #dots = "";
  #flat = new Path2D();
  #raised = new Path2D();
  #ink = { paper: "", edge: "", hair: "", beneath: "" };
  #leaning = new Canvas(true);
  #strained = new Canvas(true);

  constructor() {
    this.figure = byId("deflection");
    this.left = svg("svg", { class: "skin" });
    this.right = svg("svg", { class: "skin", "aria-hidden": "true" });
    this.ring = html("div", { class: "chosen", "aria-hidden": "true" });
    this.legend = html("figcaption", { class: "legend" });
    this.key = html("figcaption", { class: "legend" });
    this.figure.append(html("div", { class: "over" }, this.#leaning.element, this.left, this.ring), this.legend);
    byId("strain").append(html("div", { class: "over" }, this.#strained.element, this.right), this.key);
    const again = () => {
      this.#made = "";
      if (this.#state) this.show(this.#state);
      if (this.#state && this.#frame) this.move(this.#state, this.#frame);
    };
    new ResizeObserver(again).observe(this.figure);
    onScheme(again);
    onResolution(again);
    // The actuators are one stop of the tabulator key, with arrow keys inside.
    this.figure.addEventListener("keydown", (event) => this.#key(event));
    this.figure.addEventListener("focusin", (event) => this.#name(event.target.closest(".actuator")));
  }

  /** Draws what stands still. */
  show(state) {
    this.#state = state;
    const { array } = state;
    const width = this.figure.clientWidth;
    if (!array || !width || state.blind) return;
    const made = JSON.stringify([array, state.rows_shown, width]);
    if (made === this.#made) return;
    const first = !this.#made;
    this.#made = made;
    this.#make(state, array, width);
    const { row, column } = first && !this.#frame ? { row: 0, column: array.columns >> 1 } : this.chosen;
    this.choose(Math.min(row, array.rows - 1), Math.min(column, array.columns - 1), false);
  }

  #make(state, array, width) {
    const pitch = array.column_pitch_mm;
    const row_mm = (this.#row_mm = array.rows === 1 ? Math.max(array.row_pitch_mm, 2.6 * pitch) : array.row_pitch_mm);
    const [wide, high] = [(array.columns + 0.6) * pitch, (array.rows + 0.5) * row_mm];
    const px_mm = (this.#px_mm = Math.min((width - LEFT_PX) / wide, MOST_HIGH_PX / high));
    const px = 1 / px_mm;
    this.times = NICE.findLast((times) => times <= (0.56 * pitch) / (array.swing_mm || 1)) ?? 1;
    this.corner = { x: -wide / 2 - LEFT_PX * px, y: -high / 2 - TOP_PX * px };
    const box = { width: wide + LEFT_PX * px, height: high + (TOP_PX + 2) * px };
    for (const drawing of [this.left, this.right]) {
      drawing.setAttribute("viewBox", [this.corner.x, this.corner.y, box.width, box.height].map((mm) => mm.toFixed(3)).join(" "));
      for (const [name, mm] of Object.entries(box)) drawing.setAttribute(name, (mm * px_mm).toFixed(3));
      drawing.setAttribute("font-size", String(11.5 * px));
    }
    for (const canvas of [this.#leaning, this.#strained]) canvas.fit(-wide / 2, -high / 2, wide * px_mm, high * px_mm, px_mm);
    const style = getComputedStyle(this.figure);
    for (const name of Object.keys(this.#ink)) this.#ink[name] = style.getPropertyValue(`--${name}`).trim();
    this.#dots = "";
    this.#seats = Array.from({ length: array.rows * array.columns }, (_, n) => [
      ((n % array.columns) - (array.columns - 1) / 2) * pitch, (Math.floor(n / array.columns) - (array.rows - 1) / 2) * row_mm,
    ]);
    const swing = (array.swing_mm * this.times) / 2;
    const rest = array.rest_right ? swing : -swing;
    this.#slots = new Path2D(this.#seats.map(([x, y]) => `M${x - swing} ${y}h${2 * swing}M${x + rest} ${y - 0.31 * row_mm}v${0.62 * row_mm}`).join(""));
    this.#lines = new Path2D(this.#seats.filter((_, n) => n % array.columns === 0).map(([, y]) => `M${-wide / 2} ${y}h${wide}`).join(""));
    const scales = () => svg("g", { "aria-hidden": "true" },
      ruler(-Math.floor(wide / 2), Math.floor(wide / 2), -high / 2 - 4 * px, false, px_mm),
      svg("text", { x: this.corner.x, y: -high / 2 - 16 * px, class: "unit" }, "mm"),
      ...Array.from({ length: array.rows }, (_, row) => svg("text", {
        x: -wide / 2 - 10 * px, y: this.#seats[row * array.columns][1] + 4 * px, "text-anchor": "end",
      }, rowWords(state.rows_shown[row]) || `row ${row + 1}`)));
    this.#cells = this.#seats.map(([x, y], n) => svg("g", { role: "gridcell", class: "actuator", tabindex: -1, "data-n": n },
      svg("rect", { class: "hit", x: x - pitch / 2, y: y - row_mm / 2, width: pitch, height: row_mm })));
    const grid = svg("g", { role: "grid", "aria-labelledby": "touch-heading" });
    for (let row = 0; row < array.rows; row++) {
      const cells = this.#cells.slice(row * array.columns, (row + 1) * array.columns);
      cells.forEach((cell, column) => cell.addEventListener("click", () => this.choose(row, column, true)));
      grid.append(svg("g", { role: "row" }, ...cells));
    }
    this.#cells.forEach((cell) => this.#name(cell));
    this.left.replaceChildren(scales(), grid);
    this.right.replaceChildren(scales());
    this.#words(array);
  }

  #words(array) {
    write(byId("touch-note"), `${array.name}: ${array.rows} × ${array.columns} actuators, ${short(array.column_pitch_mm)} mm apart` +
      (array.rows > 1 ? ` and ${short(array.row_pitch_mm)} mm from row to row` : ""));
    const bar = svg("svg", { class: "ramp", viewBox: `0 0 ${STEPS + 1} 1`, preserveAspectRatio: "none", "aria-hidden": "true" });
    steps().forEach((colour, n) => bar.append(svg("rect", { x: n, width: 1.02, height: 1, fill: colour })));
    this.legend.replaceChildren(html("span", { class: "keys" }, "rest 0", bar, "1 full swing"),
      html("span", {}, `${short(array.swing_mm)} mm, drawn × ${this.times} sideways; at rest they stand at the ${array.rest_right ? "right" : "left"}`));
    const { stretch, press } = colours();
    const swatch = (look) => svg("svg", { class: "swatch", viewBox: "0 0 10 12", "aria-hidden": "true" },
      svg("rect", { x: 1, y: 1, width: 8, height: 10, "stroke-width": 1.4, ...look }));
    const most = fixed((100 * array.swing_mm) / array.column_pitch_mm, 1);
    this.key.replaceChildren(html("span", { class: "keys" }, swatch({ fill: stretch }), "up: stretched"),
      html("span", { class: "keys" }, swatch({ fill: "none", stroke: press }), "down: pressed"),
      html("span", {}, `strain of the skin between neighbours; the tallest bar there can be is ${most} %`));
  }

  /** Shows a frame. */
  move(state, frame) {
    this.#frame = frame;
    const { array } = state;
    if (!array || state.blind || !this.#cells.length || frame.deflections.length !== this.#cells.length) return;
    const pen = this.#leaning.begin(this.#ink.paper);
    pen.lineWidth = 1 / this.#px_mm;
    if (Number.isFinite(frame.x_mm)) this.#below(pen, state, frame);
    pen.strokeStyle = this.#ink.edge;
    pen.stroke(this.#slots);
    const way = (array.rest_right ? -1 : 1) * array.swing_mm * this.times;
    const [wide, high] = [0.36 * array.column_pitch_mm, 0.62 * this.#row_mm];
    this.#seats.forEach(([x, y], n) => {
      const box = [x + (frame.deflections[n] - 0.5) * way - wide / 2, y - high / 2, wide, high];
      pen.fillStyle = steps()[stepOf(frame.deflections[n])];
      pen.fillRect(...box);
      pen.strokeRect(...box);
    });
    this.#stretch(array, frame.deflections);
  }

  /** Draws the dots beneath the array: only those near it, which are collected once for each cell. */
  #below(pen, state, frame) {
    const d = distances(state);
    const { array } = state;
    if (!d) return;
    const reach = Math.hypot(array.columns * array.column_pitch_mm, array.rows * this.#row_mm) / 2 + d.width;
    const two = array.height_mm > 0;
    const lines = two ? state.lines.filter((line) => Math.abs(line.top_mm + d.line / 2 - frame.y_mm) < reach + d.line) : [lineUnder(state, frame)].filter(Boolean);
    const first = (line) => Math.floor((frame.x_mm - reach - line.start_mm) / d.pitch);
    const made = `${state.number} ${lines.map((line) => `${line.number}:${first(line)}`).join()}`;
    if (made !== this.#dots) {
      this.#dots = made;
      [this.#flat, this.#raised] = [new Path2D(), new Path2D()];
      for (const line of lines) {
        const from = Math.max(first(line), 0);
        line.cells.slice(from, from + Math.ceil((2 * reach) / d.pitch) + 1).forEach((mask, n) => {
          DOTS.slice(0, mask > 0x3f ? 8 : 6).forEach(([column, row], dot) => {
            const path = (mask >> dot) & 1 ? this.#raised : this.#flat;
            const [x, y] = [dotX(d, line, from + n, column), dotY(d, line, row)];
            path.moveTo(x + d.width / 2, y);
            path.arc(x, y, d.width / 2, 0, 2 * Math.PI);
          });
        });
      }
    }
    const { x, y, theta } = placeOf(state, frame);
    pen.save();
    pen.rotate(theta);
    pen.translate(-x, -y);
    pen.strokeStyle = this.#ink.hair;
    pen.stroke(this.#flat);
    pen.fillStyle = this.#ink.beneath;
    pen.fill(this.#raised);
    pen.strokeStyle = this.#ink.edge;
    pen.stroke(this.#raised);
    pen.restore();
  }

  /** Draws the strain: a bar between neighbours. */
  #stretch(array, deflections) {
    const pen = this.#strained.begin(this.#ink.paper);
    const pitch = array.column_pitch_mm;
    const unit = (0.44 * this.#row_mm) / (array.swing_mm / pitch || 1); // mm on the drawing for a strain of 1
    pen.lineWidth = 1 / this.#px_mm;
    pen.strokeStyle = this.#ink.hair;
    pen.stroke(this.#lines);
    pen.fillStyle = this.#ink.edge;
    for (const [x, y] of this.#seats) pen.fillRect(x - 0.05 * pitch, y - 1 / this.#px_mm, 0.1 * pitch, 2 / this.#px_mm);
    ({ stretch: pen.fillStyle, press: pen.strokeStyle } = colours());
    strains(array, deflections).forEach((strain, bar) => {
      const [x, y] = this.#seats[bar + Math.floor(bar / (array.columns - 1))];
      const high = strain * unit;
      if (Math.abs(high) * this.#px_mm < 0.25) return; // less than is seen
      if (high > 0) pen.fillRect(x + 0.19 * pitch, y - high, 0.62 * pitch, high);
      else pen.strokeRect(x + 0.19 * pitch, y, 0.62 * pitch, -high);
    });
  }

  /** Comes to an actuator. */
  choose(row, column, focus) {
    const { array } = this.#state;
    const n = row * array.columns + column;
    this.chosen = { row, column };
    this.#cells.forEach((cell, at) => {
      cell.setAttribute("tabindex", at === n ? "0" : "-1");
      cell.setAttribute("aria-selected", String(at === n));
    });
    this.#name(this.#cells[n]);
    if (focus) this.#cells[n].focus();
    const [wide, high] = [array.column_pitch_mm, this.#row_mm];
    const corner = [this.#seats[n][0] - wide / 2 - this.corner.x, this.#seats[n][1] - high / 2 - this.corner.y];
    const px = [...corner, wide, high].map((mm, at) => `${(mm * this.#px_mm + (at < 2 ? 1 : -2)).toFixed(2)}px`);
    [this.ring.style.left, this.ring.style.top, this.ring.style.width, this.ring.style.height] = px;
  }

  /** Names an actuator with what it does now. */
  #name(cell) {
    if (!cell) return;
    const n = Number(cell.dataset.n);
    const { columns } = this.#state.array;
    const row = Math.floor(n / columns);
    const shown = rowWords(this.#state.rows_shown[row]);
    const deflection = this.#frame?.deflections[n];
    cell.setAttribute("aria-label", `row ${row + 1}, column ${(n % columns) + 1}` + (shown ? `, ${shown}` : "") +
      (deflection === undefined ? "" : `: deflection ${fixed(deflection, 2)}`));
  }

  #key(event) {
    if (event.altKey || event.ctrlKey || event.metaKey) return;
    const { rows, columns } = this.#state.array;
    const { row, column } = this.chosen;
    const to = {
      ArrowRight: [row, column + 1], ArrowLeft: [row, column - 1], ArrowDown: [row + 1, column], ArrowUp: [row - 1, column],
      Home: [row, 0], End: [row, columns - 1],
    }[event.key];
    if (!to) return;
    event.preventDefault();
    this.choose(clamp(to[0], 0, rows - 1), clamp(to[1], 0, columns - 1), true);
  }
}
