// The path from above, over a hillshade of the posts or over the facets that face up, with bands of height and layers.

import { drawnToWidth, html, path, svg, tickDecimals, ticks } from './dom.js';
import { heightBands, isMarked } from './ground.js';
import { selectByArrows } from './selection.js';
import { count, fixed, percent } from './words.js';

const LEFT = 74;
const RIGHT = 10;
const TOP = 30;
const BOTTOM = 40;

export function planFigure(section, mission, ground, selection) {
  const state = { near: true, bands: false, layers: new Set(ground.layers.map((layer) => layer.name)) };
  const frame = html('div', { class: 'figure plan', tabindex: '0', role: 'group', 'aria-label': 'Path from above; left and right arrows select hops' });
  const legend = html('ul', { class: 'legend' });
  const controls = html('div', { class: 'controls no-print' });
  const hasGround = ground.posts !== null || ground.facets !== null;
  if (hasGround) {
    const choice = (near, text) =>
      html('button', { type: 'button', 'aria-pressed': String(state.near === near), onclick: () => show({ near }), 'data-near': String(near) }, text);
    controls.append(choice(true, 'Path'), choice(false, 'Whole ground'));
  }
  const box = (text, checked, change) => html('label', {}, html('input', { type: 'checkbox', checked, onchange: (event) => change(event.target.checked) }), ` ${text}`);
  if (ground.posts) controls.append(box('bands of height', false, (bands) => show({ bands })));
  for (const layer of ground.layers) {
    controls.append(
      box(layer.name, true, (on) => {
        if (on) state.layers.add(layer.name);
        else state.layers.delete(layer.name);
        show({});
      }),
    );
  }
  section.append(controls, frame, legend);
  const groundPicture = pictureOf(ground, mission.legs.flatMap((leg) => leg.plannedInSpace(12) ?? []));
  const again = drawnToWidth(frame, (width) => frame.replaceChildren(...drawing(width)));

  function show(change) {
    Object.assign(state, change);
    for (const button of controls.querySelectorAll('button')) button.setAttribute('aria-pressed', String(button.dataset.near === String(state.near)));
    again();
  }

  selection.listen(again);
  selectByArrows(frame, selection);

  function drawing(width) {
    const view = extent(mission, ground, state.near);
    const wide = width - LEFT - RIGHT;
    const scale = Math.min(wide / (view.east_m - view.west_m), Math.max(260, Math.min(560, wide)) / (view.north_m - view.south_m));
    const [w, h] = [(view.east_m - view.west_m) * scale, (view.north_m - view.south_m) * scale];
    const left = LEFT + (wide - w) / 2;
    const x = (x_m) => left + (x_m - view.west_m) * scale;
    const y = (y_m) => TOP + (view.north_m - y_m) * scale;
    const height = TOP + h + BOTTOM;
    const root = svg('svg', { viewBox: `0 0 ${width} ${height}`, role: 'img', 'aria-label': 'Map of the path' });
    root.append(svg('defs', {}, svg('clipPath', { id: 'clip-plan' }, svg('rect', { x: left, y: TOP, width: w, height: h }))));
    const plot = svg('g', { 'clip-path': 'url(#clip-plan)' });
    root.append(plot);
    if (mission.legs.length === 0) {
      for (const piece of mission.ground.pieces ?? []) {
        if (piece.map_x_m) plot.append(svg('path', { class: 'transect', d: path(piece.map_x_m.map((px, i) => [x(px), y(piece.map_y_m[i])])) }));
      }
    }
    const flat = (points) => path(points.map(([px, py]) => [x(px), y(py)]));
    for (const leg of mission.legs) {
      const points = leg.plannedInSpace(1);
      if (!points) continue;
      const selected = leg.index === selection.leg;
      plot.append(
        svg(
          'g',
          { class: `leg ${leg.kind}${selected ? ' selected' : ''}`, 'data-leg': leg.index, onclick: () => selection.select(leg.index) },
          svg('title', {}, leg.name),
          svg('path', { class: 'casing', d: flat(points) }),
          svg('path', { class: 'hit', d: flat(points) }),
          svg('path', { class: leg.kind === 'hop' ? 'arc' : 'wheels', d: flat(points) }),
          svg('circle', { class: 'contact', cx: x(leg.end.x_m), cy: y(leg.end.y_m), r: 2.6 }),
        ),
      );
    }
    for (const [fx, fy] of mission.feet) plot.append(svg('circle', { class: 'foot', cx: x(fx), cy: y(fy), r: 1.6 }));
    for (const { name, x_m, y_m } of mission.places) {
      const right = x(x_m) > left + 0.8 * w;
      plot.append(
        svg('rect', { class: 'place', x: x(x_m) - 4, y: y(y_m) - 4, width: 8, height: 8 }),
        svg('text', { class: 'place-name', x: x(x_m) + (right ? -8 : 8), y: y(y_m) - 6, 'text-anchor': right ? 'end' : 'start' }, name),
      );
    }
    decorate(root, { x, y, view, left, w, h, scale });
    const drawn = [root];
    if (hasGround) {
      const clip = html('div', { class: 'under' });
      const canvas = groundPicture(state);
      Object.assign(clip.style, { left: `${(100 * left) / width}%`, top: `${(100 * TOP) / height}%`, width: `${(100 * w) / width}%`, height: `${(100 * h) / height}%` });
      const { west_m, east_m, south_m, north_m } = canvas.bounds;
      Object.assign(canvas.element.style, {
        left: `${(100 * (west_m - view.west_m) * scale) / w}%`,
        top: `${(100 * (view.north_m - north_m) * scale) / h}%`,
        width: `${(100 * (east_m - west_m) * scale) / w}%`,
        height: `${(100 * (north_m - south_m) * scale) / h}%`,
      });
      clip.append(canvas.element);
      drawn.unshift(clip);
    }
    tell();
    return drawn;
  }

  function tell() {
    const swatch = (colour, text, name = '') => {
      const sample = html('span', { class: `swatch ${name}` });
      if (colour) sample.style.background = colour;
      return html('li', {}, sample, ` ${text}`);
    };
    const items = [];
    if (state.bands && ground.posts) {
      for (const { from_m, to_m, colour } of heightBands(...ground.posts.range_m)) items.push(swatch(`rgb(${colour})`, `${fixed(from_m)} to ${fixed(to_m)} m`));
    }
    for (const { name, share, stripes } of ground.layers) {
      if (!state.layers.has(name)) continue;
      const colour = `rgb(${stripes.colour})`;
      items.push(swatch(`repeating-linear-gradient(${stripes.turn_deg}deg, ${colour} 0 3px, #fff 3px 6px)`, `${name}: ${percent(share)} of the posts`, 'striped'));
    }
    if (ground.posts) items.push(html('li', {}, thinned(mission.ground.posts)));
    if (ground.facets) items.push(html('li', {}, cutOut(mission.ground.facets)));
    legend.replaceChildren(...items);
  }
}

