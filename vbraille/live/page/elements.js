/** Elements of HTML and SVG, numbers as people read them, rulers, and canvases that draw in mm. */

const SVG = "http://www.w3.org/2000/svg";
const MOST_SHARP = 4; // beyond that no eye sees a difference

function made(element, attributes, children) {
  for (const [key, value] of Object.entries(attributes)) element.setAttribute(key, String(value));
  element.append(...children);
  return element;
}

/** @returns {any} */
export const svg = (name, attributes = {}, ...children) => made(document.createElementNS(SVG, name), attributes, children);

/** @returns {any} */
export const html = (name, attributes = {}, ...children) => made(document.createElement(name), attributes, children);

/** @returns {any} */
export const byId = (id) => document.getElementById(id);

export function button(words, then, attributes = {}) {
  const element = html("button", { type: "button", ...attributes }, words);
  element.addEventListener("click", then);
  return element;
}

/** Sets an attribute only where it changes, so that nothing is drawn again for nothing. */
export function put(element, name, value) {
  if (element.getAttribute(name) !== String(value)) element.setAttribute(name, value);
}

/** Sets a text only where it changes. */
export function write(element, words) {
  if (element.textContent !== words) element.textContent = words;
}

/** A number with a count of places and a real minus; a dash for none. */
export function fixed(value, places = 1) {
  if (!Number.isFinite(value)) return "–";
  const words = value.toFixed(places);
  return (Number(words) === 0 ? words.replace("-", "") : words).replace("-", "−");
}

/** A number as short as it goes, such as 0.1 or 14. */
export const short = (value) => String(Math.round(value * 1e4) / 1e4).replace("-", "−");

/** A time, such as "1:02.345". */
export function clock(seconds) {
  const minutes = Math.floor(seconds / 60 + 1e-9);
  return `${minutes}:${fixed(Math.max(seconds - 60 * minutes, 0), 3).padStart(6, "0")}`;
}

export const clamp = (value, low, high) => Math.min(Math.max(value, low), high);

const isWhole = (value) => Math.abs(value - Math.round(value)) < 1e-6;

/** A ruler in mm: along the top at a height, or down a side; its finest ticks are some pixels apart. */
export function ruler(from, to, at, down, px_mm) {
  const px = 1 / px_mm;
  const fine = [0.1, 0.5, 1, 5, 10].find((step) => step * px_mm >= 3.6) ?? 10;
  const label = [0.5, 1, 2, 5, 10, 20, 50, 100].find((step) => step * px_mm >= (down ? 22 : 38)) ?? 100;
  let path = down ? `M${at} ${from}V${to}` : `M${from} ${at}H${to}`;
  const labels = [];
  for (let n = Math.ceil(from / fine - 1e-6); n <= Math.floor(to / fine + 1e-6); n++) {
    const place = Math.round(n * fine * 1e4) / 1e4;
    const named = isWhole(place / label);
    const length = (named ? 9 : isWhole((2 * place) / label) ? 6 : 3.5) * px;
    path += down ? `M${at} ${place}h${-length}` : `M${place} ${at}v${-length}`;
    if (!named) continue;
    const where = down ? { x: at - 12 * px, y: place + 4 * px, "text-anchor": "end" } : { x: place, y: at - 12 * px, "text-anchor": "middle" };
    labels.push(svg("text", where, short(place)));
  }
  return svg("g", { class: "ruler" }, svg("path", { d: path, class: "ticks" }), ...labels);
}

/** Calls when the screen's pixels change: with the zoom, or when the window goes to another screen. */
export function onResolution(then) {
  matchMedia(`(resolution: ${devicePixelRatio}dppx)`).addEventListener("change", () => (then(), onResolution(then)), { once: true });
}

/** What changes with each frame is drawn in pixels, over a drawing in mm that stands still. */
export class Canvas {
  #scale = 1;
  #left = 0;
  #top = 0;

  constructor(opaque) {
    this.opaque = opaque;
    this.element = html("canvas", { "aria-hidden": "true" });
    this.pen = this.element.getContext("2d", { alpha: !opaque });
  }

  /** Sets its size in pixels of the page, and the place in mm of its upper left corner. */
  fit(left, top, wide, high, px_mm) {
    const sharp = Math.min(devicePixelRatio, MOST_SHARP);
    [this.#left, this.#top, this.#scale] = [left, top, px_mm * sharp];
    const { element } = this;
    [element.width, element.height] = [wide, high].map((px) => Math.max(Math.ceil(px * sharp), 1));
    [element.style.width, element.style.height] = [`${element.width / sharp}px`, `${element.height / sharp}px`];
  }

  /** Wipes it; then the pen draws in mm. */
  begin(paper = "") {
    const { pen, element } = this;
    pen.setTransform(1, 0, 0, 1, 0, 0);
    pen.fillStyle = paper;
    if (this.opaque) pen.fillRect(0, 0, element.width, element.height);
    else pen.clearRect(0, 0, element.width, element.height);
    pen.setTransform(this.#scale, 0, 0, this.#scale, -this.#left * this.#scale, -this.#top * this.#scale);
    return pen;
  }
}
