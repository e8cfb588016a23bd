// Elements of HTML and SVG, and figures that are drawn again when their width changes.

const SVG = 'http://www.w3.org/2000/svg';

function fill(node, attributes, children) {
  for (const [name, value] of Object.entries(attributes ?? {})) {
    if (value === null || value === undefined || value === false) continue;
    if (name.startsWith('on')) node.addEventListener(name.slice(2), value);
    else node.setAttribute(name, value === true ? '' : value);
  }
  node.append(...children.flat(Infinity).filter((child) => child !== null && child !== undefined && child !== false));
  return node;
}

/** An HTML element. */
export const html = (tag, attributes, ...children) => fill(document.createElement(tag), attributes, children);

/** An SVG element. */
export const svg = (tag, attributes, ...children) => fill(document.createElementNS(SVG, tag), attributes, children);

/** The `d` of a polyline through points. */
export const path = (points) => points.map(([x, y], i) => `${i === 0 ? 'M' : 'L'}${x.toFixed(2)} ${y.toFixed(2)}`).join('');

/** A section of the page with a heading, hidden until it is filled. */
export function section(id, heading, ...children) {
  const node = html('section', { id, 'aria-labelledby': `${id}-heading` }, html('h2', { id: `${id}-heading` }, heading), ...children);
  document.querySelector('main').append(node);
  return node;
}

/** Calls `draw(width_px)` now and whenever the container's width changes. Returns a function that draws again at the same width. */
export function drawnToWidth(container, draw) {
  let width_px = 0;
  const again = () => width_px > 0 && draw(width_px);
  const measure = () => {
    const measured = Math.max(280, Math.round(container.clientWidth));
    if (measured === width_px) return;
    width_px = measured;
    draw(width_px);
  };
  new ResizeObserver(measure).observe(container);
  measure();
  return again;
}

/** Round values between two numbers, about so many. */
export function ticks(low, high, about) {
  const rough = (high - low) / Math.max(1, about);
  if (!(rough > 0) || !Number.isFinite(rough)) return [low];
  const power = 10 ** Math.floor(Math.log10(rough));
  const step = [1, 2, 5, 10].map((factor) => factor * power).find((candidate) => candidate >= rough * 0.999);
  const first = Math.ceil(low / step - 1e-9);
  const last = Math.floor(high / step + 1e-9);
  return Array.from({ length: Math.max(0, last - first + 1) }, (_, i) => (first + i) * step);
}

/** Decimals that tell neighbouring ticks apart. */
export function tickDecimals(values) {
  if (values.length < 2) return 2;
  return Math.max(0, Math.ceil(-Math.log10(Math.abs(values[1] - values[0])) - 1e-9));
}