/** Which posts of the DEM the page holds, in words. */
function thinned({ rows, columns, of_rows, of_columns, stride }) {
  if (rows === of_rows && columns === of_columns) return `Hillshade of all ${rows} × ${columns} posts of the DEM.`;
  const every = stride === 1 ? '' : `, thinned to one post in ${stride} each way to keep the page small`;
  return `Hillshade of ${rows} × ${columns} posts about the path${every}; the DEM has ${of_rows} × ${of_columns}, with all of which the answer was computed.`;
}

function cutOut({ corners_count, of_facets }) {
  const shown = corners_count / 3;
  if (shown === of_facets) return `From above, of all ${count(of_facets, 'facet')} of the mesh, those that face up; those over the path are pale.`;
  return `The ${shown} facets of the mesh nearest to the path, of ${of_facets}; from above, those that face up, and those over the path pale.`;
}

function extent(mission, ground, near) {
  const whole = ground.posts?.bounds ?? ground.facets?.bounds ?? null;
  if (whole && !near) return whole;
  const points = mission.legs.flatMap((leg) => leg.plannedInSpace(1) ?? []).map(([x, y]) => [x, y]);
  for (const { x_m, y_m } of mission.places) points.push([x_m, y_m]);
  if (points.length === 0) {
    for (const piece of mission.ground.pieces ?? []) if (piece.map_x_m) points.push(...piece.map_x_m.map((x, i) => [x, piece.map_y_m[i]]));
  }
  let [west_m, east_m] = [Math.min(...points.map(([x]) => x)), Math.max(...points.map(([x]) => x))];
  let [south_m, north_m] = [Math.min(...points.map(([, y]) => y)), Math.max(...points.map(([, y]) => y))];
  const room_m = 0.12 * Math.max(east_m - west_m, north_m - south_m, 1e-6) + 0.25 * Math.max(0, 0.5 * (east_m - west_m) - (north_m - south_m));
  [west_m, east_m, south_m, north_m] = [west_m - room_m, east_m + room_m, south_m - room_m, north_m + room_m];
  // A path to the north or south gets ground on both sides, a path to the east or west on neither: pages are wide.
  const missing_m = Math.max(0, 1.1 * (north_m - south_m) - (east_m - west_m)) / 2;
  [west_m, east_m] = [west_m - missing_m, east_m + missing_m];
  if (!whole) return { west_m, east_m, south_m, north_m };
  return {
    west_m: Math.max(west_m, whole.west_m),
    east_m: Math.min(east_m, whole.east_m),
    south_m: Math.max(south_m, whole.south_m),
    north_m: Math.min(north_m, whole.north_m),
  };
}

/** The ground as a canvas with its bounds; drawn once for every choice of bands and layers. */
function pictureOf(ground, path_m) {
  const kept = new Map();
  return (state) => {
    const key = `${state.bands} ${[...state.layers].sort().join(',')}`;
    if (!kept.has(key)) kept.set(key, ground.posts ? postsPicture(ground, state) : facetsPicture(ground.facets, path_m));
    return kept.get(key);
  };
}

