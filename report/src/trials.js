// Trials: the success rate with its interval, how trials ended, how it converged, where landings fell; and what each error costs.

import { drawnToWidth, html, path, svg, ticks } from './dom.js';
import { bar } from './verdict.js';
import { count, digits, fixed, keyInWords, outcomeInWords, percent } from './words.js';

const interval = ([low, high], decimals = 2) => `${percent(low, decimals)} to ${percent(high, decimals)}`;

export function trialsSection(section, mission) {
  const { trials } = mission;
  const drawn = `seed ${trials.seed}${trials.policy ? `, policy ${trials.policy}` : ''}`;
  section.append(
    html('p', { id: 'success' }, html('strong', {}, percent(trials.success_rate, 2)), ` of ${count(trials.trials, 'trial')} reached the goal (95 % interval ${interval(trials.ci95)}; ${drawn}).`),
  );
  const most = Math.max(1, ...trials.outcomes.map(([, number]) => number));
  const shown = trials.outcomes.filter(([, number]) => number > 0);
  const row = ([name, number]) => html('tr', {}, html('th', { scope: 'row' }, outcomeInWords(name)), html('td', {}, bar(number / most, name === 'reached' ? '' : 'bad')), html('td', { class: 'number' }, String(number)));
  section.append(html('table', { class: 'bars' }, html('caption', {}, 'How trials ended'), html('tbody', {}, shown.map(row))));
  if (trials.failures?.length > 0) {
    const where = trials.failures.map(({ outcome, hop, count: number }) => `${number} ${outcomeInWords(outcome)} in hop ${hop}`);
    section.append(html('p', {}, `Where they failed: ${where.join('; ')}.`));
  }
  if (trials.convergence?.length > 1) section.append(convergence(trials.convergence));
  if (trials.landings?.length > 0) section.append(landings(trials.landings));
  const others = Object.entries(trials).filter(([key, value]) => typeof value === 'number' && /_(mean|median|p95)_/.test(key));
  if (others.length > 0) section.append(html('p', {}, others.map(([key, value]) => `${keyInWords(key).words}: ${digits(value, 4)} ${keyInWords(key).unit}`).join('; '), '.'));
}

function convergence(rows) {
  const frame = html('div', { class: 'figure half' });
  drawnToWidth(frame, (width) => {
    const [left, top, right, bottom, height] = [52, 8, 12, 34, 190];
    const [w, h] = [width - left - right, height - top - bottom];
    const low = Math.min(...rows.map((row) => row.success_rate_ci95[0]));
    const x = (trials) => left + (Math.log(trials / rows[0].trials) / Math.log(rows[rows.length - 1].trials / rows[0].trials)) * w;
    const y = (rate) => top + ((1 - rate) / (1 - low || 1)) * h;
    const root = svg('svg', { viewBox: `0 0 ${width} ${height}`, role: 'img', 'aria-label': 'Success rate over the number of trials, with its 95 % interval' });
    const band = [...rows.map((row) => [x(row.trials), y(row.success_rate_ci95[1])]), ...rows.map((row) => [x(row.trials), y(row.success_rate_ci95[0])]).reverse()];
    root.append(svg('path', { class: 'band', d: `${path(band)}Z` }), svg('path', { class: 'rate', d: path(rows.map((row) => [x(row.trials), y(row.success_rate)])) }));
    for (const rate of ticks(low, 1, 4)) root.append(svg('text', { class: 'number', x: left - 6, y: y(rate) + 4, 'text-anchor': 'end' }, percent(rate, 1)));
    for (const { trials } of rows) root.append(svg('text', { class: 'number', x: x(trials), y: top + h + 15, 'text-anchor': 'middle' }, String(trials)));
    root.append(svg('rect', { class: 'frame', x: left, y: top, width: w, height: h }), svg('text', { class: 'axis-name', x: left + w / 2, y: height - 4, 'text-anchor': 'middle' }, 'trials; success with its 95 % interval'));
    frame.replaceChildren(root);
  });
  return frame;
}

