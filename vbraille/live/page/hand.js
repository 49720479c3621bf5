/**
 * Being the hand of a simulated device: the array is drawn along by mouse, pen or finger, or goes
 * by arrow keys. A place is sent at its event, and no second one before the next picture is drawn;
 * then the newest goes out.
 */

import { sayWhere } from "./braille.js";
import { byId, put } from "./drawing.js";

/** @typedef {import("./messages.js").State} State */
/** @typedef {import("./messages.js").Frame} Frame */

const STEP_MM = 0.5;
const LEAP_MM = 5;
const TURN_RAD = Math.PI / 36;
const CALM_MS = 1000; // how often a hand that moves by itself is named anew

/** @typedef {{x: number, y: number, theta: number}} Place */

export class Hand {
  /** @type {State | null} */
  #state = null;
  /** @type {Frame | null} */
  #frame = null;
  /** @type {Place | null} */
  #wanted = null; // not yet sent
  #sent = false; // whether a place went out since the last picture
  /** @type {Place | null} */
  #target = null; // where the hand is or is going
  /** @type {{dx: number, dy: number} | null} */
  #grip = null;
  #named = -Infinity;
  steers = false;
  /** When the hand was moved here last. */
  moved = -Infinity;

  /**
   * @param {import("./sheet.js").Sheet} sheet
   * @param {(request: {ask: string} & Record<string, unknown>) => void} ask
   * @param {() => void} wake
   */
  constructor(sheet, ask, wake) {
    this.sheet = sheet;
    this.ask = ask;
    this.wake = wake;
    const drawing = sheet.moving;
    drawing.addEventListener("pointerdown", (event) => this.#down(event));
    // All but raw updates are held back until the browser draws.
    const moves = "onpointerrawupdate" in drawing ? "pointerrawupdate" : "pointermove";
    drawing.addEventListener(moves, (event) => this.#drag(/** @type {PointerEvent} */ (event)));
    for (const end of ["pointerup", "pointercancel"]) drawing.addEventListener(end, () => this.#up());
    sheet.array.addEventListener("keydown", (event) => this.#key(event));
    sheet.array.addEventListener("focus", () => this.#name(true));
    byId("let-go").addEventListener("click", () => this.letGo());
    document.addEventListener("keydown", (event) => {
      if (event.key === "Escape" && this.#state?.held) this.letGo();
    });
  }

  /** Whether this page may be the hand. */
  get can() {
    return Boolean(this.steers && this.#state?.simulated && this.#state.array && !this.#state.done);
  }

  /**
   * @param {State} state
   * @param {boolean} steers
   */
  show(state, steers) {
    this.#state = state;
    this.steers = steers;
    const finger = this.sheet.array;
    const array = state.array;
    finger.classList.toggle("loose", this.can);
    this.sheet.moving.classList.toggle("free", this.can && (array?.height_mm ?? 0) > 0);
    this.sheet.moving.classList.toggle("along", this.can && (array?.height_mm ?? 0) === 0);
    byId("let-go").hidden = !(this.can && state.held);
    if (!state.held && !this.#grip && performance.now() - this.moved > 500) this.#target = null;
    if (this.can && array) {
      const [low, high] = this.#reach(array);
      put(finger, "role", "slider");
      put(finger, "tabindex", "0");
      put(finger, "aria-label", "The hand: the array on the page");
      put(finger, "aria-valuemin", low.toFixed(1));
      put(finger, "aria-valuemax", high.toFixed(1));
      this.#name(true);
    } else {
      put(finger, "role", "img");
      put(finger, "aria-label", "The array on the page");
      for (const name of ["tabindex", "aria-valuemin", "aria-valuemax", "aria-valuenow", "aria-valuetext"]) finger.removeAttribute(name);
    }
  }

  /**
   * How far the array's centre goes along x.
   * @param {import("./messages.js").ArrayShown} array
   * @returns {[number, number]}
   */
  #reach(array) {
    const half = ((array.columns - 1) / 2) * array.column_pitch_mm;
    return [-half, array.travel_mm - half];
  }

  /**
   * Keeps the newest frame.
   * @param {Frame} frame
   */
  see(frame) {
    this.#frame = frame;
    this.#name(false);
  }

  /**
   * Names where the hand is; not often, or a screen reader would never end.
   * @param {boolean} now
   */
  #name(now) {
    const time = performance.now();
    const own = time - this.moved < 400;
    if (!this.can || !this.#state) return;
    const focused = document.activeElement === this.sheet.array;
    if (!now && time - this.#named < (own ? 150 : CALM_MS)) return;
    if (!now && focused && !own && this.#named > this.moved + 400) return;
    const x = Number(this.#frame?.x_mm ?? NaN);
    this.#named = Number.isFinite(x) ? time : -Infinity; // a place is named as soon as it is known
    put(this.sheet.array, "aria-valuenow", (x || 0).toFixed(1));
    put(this.sheet.array, "aria-valuetext", sayWhere(this.#state, this.#frame));
  }

  /** @returns {Place} */
  #here() {
    const frame = this.#frame;
    const number = (/** @type {number | undefined} */ value) => (Number.isFinite(value) ? Number(value) : 0);
    return this.#target ?? { x: number(frame?.x_mm), y: number(frame?.y_mm), theta: number(frame?.theta_rad) };
  }

  /**
   * Takes the hand to a place, as far as the carriage goes.
   * @param {Place} place
   */
  to(place) {
    const array = this.#state?.array;
    if (!this.can || !array) return;
    const [low, high] = this.#reach(array);
    const y = array.height_mm > 0 ? Math.min(Math.max(place.y, 0), array.height_mm) : 0;
    this.#target = { x: Math.min(Math.max(place.x, low), high), y, theta: array.turns ? place.theta : 0 };
    this.#wanted = this.#target;
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
    this.#wanted = null;
    this.#sent = true;
    this.ask({ ask: "point", x_mm: x, y_mm: y, theta_rad: theta });
  }

  /** @param {PointerEvent} event */
  #down(event) {
    if (!this.can || event.button !== 0) return;
    const at = this.sheet.point(event);
    const here = this.#here();
    const gripped = event.target instanceof Element && this.sheet.array.contains(event.target);
    // Elsewhere on the page the hand comes there, as the thumb of a slider does.
    this.#grip = gripped ? { dx: here.x - at.x, dy: here.y - at.y } : { dx: 0, dy: 0 };
    this.sheet.moving.setPointerCapture(event.pointerId);
    this.sheet.array.classList.add("gripped");
    this.sheet.array.focus({ preventScroll: true });
    if (!gripped) this.to({ x: at.x, y: at.y, theta: here.theta });
    event.preventDefault();
  }

  /** @param {PointerEvent} event */
  #drag(event) {
    if (!this.#grip) return;
    const at = this.sheet.point(event);
    this.to({ x: at.x + this.#grip.dx, y: at.y + this.#grip.dy, theta: this.#here().theta });
  }

  #up() {
    this.#grip = null;
    this.sheet.array.classList.remove("gripped");
  }

  /** @param {KeyboardEvent} event */
  #key(event) {
    const array = this.#state?.array;
    if (!array || !this.can || event.altKey || event.ctrlKey || event.metaKey) return;
    const step = event.shiftKey ? LEAP_MM : STEP_MM;
    const two = array.height_mm > 0;
    const line = this.#state?.geometry.line_pitch_mm ?? 10;
    const here = this.#here();
    const [low, high] = this.#reach(array);
    const place = { ...here };
    switch (event.key) {
      case "ArrowRight": place.x += step; break;
      case "ArrowLeft": place.x -= step; break;
      case "ArrowDown": if (two) place.y += step; else place.x -= step; break;
      case "ArrowUp": if (two) place.y -= step; else place.x += step; break;
      case "PageDown": if (two) place.y += line; else place.x -= LEAP_MM; break;
      case "PageUp": if (two) place.y -= line; else place.x += LEAP_MM; break;
      case "Home": place.x = low; break;
      case "End": place.x = high; break;
      case "[": place.theta += TURN_RAD; break;
      case "]": place.theta -= TURN_RAD; break;
      default: return;
    }
    event.preventDefault();
    this.to(place);
  }
}