function postsPicture({ posts, layers }, state) {
  const element = html('canvas', { width: posts.columns, height: posts.rows });
  const context = element.getContext('2d');
  const image = context.createImageData(posts.columns, posts.rows);
  const bands = state.bands ? heightBands(...posts.range_m) : [];
  const shown = layers.filter((layer) => state.layers.has(layer.name));
  for (let row = 0; row < posts.rows; row += 1) {
    for (let column = 0; column < posts.columns; column += 1) {
      const index = row * posts.columns + column;
      const z_m = posts.z_m[index];
      const light = posts.shade(row, column);
      let colour = [255, 255, 255];
      if (!Number.isNaN(z_m)) {
        const grey = Number.isNaN(light) ? 0.7 : 0.35 + 0.65 * Math.max(0, Math.min(1, light));
        const band = bands.find(({ to_m }) => z_m <= to_m);
        colour = (band?.colour ?? [255, 252, 245]).map((part) => part * grey);
        const over = shown.find((layer) => layer.stripes.covers(row, column) && isMarked(layer, index));
        if (over) colour = over.stripes.colour.map((part) => 0.75 * part + 0.25 * 255 * grey);
      }
      image.data.set([...colour, 255], 4 * index);
    }
  }
  context.putImageData(image, 0, 0);
  const { west_m, east_m, south_m, north_m } = posts.bounds;
  const [x, y] = [posts.dx_m / 2, posts.dy_m / 2];
  return { element, bounds: { west_m: west_m - x, east_m: east_m + x, south_m: south_m - y, north_m: north_m + y } };
}

function facetsPicture(facets, path_m) {
  const { bounds } = facets;
  const [wide_m, high_m] = [bounds.east_m - bounds.west_m, bounds.north_m - bounds.south_m];
  const scale = 1600 / Math.max(wide_m, high_m);
  const element = html('canvas', { width: Math.max(1, Math.round(wide_m * scale)), height: Math.max(1, Math.round(high_m * scale)) });
  const context = element.getContext('2d');
  for (const { corners, light, isOver } of facets.facingUp(path_m)) {
    context.globalAlpha = isOver ? 0.25 : 1;
    const grey = Math.round(255 * (0.35 + 0.6 * light));
    context.fillStyle = `rgb(${grey}, ${grey}, ${Math.round(0.97 * grey)})`;
    context.strokeStyle = context.fillStyle;
    context.beginPath();
    for (const [x_m, y_m] of corners) context.lineTo((x_m - bounds.west_m) * scale, (bounds.north_m - y_m) * scale);
    context.closePath();
    context.fill();
    context.stroke();
  }
  return { element, bounds };
}

/** The greatest of 1, 2 and 5 times a power of ten that is at most this. */
function roundBelow(value) {
  const power = 10 ** Math.floor(Math.log10(value));
  return [5, 2, 1].map((factor) => factor * power).find((candidate) => candidate <= value);
}

/** Frame, axes, scale bar and north arrow. */
function decorate(root, { x, y, view, left, w, h, scale }) {
  root.append(svg('rect', { class: 'frame', x: left, y: TOP, width: w, height: h }));
  const along = ticks(view.west_m, view.east_m, w / 110);
  const up = ticks(view.south_m, view.north_m, h / 60);
  const [alongDecimals, upDecimals] = [tickDecimals(along), tickDecimals(up)];
  for (const value of along) {
    root.append(
      svg('line', { class: 'tick', x1: x(value), x2: x(value), y1: TOP + h, y2: TOP + h + 4 }),
      svg('text', { class: 'number', x: x(value), y: TOP + h + 16, 'text-anchor': 'middle' }, fixed(value, alongDecimals)),
    );
  }
  for (const value of up) {
    root.append(
      svg('line', { class: 'tick', x1: left - 4, x2: left, y1: y(value), y2: y(value) }),
      svg('text', { class: 'number', x: left - 6, y: y(value) + 4, 'text-anchor': 'end' }, fixed(value, upDecimals)),
    );
  }
  root.append(
    svg('text', { class: 'axis-name', x: left + w / 2, y: TOP + h + 34, 'text-anchor': 'middle' }, 'map x, east (m)'),
    svg('text', { class: 'axis-name', x: 12, y: TOP + h / 2, transform: `rotate(-90 12 ${TOP + h / 2})`, 'text-anchor': 'middle' }, 'map y, north (m)'),
  );
  const bar_m = roundBelow((0.3 * w) / scale);
  root.append(
    svg('path', { class: 'scale', d: `M${left} ${TOP - 14}v6h${bar_m * scale}v-6` }),
    svg('text', { class: 'number', x: left + bar_m * scale + 6, y: TOP - 8 }, `${fixed(bar_m)} m`),
    svg('path', { class: 'north', d: `M${left + w - 6} ${TOP - 24}l5 18l-5 -4l-5 4z` }),
    svg('text', { class: 'number', x: left + w - 16, y: TOP - 8, 'text-anchor': 'end' }, 'grid north'),
  );
}
