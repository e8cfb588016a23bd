// The profile along the path: ground, every arc, the band between the lowest and the highest feasible arc of each hop; below it, on the same
// axis, the feasible take-off angles.

import { drawnToWidth, html, path, svg, tickDecimals, ticks } from './dom.js';
import { selectByArrows } from './selection.js';
import { count, fixed } from './words.js';

const LEFT = 76;
const RIGHT = 12;
const GAP = 44;

export function profileFigure(section, mission, selection) {
  const state = { whole: true };
  const frame = html('div', { class: 'figure', tabindex: '0', role: 'group', 'aria-label': 'Profile; left and right arrows select hops' });
  const caption = html('p', { class: 'note' });
  const controls = html('div', { class: 'controls no-print' });
  const choice = (whole, text) =>
    html('button', { type: 'button', 'aria-pressed': String(state.whole === whole), onclick: () => show(whole), 'data-whole': String(whole) }, text);
  controls.append(choice(true, 'Whole path'), choice(false, 'Selected leg'));
  section.append(controls, frame, caption);
  const again = drawnToWidth(frame, (width) => frame.replaceChildren(drawing(width)));

  function show(whole) {
    state.whole = whole;
    for (const button of controls.children) button.setAttribute('aria-pressed', String(button.dataset.whole === String(whole)));
    again();
  }

  selection.listen(again);
  selectByArrows(frame, selection);

  function drawing(width) {
    const view = extent(mission, selection, state.whole);
    const plotWidth = width - LEFT - RIGHT;
    const top = 10;
    const profileHeight = Math.max(170, Math.min(330, plotWidth * 0.42));
    const anglesTop = top + profileHeight + GAP;
    const hasHops = mission.hops.length > 0;
    const anglesHeight = hasHops ? 120 : 0;
    const height = hasHops ? anglesTop + anglesHeight + 40 : top + profileHeight + 40;
    const x = (along_m) => LEFT + ((along_m - view.from_m) / (view.to_m - view.from_m)) * plotWidth;
    const z = (z_m) => top + ((view.high_m - z_m) / (view.high_m - view.low_m)) * profileHeight;
    const times = (view.to_m - view.from_m) / plotWidth / ((view.high_m - view.low_m) / profileHeight);
    caption.replaceChildren(
      `Heights are drawn ${fixed(times, 2)} times as large as distances. `,
      mission.legs.some((leg) => leg.start.x_m !== undefined)
        ? 'The profile is unrolled along the path: where a free route turns, the next part of the ground begins. '
        : '',
      hasHops ? 'Pale bands lie between the lowest and the highest feasible arc of a hop; the frame cuts what is higher.' : '',
    );
    const root = svg('svg', { viewBox: `0 0 ${width} ${height}`, role: 'img', 'aria-label': `Profile with ${count(mission.legs.length, 'leg')}` });
    const clip = (id, y, h) => svg('clipPath', { id }, svg('rect', { x: LEFT, y, width: plotWidth, height: h }));
    root.append(svg('defs', {}, clip('clip-profile', top, profileHeight), clip('clip-angles', anglesTop, anglesHeight)));
    const plot = svg('g', { 'clip-path': 'url(#clip-profile)' });
    root.append(plot);
    plot.append(...ground(mission, x, z, top + profileHeight));
    for (const leg of mission.legs) plot.append(drawnLeg(leg, x, z));
    plot.append(...marks(mission, x, width - RIGHT, top, profileHeight));
    if (selection.tried) {
      const points = selection.selected.alongProfile(selection.tried, 64).map(([s, h]) => [x(s), z(h)]);
      plot.append(svg('path', { class: 'arc tried', d: path(points) }));
    }
    axes(root, { x, y: z, view, left: LEFT, top, width: plotWidth, height: profileHeight, label: 'height (m)', low: view.low_m, high: view.high_m });
    if (hasHops) root.append(angles(x, anglesTop, anglesHeight, plotWidth, view));
    const below = hasHops ? anglesTop + anglesHeight : top + profileHeight;
    root.append(svg('text', { class: 'axis-name', x: LEFT + plotWidth / 2, y: below + 34, 'text-anchor': 'middle' }, 'distance along the path (m)'));
    return root;
  }

  function drawnLeg(leg, x, z) {
    const selected = leg.index === selection.leg;
    const group = svg('g', { class: `leg ${leg.kind}${selected ? ' selected' : ''}`, 'data-leg': leg.index, onclick: () => selection.select(leg.index) });
    group.append(svg('title', {}, leg.name));
    if (leg.kind === 'hop') {
      const on = (arc) => leg.alongProfile(arc, 48).map(([s, h]) => [x(s), z(h)]);
      const [low, high] = leg.window_deg.map((angle_deg) => on(leg.arcAt(angle_deg)));
      group.append(svg('path', { class: 'band', d: `${path([...low, ...high.reverse()])}Z` }));
      const arc = on(leg.arc);
      group.append(svg('path', { class: 'hit', d: path(arc) }), svg('path', { class: 'arc', d: path(arc) }));
      for (const [px, py] of [arc[0], arc[arc.length - 1]]) group.append(svg('circle', { class: 'contact', cx: px, cy: py, r: 2.4 }));
    } else {
      const wheels = driven(leg).map(([s, h]) => [x(s), z(h)]);
      group.append(svg('path', { class: 'hit', d: path(wheels) }), svg('path', { class: 'wheels', d: path(wheels) }));
    }
    return group;
  }

  function angles(x, top, height, width, view) {
    const all = mission.hops.flatMap((leg) => leg.window_deg);
    // The angles that there are, to the next tens: windows of two degrees are not seen on an axis of ninety.
    const low = Math.floor((Math.min(...all) - 1) / 10) * 10;
    const high = Math.min(90, Math.ceil((Math.max(...all) + 1) / 10) * 10);
    const y = (angle_deg) => top + ((high - angle_deg) / (high - low)) * height;
    const root = svg('g', {});
    const plot = svg('g', { 'clip-path': 'url(#clip-angles)' });
    for (const leg of mission.hops) {
      const [from, to] = [x(leg.start.along_m), x(leg.end.along_m)].sort((a, b) => a - b);
      const selected = leg.index === selection.leg;
      const group = svg('g', { class: `leg hop${selected ? ' selected' : ''}`, 'data-leg': leg.index, onclick: () => selection.select(leg.index) });
      const [least, greatest] = leg.window_deg;
      const inset = Math.min(1.5, 0.1 * (to - from));
      const barTop = y(greatest);
      group.append(
        svg('title', {}, `${leg.name}: ${fixed(least, 2)} to ${fixed(greatest, 2)}°, planned ${fixed(leg.record.takeoff_angle_deg, 2)}°`),
        svg('rect', { class: 'window', x: from + inset, y: barTop, width: Math.max(1, to - from - 2 * inset), height: Math.max(2, y(least) - barTop) }),
        svg('line', { class: 'chosen', x1: from + inset, x2: to - inset, y1: y(leg.record.takeoff_angle_deg), y2: y(leg.record.takeoff_angle_deg) }),
      );
      if (selected && selection.tried) {
        const at = y(selection.angle_deg);
        group.append(svg('line', { class: 'chosen tried', x1: from + inset, x2: to - inset, y1: at, y2: at }));
      }
      plot.append(group);
    }
    root.append(plot);
    axes(root, { x, y, view, left: LEFT, top, width, height, label: 'take-off angle (°)', low, high });
    return root;
  }
}