function landings(rows) {
  const columns = [['q50_m', 'median'], ['q95_m', '95 %'], ['max_m', 'greatest']];
  const head = html('tr', {}, html('th', { scope: 'col' }, 'hop'), html('th', { scope: 'col', class: 'number' }, 'landings'), columns.map(([, name]) => html('th', { scope: 'col', class: 'number' }, name)));
  const row = (landing) => html('tr', {}, html('th', { scope: 'row' }, String(landing.hop)), html('td', { class: 'number' }, String(landing.count)), columns.map(([key]) => html('td', { class: 'number' }, digits(landing[key], 3))));
  return html('div', { class: 'scroll' }, html('table', {}, html('caption', {}, 'Distance of landings from where they were aimed (m)'), html('thead', {}, head), html('tbody', {}, rows.map(row))));
}

/** What each error costs: the success that is gained where it alone is absent. */
export function sensitivitySection(section, { sensitivity }) {
  section.append(
    html('p', { class: 'note' }, `${count(sensitivity.trials, 'trial')} with all errors: ${percent(sensitivity.success_rate, 2)} (${interval(sensitivity.success_rate_ci95)}). The same draws without one error at a time; a cost whose interval holds 0 is not told apart from none.`),
  );
  const errors = [...sensitivity.errors].sort((a, b) => b.cost - a.cost);
  const most = Math.max(1e-9, ...errors.map((error) => Math.abs(error.cost)));
  const head = html('tr', {}, ['error', 'σ', 'cost in success', '', '95 % interval', 'success without it'].map((name, i) => html('th', { scope: 'col', class: i > 0 && i !== 3 ? 'number' : null }, name)));
  const row = (error) => {
    const { words, unit } = keyInWords(error.error);
    return html(
      'tr',
      {},
      html('th', { scope: 'row' }, words.replace(/ sigma( fraction)?$/, '')),
      html('td', { class: 'number' }, `${digits(error.sigma, 3)} ${unit === 'σ' ? '' : unit}`),
      html('td', { class: 'number' }, percent(error.cost, 2)),
      html('td', {}, bar(Math.abs(error.cost) / most, error.cost < 0 ? 'good' : 'bad')),
      html('td', { class: 'number' }, interval(error.cost_ci95)),
      html('td', { class: 'number' }, percent(error.success_rate_without, 2)),
    );
  };
  section.append(html('div', { class: 'scroll' }, html('table', { id: 'sensitivity-table', class: 'bars' }, html('thead', {}, head), html('tbody', {}, errors.map(row)))));
}

/** What else would do: the alternatives of a mission that drives. */
export function alternativesSection(section, { value }) {
  const columns = ['hops', 'mission_time_s', 'energy_j_kg', 'distance_m'];
  const head = html('tr', {}, html('th', { scope: 'col' }, 'it may'), html('th', { scope: 'col' }, 'best by'), columns.map((key) => html('th', { scope: 'col', class: 'number' }, `${keyInWords(key).words}${keyInWords(key).unit ? ` (${keyInWords(key).unit})` : ''}`)));
  const may = { drive: 'drive', hop: 'hop', both: 'drive and hop' };
  const row = ({ travel, objective, verdict, totals }) =>
    html('tr', {}, html('th', { scope: 'row' }, may[travel] ?? travel), html('td', {}, objective.join(', then ')), totals ? columns.map((key) => html('td', { class: 'number' }, digits(totals[key], 5))) : html('td', { colspan: columns.length }, verdict.replaceAll('-', ' ')));
  section.append(html('div', { class: 'scroll' }, html('table', {}, html('thead', {}, head), html('tbody', {}, value.alternatives.map(row)))), html('p', { class: 'note' }, `Over the same nodes, ${fixed(value.search?.node_spacing_m)} m apart.`));
}
