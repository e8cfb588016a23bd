// The grid of a trade as a look-up: the sliders stop at computed values alone. Nothing is interpolated, and no path is drawn for other values.

import { html } from './dom.js';
import { count, digits, keyInWords } from './words.js';

const valueOf = (scenario, key) => key.split('.').reduce((table, name) => table?.[name], scenario);

export function tradeSection(section, mission) {
  const { trade } = mission;
  const keys = trade.vary.slice(0, 2);
  const nearest = ({ key, values }) => {
    const planned = valueOf(mission.scenario, key);
    if (typeof planned !== 'number') return 0;
    return values.reduce((best, value, i) => (Math.abs(value - planned) < Math.abs(values[best] - planned) ? i : best), 0);
  };
  const at = keys.map(nearest);
  const rowAt = (indices) => trade.rows.find((row) => keys.every(({ key, values }, i) => row[key] === values[indices[i]]));
  const answer = html('p', { id: 'trade-answer', 'aria-live': 'polite' });
  section.append(html('p', { class: 'note' }, 'Fewest hops in every computed cell. The sliders look up these cells; they start at the cell nearest to this scenario. No other value was computed.'), ...(trade.warnings ?? []).map((text) => html('p', { class: 'note' }, `Warning: ${text}.`)));

  const named = (key) => {
    const { words, unit } = keyInWords(key.split('.')[1] ?? key);
    return `${words}${unit ? ` (${unit})` : ''}`;
  };
  keys.forEach(({ key, values }, i) => {
    const out = html('output', {}, digits(values[at[i]], 5));
    const input = html('input', {
      type: 'range',
      id: `trade-${i}`,
      min: '0',
      max: String(values.length - 1),
      step: '1',
      value: String(at[i]),
      oninput: (event) => {
        at[i] = Number(event.target.value);
        out.textContent = digits(values[at[i]], 5);
        event.target.setAttribute('aria-valuetext', out.textContent);
        tell();
      },
    });
    section.append(html('div', { class: 'controls no-print' }, html('label', {}, `${named(key)} `, input, ' ', out)));
  });

  const [first, second] = keys;
  const hops = trade.rows.map((row) => row.hops).filter((number) => typeof number === 'number');
  const [fewest, most] = [Math.min(...hops), Math.max(...hops)];
  const cell = (indices) => {
    const row = rowAt(indices);
    const node = html('td', { class: 'cell number', 'data-at': indices.join(' ') }, row?.error ? 'error' : (row?.hops ?? '–'));
    if (typeof row?.hops === 'number') node.style.setProperty('--share', String(most > fewest ? (row.hops - fewest) / (most - fewest) : 0));
    else node.classList.add('none');
    node.addEventListener('click', () => {
      indices.forEach((index, i) => {
        const input = document.getElementById(`trade-${i}`);
        input.value = String(index);
        input.dispatchEvent(new Event('input'));
      });
    });
    return node;
  };
  const ends = (value) => html('th', { scope: 'row', class: 'number' }, digits(value, 5));
  const body = second
    ? second.values.map((value, j) => html('tr', {}, ends(value), first.values.map((_, i) => cell([i, j])))).reverse()
    : [html('tr', {}, html('th', { scope: 'row' }, 'hops'), first.values.map((_, i) => cell([i])))];
  const head = html('tr', {}, html('td', {}, second ? named(second.key) : ''), first.values.map((value) => html('th', { scope: 'col', class: 'number' }, digits(value, 5))));
  section.append(
    html('div', { class: 'scroll' }, html('table', { class: 'grid', id: 'trade-grid' }, html('caption', {}, `Hops by ${named(first.key)} (across)${second ? ` and ${named(second.key)} (up)` : ''}; “–”: no path found over these nodes`), html('thead', {}, head), html('tbody', {}, body))),
    answer,
  );
  tell();

  function tell() {
    const row = rowAt(at);
    for (const node of section.querySelectorAll('.cell')) node.setAttribute('aria-selected', String(node.dataset.at === at.join(' ')));
    const where = keys.map(({ key, values }, i) => `${named(key)} ${digits(values[at[i]], 5)}`).join(', ');
    const sums = Object.entries(row?.totals ?? {}).map(([key, value]) => `${keyInWords(key).words} ${digits(value, 4)} ${keyInWords(key).unit}`);
    const found = row?.error ?? (typeof row?.hops === 'number' ? `at most ${count(row.hops, 'hop')} over these nodes` : `${(row?.verdict ?? 'not computed').replaceAll('-', ' ')}, over these nodes`);
    answer.textContent = `${where}: ${found}${sums.length > 0 ? `; ${sums.join(', ')}` : ''}.`;
  }
}
