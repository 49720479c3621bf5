/**
 * Being the hand of a simulated device: the array is drawn along by mouse, pen or finger, or goes by
 * arrow keys. A place is sent at its event, and no second one before the next picture is drawn; then
 * the newest goes out.
 */

import { sayWhere } from "./braille.js";
import { byId, clamp, put } from "./elements.js";

const STEP_MM = 0.5;
const LEAP_MM = 5;
const TURN_RAD = Math.PI / 36;
const CALM_MS = 1000; // how often a hand that moves by itself is named anew
const OWN_MS = 400; // for so long after it was moved here, it is named often

export class Hand {
  moved = -Infinity; // when the hand was moved here last
  #steers = false;
  #state = null;
  #frame = null;
  #wanted = null; // a place that is not yet sent
  #sent = false; // whether a place went out since the last picture
  #target = null; // where the hand is going
  #grip = null;
  #named = -Infinity;

  constructor(sheet, ask, wake) {
    this.sheet = sheet;
    this.ask = ask;
    this.wake = wake;
    const { moving, array } = sheet;
    moving.addEventListener("pointerdown", (event) => this.#down(event));
    // All but raw updates are held back until the browser draws.
    moving.addEventListener("onpointerrawupdate" in moving ? "pointerrawupdate" : "pointermove", (event) => this.#drag(event));
    for (const end of ["pointerup", "pointercancel"]) moving.addEventListener(end, () => this.#up());
    array.addEventListener("keydown", (event) => this.#key(event));
    array.addEventListener("focus", () => this.#name(true));
    byId("let-go").addEventListener("click", () => this.letGo());
    document.addEventListener("keydown", (event) => {
      if (event.key === "Escape" && this.#state?.held) this.letGo();
    });
  }

  /** Whether this page may be the hand. */
  get can() {
    return Boolean(this.#steers && this.#state?.simulated && this.#state.array && !this.#state.done);
  }

  show(state, steers) {
    [this.#state, this.#steers] = [state, steers];
    const { can } = this;
    const { array, moving } = this.sheet;
    const two = state.array?.height_mm > 0;
    array.classList.toggle("loose", can);
    moving.classList.toggle("free", can && two);
    moving.classList.toggle("along", can && !two);
    byId("let-go").hidden = !(can && state.held);
    if (!state.held && !this.#grip && performance.now() - this.moved > OWN_MS) this.#target = null;
    put(array, "role", can ? "slider" : "img");
    put(array, "aria-label", can ? "The hand: the array on the page" : "The array on the page");
    const [low, high] = can ? this.#reach() : [0, 0];
    const slides = { tabindex: 0, "aria-valuemin": low.toFixed(1), "aria-valuemax": high.toFixed(1) };
    if (can) for (const [name, value] of Object.entries(slides)) put(array, name, value);
    else for (const name of [...Object.keys(slides), "aria-valuenow", "aria-valuetext"]) array.removeAttribute(name);
    this.#name(true);
  }

  /** How far the array's centre goes along x. */
  #reach() {
    const { columns, column_pitch_mm, travel_mm } = this.#state.array;
    const half = ((columns - 1) / 2) * column_pitch_mm;
    return [-half, travel_mm - half];
  }

  /** Keeps the newest frame. */
  see(frame) {
    this.#frame = frame;
    this.#name(false);
  }

  /** Names where the hand is; not often, or a screen reader would never end. */
  #name(now) {
    const time = performance.now();
    const own = time - this.moved < OWN_MS;
    if (!this.can || (!now && time - this.#named < (own ? 150 : CALM_MS))) return;
    const focused = document.activeElement === this.sheet.array;
    if (!now && focused && !own && this.#named > this.moved + OWN_MS) return;
    const known = Number.isFinite(this.#frame?.x_mm);
    this.#named = known ? time : -Infinity; // a place is named as soon as it is known
    put(this.sheet.array, "aria-valuenow", known ? this.#frame.x_mm.toFixed(1) : "0.0");
    put(this.sheet.array, "aria-valuetext", sayWhere(this.#state, this.#frame));
  }

  #here() {
    const { x_mm, y_mm, theta_rad } = this.#frame ?? {};
    return this.#target ?? { x: x_mm || 0, y: y_mm || 0, theta: theta_rad || 0 };
  }

  /** Takes the hand to a place, as far as the carriage goes. */
  to(place) {
    if (!this.can) return;
    const { height_mm, turns } = this.#state.array;
    this.#target = this.#wanted = { x: clamp(place.x, ...this.#reach()), y: clamp(place.y, 0, height_mm), theta: turns ? place.theta : 0 };
    this.moved = performance.now();
    if (!this.#sent) this.#point();
    this.wake();
  }

  /** Lets the hand of the device go on by itself. */
  letGo() {
    this.#wanted = this.#target = this.#grip = null;
    this.ask({ ask: "let-go" });
    if (document.activeElement === byId("let-go")) this.sheet.array.focus();
  }

  /** Sends the newest place, if it has not gone out; called once for each picture. */
  send() {
    this.#sent = false;
    this.#point();
  }

  #point() {
    if (!this.#wanted) return;
    const { x, y, theta } = this.#wanted;
    [this.#wanted, this.#sent] = [null, true];
    this.ask({ ask: "point", x_mm: x, y_mm: y, theta_rad: theta });
  }

  #down(event) {
    if (!this.can || event.button !== 0) return;
    const [at, here] = [this.sheet.point(event), this.#here()];
    const gripped = this.sheet.array.contains(event.target);
    // Elsewhere on the page the hand comes there, as the thumb of a slider does.
    this.#grip = gripped ? { dx: here.x - at.x, dy: here.y - at.y } : { dx: 0, dy: 0 };
    this.sheet.moving.setPointerCapture(event.pointerId);
    this.sheet.array.classList.add("gripped");
    this.sheet.array.focus({ preventScroll: true });
    if (!gripped) this.to({ ...at, theta: here.theta });
    event.preventDefault();
  }

  #drag(event) {
    if (!this.#grip) return;
    const at = this.sheet.point(event);
    this.to({ x: at.x + this.#grip.dx, y: at.y + this.#grip.dy, theta: this.#here().theta });
  }

  #up() {
    this.#grip = null;
    this.sheet.array.classList.remove("gripped");
  }

  #key(event) {
    if (!this.can || event.altKey || event.ctrlKey || event.metaKey) return;
    const step = event.shiftKey ? LEAP_MM : STEP_MM;
    const two = this.#state.array.height_mm > 0;
    const line = this.#state.geometry.line_pitch_mm ?? 10;
    const here = this.#here();
    const [low, high] = this.#reach();
    const along = (by) => ({ x: here.x + by });
    const down = (by, otherwise) => (two ? { y: here.y + by } : along(-otherwise));
    const place = {
      ArrowRight: along(step), ArrowLeft: along(-step), ArrowDown: down(step, step), ArrowUp: down(-step, -step),
      PageDown: down(line, LEAP_MM), PageUp: down(-line, -LEAP_MM), Home: { x: low }, End: { x: high },
      "[": { theta: here.theta + TURN_RAD }, "]": { theta: here.theta - TURN_RAD },
    }[event.key];
    if (!place) return;
    event.preventDefault();
    this.to({ ...here, ...place });
  }
}