/** Points of a drive along the profile: its waypoints by their distance. */
export function driven(leg) {
  let along_m = leg.start.along_m;
  return leg.record.waypoints_m.map((at, i, all) => {
    if (i > 0) along_m += Math.hypot(at[0] - all[i - 1][0], at[1] - all[i - 1][1]);
    return [along_m, at[2]];
  });
}

/** The ground: polylines of a chain, or of each leg over a map; and for a mesh the segments in which its facets are cut. */
function ground(mission, x, z, bottom) {
  const marks = [];
  const offset = (leg) => (leg === null || leg === undefined ? [0, 1] : [mission.legs[leg].start.along_m, Math.sign(mission.legs[leg].end.along_m - mission.legs[leg].start.along_m) || 1]);
  for (const piece of mission.ground.pieces ?? []) {
    const [from, sign] = offset(piece.leg);
    const points = piece.x_m.map((d, i) => [x(from + sign * d), z(piece.z_m[i])]);
    const below = [[points[points.length - 1][0], bottom], [points[0][0], bottom]];
    marks.push(svg('path', { class: 'ground-fill', d: `${path([...points, ...below])}Z` }), svg('path', { class: 'ground', d: path(points) }));
  }
  for (const cut of mission.ground.cuts ?? []) {
    const [from, sign] = offset(cut.leg);
    const d = cut.segments_m.map(([a, za, b, zb]) => path([[x(from + sign * a), z(za)], [x(from + sign * b), z(zb)]])).join('');
    marks.push(svg('path', { class: 'ground', d }));
  }
  return marks;
}

