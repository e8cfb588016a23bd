// The least margin of every hop in standard deviations of its errors.

import { drawnToWidth, html, svg } from './dom.js';
import { digits, fixed, marginInWords } from './words.js';

const MOST = 10;

export const hasSigmas = (mission) => mission.hops.some((leg) => Object.keys(leg.record.margins_sigma ?? {}).length > 0);

export function marginsFigure(section, mission, selection) {
  const frame = html('div', { class: 'figure' });
  section.append(
    html('p', { class: 'note' }, `The least margin of each hop in standard deviations of its errors; bars end at ${MOST} σ. Below 3 σ (dashed) a hop is likely to fail now and then.`),
    frame,
  );
  const again = drawnToWidth(frame, (width) => frame.replaceChildren(drawing(width)));
  selection.listen(again);

  function drawing(width) {
    const [left, right, row] = [70, 270, 18];
    const narrow = width < 560;
    const wide = width - left - (narrow ? 60 : right);
    const height = mission.hops.length * row + 30;
    const x = (sigma) => left + (Math.max(0, Math.min(MOST, sigma)) / MOST) * wide;
    const root = svg('svg', { viewBox: `0 0 ${width} ${height}`, role: 'img', 'aria-label': 'Least margin of every hop in standard deviations' });
    mission.hops.forEach((leg, i) => {
      const [key, sigma] = Object.entries(leg.record.margins_sigma ?? {}).reduce((a, b) => (b[1] < a[1] ? b : a), ['', Infinity]);
      const y = 6 + i * row;
      const group = svg('g', { class: `leg hop${leg.index === selection.leg ? ' selected' : ''}`, 'data-leg': leg.index, onclick: () => selection.select(leg.index) });
      group.append(svg('text', { class: 'number', x: left - 6, y: y + 12, 'text-anchor': 'end' }, leg.name));
      if (Number.isFinite(sigma)) {
        group.append(
          svg('rect', { class: 'sigma', x: left, y: y + 2, width: Math.max(1, x(sigma) - left), height: row - 5 }),
          svg('text', { class: 'number', x: x(sigma) + 5, y: y + 12 }, narrow ? `${digits(sigma, 3)} σ` : `${digits(sigma, 3)} σ to the ${marginInWords(key).words.toLowerCase()}`),
        );
      }
      root.append(group);
    });
    const bottom = height - 22;
    root.append(svg('line', { class: 'three', x1: x(3), x2: x(3), y1: 2, y2: bottom }), svg('line', { class: 'axis', x1: left, x2: left + wide, y1: bottom, y2: bottom }));
    for (let sigma = 0; sigma <= MOST; sigma += 1) root.append(svg('text', { class: 'number', x: x(sigma), y: bottom + 14, 'text-anchor': 'middle' }, fixed(sigma)));
    return root;
  }
}
