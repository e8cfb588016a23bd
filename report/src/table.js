// The table of legs: one row each, a column where any leg has a number for it.

import { html } from './dom.js';
import { bindingInWords, digits, fixed, percent } from './words.js';

const least = (margins) => {
  const values = Object.entries(margins ?? {}).filter(([key]) => key.endsWith('_sigma'));
  return values.length > 0 ? Math.min(...values.map(([, value]) => value)) : null;
};

const of = (key, count) => ({ record }) => (typeof record[key] === 'number' ? digits(record[key], count) : '');

const COLUMNS = [
  ['leg', (leg) => leg.name, 'text'],
  ['distance (m)', (leg) => digits(leg.kind === 'hop' ? leg.run_m : leg.record.length_m, 5)],
  ['rise (m)', (leg) => fixed(leg.end.z_m - leg.start.z_m, 2)],
  ['heading (°)', ({ record }) => (record.heading_deg === undefined ? '' : fixed(record.heading_deg, 1))],
  ['take-off angle (°)', ({ record }) => (record.takeoff_angle_deg === undefined ? '' : fixed(record.takeoff_angle_deg, 2))],
  ['feasible (°)', ({ window_deg: window }) => (window ? `${fixed(window[0], 2)} to ${fixed(window[1], 2)}` : '')],
  ['take-off speed (m/s)', of('takeoff_speed_m_s', 5)],
  ['landing speed (m/s)', of('landing_speed_m_s', 5)],
  ['flight time (s)', of('flight_time_s', 4)],
  ['time (s)', of('time_s', 4)],
  ['energy (J/kg)', of('energy_j_kg', 4)],
  ['bound by (lower; upper angle)', ({ record }) => (record.binding ? bindingInWords(record.binding) : ''), 'text'],
  ['least margin (σ)', ({ record }) => (least(record.margins_sigma) === null ? '' : fixed(least(record.margins_sigma), 2))],
  ['survives alone', ({ record }) => (record.success_estimated === undefined ? '' : percent(record.success_estimated, 2))],
  ['target', ({ record }) => (record.visit === undefined ? '' : record.target === null ? 'start' : String(record.target))],
];

export function legsTable(section, mission, selection) {
  const columns = COLUMNS.filter(([, text]) => mission.legs.some((leg) => text(leg) !== ''));
  const rows = mission.legs.map((leg) =>
    html(
      'tr',
      { 'data-leg': leg.index, tabindex: '-1', onclick: () => selection.select(leg.index) },
      columns.map(([, text, kind], i) => html(i === 0 ? 'th' : 'td', { scope: i === 0 ? 'row' : null, class: kind === 'text' ? null : 'number' }, text(leg))),
    ),
  );
  const body = html('tbody', {}, rows);
  body.addEventListener('keydown', (event) => {
    const by = { ArrowUp: -1, ArrowDown: 1 }[event.key];
    if (by === undefined) return;
    event.preventDefault();
    selection.step(by);
    rows[selection.leg].focus();
  });
  const head = html('thead', {}, html('tr', {}, columns.map(([name, , kind]) => html('th', { scope: 'col', class: kind === 'text' ? null : 'number' }, name))));
  section.append(html('div', { class: 'scroll' }, html('table', { id: 'legs-table', class: 'legs' }, head, body)));
  const mark = () => {
    rows.forEach((row, i) => {
      const selected = i === selection.leg;
      row.setAttribute('aria-selected', String(selected));
      row.tabIndex = selected ? 0 : -1;
    });
  };
  selection.listen(mark);
  mark();
}
