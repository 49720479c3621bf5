/** Keeping what is felt: the moment as a picture and numbers, or a stretch of time as numbers. */

import { byId, html, write } from "./drawing.js";
import { strains } from "./skin.js";

/** @typedef {import("./messages.js").State} State */
/** @typedef {import("./messages.js").Frame} Frame */

const MOST_FRAMES = 36_000; // ten minutes at 60 pictures a second

/**
 * Saves a file where the browser keeps what it loads.
 * @param {string} name
 * @param {Blob} file
 */
export function save(name, file) {
  const address = URL.createObjectURL(file);
  html("a", { href: address, download: name }).click();
  setTimeout(() => URL.revokeObjectURL(address), 10_000);
}

/** @param {(string | number)[][]} rows */
const csv = (rows) => new Blob([rows.map((row) => row.join(",") + "\n").join("")], { type: "text/csv" });

/** @param {number} value */
const cell = (value) => (Number.isFinite(value) ? String(Math.round(value * 1e6) / 1e6) : "");

export class Saving {
  /** @type {(string | number)[][] | null} */
  #rows = null;

  /** @param {import("./skin.js").Skin} skin */
  constructor(skin) {
    this.skin = skin;
    /** @type {() => [State | null, Frame | null]} */
    this.now = () => [null, null];
    byId("save-moment").addEventListener("click", () => this.#moment());
    byId("record").addEventListener("click", () => (this.#rows ? this.#end() : this.#begin()));
  }

  #moment() {
    const [state, frame] = this.now();
    const array = state?.array;
    if (!array || !frame?.deflections.length) return write(byId("saved"), "There is nothing to save yet.");
    const strain = strains(array, frame.deflections);
    /** @type {(string | number)[][]} */
    const rows = [["tick", "time_s", "x_mm", "y_mm", "theta_rad", "row", "column", "deflection", "strain_to_the_right"]];
    const place = [frame.tick, cell(frame.time_s), cell(frame.x_mm), cell(frame.y_mm), cell(frame.theta_rad)];
    frame.deflections.forEach((deflection, n) => {
      const [row, column] = [Math.floor(n / array.columns), n % array.columns];
      const right = column + 1 < array.columns ? cell(strain[row * (array.columns - 1) + column]) : "";
      rows.push([...place, row, column, cell(deflection), right]);
    });
    save(`moment-${frame.tick}.csv`, csv(rows));
    this.skin.picture().toBlob((file) => file && save(`moment-${frame.tick}.png`, file));
    write(byId("saved"), `The moment is saved as moment-${frame.tick}.png and moment-${frame.tick}.csv.`);
  }

  #begin() {
    this.#rows = [];
    this.#show("Each picture is recorded until you press Record again, for ten minutes at most.");
  }

  #end() {
    const rows = this.#rows ?? [];
    this.#rows = null;
    if (!rows.length) return this.#show("Nothing was recorded.");
    const felt = Array.from({ length: rows[0].length - 5 }, (_, n) => `deflection_${n}`);
    save("recorded.csv", csv([["tick", "time_s", "x_mm", "y_mm", "theta_rad", ...felt], ...rows]));
    this.#show(`${rows.length} pictures are saved as recorded.csv, a row each, with the deflections row by row.`);
  }

  /** @param {string} words */
  #show(words) {
    byId("record").setAttribute("aria-pressed", String(this.#rows !== null));
    write(byId("saved"), words);
  }

  /**
   * Takes a frame that is drawn.
   * @param {Frame} frame
   */
  take(frame) {
    if (!this.#rows || !frame.deflections.length) return;
    if (this.#rows.length && this.#rows[0].length !== 5 + frame.deflections.length) return this.#end();
    const { tick, time_s, x_mm, y_mm, theta_rad } = frame;
    this.#rows.push([tick, ...[time_s, x_mm, y_mm, theta_rad].map(cell), ...Array.from(frame.deflections, cell)]);
    if (this.#rows.length >= MOST_FRAMES) this.#end();
  }
}