/** Where the path could not go on, and where visits end. */
function marks(mission, x, right, top, height) {
  const { frontier, goal_x_m, start_x_m, hops } = mission.value;
  const line = (at_m, text, name) => [
    svg('line', { class: name, x1: x(at_m), x2: x(at_m), y1: top, y2: top + height }),
    x(at_m) > right - 60
      ? svg('text', { class: 'mark', x: x(at_m) - 4, y: top + 12, 'text-anchor': 'end' }, text)
      : svg('text', { class: 'mark', x: x(at_m) + 4, y: top + 12 }, text),
  ];
  const found = [];
  if (hops === null && start_x_m !== undefined && mission.legs.length === 0) {
    found.push(...line(start_x_m, 'start', 'end'), ...line(goal_x_m, 'goal', 'end'));
    if (frontier) found.push(...line(frontier.reached_x_m, 'reached', 'frontier'), ...line(frontier.leads_to_goal_from_x_m, 'leads to the goal', 'frontier'));
  }
  for (const [i, leg] of mission.legs.entries()) {
    const next = mission.legs[i + 1];
    if (leg.record.visit !== undefined && next && next.record.visit !== leg.record.visit) {
      found.push(...line(leg.end.along_m, leg.record.target === null ? 'start' : `target ${leg.record.target}`, 'end'));
    }
  }
  return found;
}

function extent(mission, selection, whole) {
  const pieces = mission.ground.pieces ?? [];
  const legs = whole || selection.leg === null ? mission.legs : [selection.selected];
  const along = legs.flatMap((leg) => [leg.start.along_m, leg.end.along_m]);
  if (along.length === 0) {
    for (const piece of pieces) along.push(...piece.x_m);
    const { start_x_m, goal_x_m } = mission.value;
    if (start_x_m !== undefined) along.push(start_x_m, goal_x_m);
  }
  if (along.length === 0) along.push(0, 1);
  let [from_m, to_m] = [Math.min(...along), Math.max(...along)];
  const room_m = 0.02 * (to_m - from_m) || 1;
  [from_m, to_m] = [from_m - room_m, to_m + room_m];
  const heights = legs.flatMap((leg) => [leg.start.z_m, leg.end.z_m, ...(leg.kind === 'hop' ? [leg.start.z_m + leg.arc.apex_height_m] : [])]);
  if (!whole && selection.tried) heights.push(selection.selected.start.z_m + selection.tried.apex_height_m);
  for (const piece of pieces) {
    const leg = piece.leg === null || piece.leg === undefined ? null : mission.legs[piece.leg];
    piece.x_m.forEach((d, i) => {
      const sign = leg && leg.end.along_m < leg.start.along_m ? -1 : 1;
      const at_m = (leg?.start.along_m ?? 0) + sign * d;
      if (at_m >= from_m && at_m <= to_m) heights.push(piece.z_m[i]);
    });
  }
  let [low_m, high_m] = [Math.min(...heights), Math.max(...heights)];
  // What lies over the path, such as the roof of a cave, is cut by the frame.
  const tall_m = Math.max(high_m - low_m, 0.02 * (to_m - from_m), 1e-3);
  return { from_m, to_m, low_m: low_m - 0.08 * tall_m, high_m: high_m + 0.12 * tall_m };
}

/** Frame, ticks and numbers of a panel. */
function axes(root, { x, y, view, left, top, width, height, label, low, high }) {
  const along = ticks(view.from_m, view.to_m, width / 90);
  const up = ticks(low, high, height / 45);
  const [alongDecimals, upDecimals] = [tickDecimals(along), tickDecimals(up)];
  root.append(svg('rect', { class: 'frame', x: left, y: top, width, height }));
  for (const value of along) {
    root.append(
      svg('line', { class: 'tick', x1: x(value), x2: x(value), y1: top + height, y2: top + height + 4 }),
      svg('text', { class: 'number', x: x(value), y: top + height + 16, 'text-anchor': 'middle' }, fixed(value, alongDecimals)),
    );
  }
  for (const value of up) {
    root.append(
      svg('line', { class: 'grid', x1: left, x2: left + width, y1: y(value), y2: y(value) }),
      svg('text', { class: 'number', x: left - 6, y: y(value) + 4, 'text-anchor': 'end' }, fixed(value, upDecimals)),
    );
  }
  root.append(svg('text', { class: 'axis-name', x: 14, y: top + height / 2, transform: `rotate(-90 14 ${top + height / 2})`, 'text-anchor': 'middle' }, label));
}
