/** Elements of HTML and SVG, rulers, and numbers as people read them. */

const SVG = "http://www.w3.org/2000/svg";

/**
 * An element of SVG.
 * @template {keyof SVGElementTagNameMap} K
 * @param {K} name
 * @param {Record<string, string | number>} [attributes]
 * @param {Array<Node | string>} children
 * @returns {SVGElementTagNameMap[K]}
 */
export function svg(name, attributes = {}, ...children) {
  const made = document.createElementNS(SVG, name);
  for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, String(value));
  made.append(...children);
  return made;
}

/**
 * An element of HTML.
 * @template {keyof HTMLElementTagNameMap} K
 * @param {K} name
 * @param {Record<string, string | number>} [attributes]
 * @param {Array<Node | string>} children
 * @returns {HTMLElementTagNameMap[K]}
 */
export function html(name, attributes = {}, ...children) {
  const made = document.createElement(name);
  for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, String(value));
  made.append(...children);
  return made;
}

/**
 * The element with an id, which must be there.
 * @param {string} id
 */
export function byId(id) {
  const found = document.getElementById(id);
  if (found === null) throw new Error(`no element #${id}`);
  return found;
}

/**
 * A button that does something.
 * @param {string} words
 * @param {() => void} then
 * @param {Record<string, string>} [attributes]
 */
export function button(words, then, attributes = {}) {
  const made = html("button", { type: "button", ...attributes }, words);
  made.addEventListener("click", then);
  return made;
}

/**
 * Sets an attribute only where it changes, so that nothing is drawn again for nothing.
 * @param {Element} element
 * @param {string} name
 * @param {string} value
 */
export function put(element, name, value) {
  if (element.getAttribute(name) !== value) element.setAttribute(name, value);
}

/**
 * Sets a text only where it changes.
 * @param {Element} element
 * @param {string} words
 */
export function write(element, words) {
  if (element.textContent !== words) element.textContent = words;
}

/**
 * A number with so many places and a real minus.
 * @param {number} value
 * @param {number} places
 */
export function fixed(value, places = 1) {
  if (!Number.isFinite(value)) return "–";
  const words = value.toFixed(places);
  return (Number(words) === 0 ? words.replace("-", "") : words).replace("-", "−");
}

/**
 * A number as short as it goes, such as 0.1 or 14.
 * @param {number} value
 */
export const short = (value) => String(Math.round(value * 1e4) / 1e4).replace("-", "−");

/**
 * The ticks of a ruler as three paths and its labels.
 * @param {number} from beginning of the scale in mm
 * @param {number} to its end
 * @param {number} at where the ruler stands, across
 * @param {boolean} down whether it goes down a side, else along the top
 * @param {number} px_mm pixels for a mm, by which the finest ticks are chosen
 * @returns {SVGGElement}
 */
export function ruler(from, to, at, down, px_mm) {
  const px = 1 / px_mm;
  const fine = [0.1, 0.5, 1, 5, 10].find((step) => step * px_mm >= 3.6) ?? 10;
  const label = [0.5, 1, 2, 5, 10, 20, 50, 100].find((step) => step * px_mm >= (down ? 22 : 38)) ?? 100;
  const group = svg("g", { class: "ruler" });
  let path = "";
  const last = Math.floor(to / fine + 1e-6);
  for (let n = Math.ceil(from / fine - 1e-6); n <= last; n++) {
    const place = n * fine;
    const named = isWhole(place / label);
    const length = (named ? 9 : isWhole((2 * place) / label) ? 6 : 3.5) * px;
    const spot = short(place).replace("−", "-");
    path += down ? `M${at} ${spot}h${-length}` : `M${spot} ${at}v${-length}`;
    if (named) {
      const text = down
        ? svg("text", { x: at - 12 * px, y: place + 4 * px, "text-anchor": "end" }, short(place))
        : svg("text", { x: place, y: at - 12 * px, "text-anchor": "middle" }, short(place));
      group.append(text);
    }
  }
  const edge = down ? `M${at} ${from}V${to}` : `M${from} ${at}H${to}`;
  group.prepend(svg("path", { d: edge + path, class: "ticks" }));
  return group;
}

/** @param {number} value */
const isWhole = (value) => Math.abs(value - Math.round(value)) < 1e-6;
