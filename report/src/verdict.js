// The verdict in words with its bounds, what stops the path where there is none, the totals, and the warnings.

import { html } from './dom.js';
import { count, digits, fixed, keyInWords, limitInWords, percent } from './words.js';

/** What is known of the number of hops: never more than the answer says. */
export function verdictWords(mission) {
  const { value, nodesWord } = mission;
  const bound = value.lower_bound ?? value.hops_lower_bound;
  const least = bound > 0 ? `no path takes fewer than ${count(bound, 'hop')}` : null;
  const over = value.lower_bound !== undefined && value.proved ? 'proved at any resolution' : `over these ${nodesWord}`;
  if (value.verdict === 'untraversable') return { short: 'Untraversable', long: 'It is proved that there is no path, at any resolution.' };
  if (value.hops === null || value.hops === undefined || value.verdict === 'no-path-found') {
    const found = value.targets ? `${value.targets_visited} of ${value.targets.length} targets are reached` : 'The goal is not reached';
    return { short: 'No path found', long: `${found} over these ${nodesWord}; other ${nodesWord} may give a path${least ? `, but ${least}` : ''}.` };
  }
  if (value.schema.includes('travel')) {
    const drives = mission.legs.length - mission.hops.length;
    const legs = [drives && count(drives, 'drive'), mission.hops.length && count(mission.hops.length, 'hop')].filter(Boolean).join(' and ');
    return { short: 'Traversable', long: `${legs || 'Nothing to do'}: the best mission over these nodes for ${(value.objective ?? []).join(', then ')}; other nodes may give a better one.` };
  }
  const hops = value.hops === bound ? `Exactly ${count(value.hops, 'hop')}: no path takes fewer` : `At most ${count(value.hops, 'hop')} ${over}; ${least ?? 'no lower bound is known'}`;
  const targets = value.targets ? `${value.targets_visited} of ${value.targets.length} targets visited${value.return_to_start ? ' and back to the start' : ''}. ` : '';
  return { short: 'Traversable', long: `${targets}${hops}.` };
}

export function header(mission) {
  const { short, long } = verdictWords(mission);
  const yes = short === 'Traversable';
  const head = document.querySelector('header');
  head.append(
    html('h1', {}, mission.title),
    html('p', { id: 'verdict', class: yes ? 'yes' : 'no' }, html('strong', {}, `${yes ? '✓' : '✗'} ${short}. `), long),
  );
  if (mission.value.verified) head.append(html('p', { class: 'note' }, 'Every hop was flown again by an independent simulation and breaks no limit.'));
  const facts = totals(mission);
  if (facts.length > 0) head.append(html('dl', { class: 'facts' }, facts.map(([term, text]) => html('div', {}, html('dt', {}, term), html('dd', {}, text)))));
  head.append(...noPath(mission));
  // Those of a trade stand beside it: it answers another question.
  const warnings = [...new Set(mission.answers.filter((answer) => answer.value !== mission.trade).flatMap((answer) => answer.value.warnings ?? []))];
  if (warnings.length > 0) {
    head.append(html('details', { class: 'warnings', open: true }, html('summary', {}, count(warnings.length, 'warning')), html('ul', {}, warnings.map((text) => html('li', {}, text)))));
  }
}

const TOTALS = ['mission_time_s', 'flight_time_s', 'drive_time_s', 'ground_distance_m', 'distance_m', 'drive_length_m', 'energy_j_kg', 'energy_j', 'delta_v_m_s', 'propellant_kg', 'peak_takeoff_speed_m_s'];

function totals({ value, trials }) {
  const sums = value.totals ?? {};
  const facts = TOTALS.filter((key) => typeof sums[key] === 'number').map((key) => {
    const { words, unit } = keyInWords(key);
    return [words, `${digits(sums[key], 5)} ${unit}`];
  });
  if (typeof sums.success_estimated === 'number') facts.push(['estimated success', percent(sums.success_estimated, 2)]);
  if (trials) facts.push(['success in trials', `${percent(trials.success_rate, 2)} of ${trials.trials}`]);
  return facts;
}

/** Why there is no path: how far one gets, and which limits refuse the hops on. */
function noPath({ value, legs }) {
  if (legs.length > 0 || value.verdict === 'traversable') return [];
  const found = [];
  const { frontier, gap, refusals, endpoint_refusals: ends } = value;
  const ranked = (counts) => Object.entries(counts ?? {}).sort((a, b) => b[1] - a[1]);
  if (frontier) {
    const reached = `From the start, ${count(frontier.reached_nodes, 'node')} are reached, up to x = ${fixed(frontier.reached_x_m)} m; the goal is reached from ${count(frontier.leads_to_goal_nodes, 'node')}, from x = ${fixed(frontier.leads_to_goal_from_x_m)} m on.`;
    found.push(html('p', {}, reached));
  } else if (gap) {
    const facts = Object.entries(gap).filter(([, part]) => typeof part === 'number');
    found.push(html('p', {}, `How far it gets: ${facts.map(([key, part]) => `${keyInWords(key).words} ${fixed(part)} ${keyInWords(key).unit}`).join('; ')}.`));
  }
  const rows = ranked(frontier?.refusals ?? gap?.refusals ?? refusals);
  if (rows.length > 0) {
    const most = rows[0][1];
    found.push(
      html('h2', {}, 'What refuses the hops that would go on'),
      html(
        'table',
        { class: 'bars' },
        html('tbody', {}, rows.map(([limit, number]) => html('tr', {}, html('th', { scope: 'row' }, limitInWords(limit)), html('td', {}, bar(number / most)), html('td', { class: 'number' }, String(number))))),
      ),
    );
  }
  for (const end of ends ?? []) found.push(html('p', {}, `The ${end.which ?? 'end'} refuses contact: ${limitInWords(end.limit ?? end.refusal ?? '')}.`));
  return found;
}

/** A bar of a share of its cell. */
export function bar(share, name = '') {
  const inner = html('span', { class: `bar ${name}` });
  inner.style.width = `${100 * Math.max(0, Math.min(1, share))}%`;
  return html('span', { class: 'bar-room' }, inner);
}
