// The selected leg: its command, the slider that moves the take-off angle inside the feasible window, and its margins.

import { html } from './dom.js';
import { bindingInWords, digits, fixed, marginInWords } from './words.js';

/** Keys of machines whose commands come in steps: a slider would offer what they cannot fly. */
const STEPS = ['takeoff_speed_levels_m_s', 'takeoff_speed_step_m_s', 'takeoff_angle_step_deg'];

export function hopPanel(section, mission, selection) {
  const body = html('div', { id: 'hop' });
  const title = html('h3', { id: 'hop-name', 'aria-live': 'polite' });
  const move = (by, text) => html('button', { type: 'button', class: 'no-print', onclick: () => selection.step(by) }, text);
  section.append(html('div', { class: 'controls' }, move(-1, '← previous'), title, move(1, 'next →')), body);
  const inSteps = STEPS.some((key) => mission.scenario.hopper?.[key] !== undefined);
  let live = null;
  selection.listen(({ leg }) => (leg ? build() : live?.()));
  build();

  function build() {
    const leg = selection.selected;
    title.textContent = leg.name;
    live = null;
    body.replaceChildren(...(leg.kind === 'hop' ? hop(leg) : drive(leg)));
    live?.();
  }

  function hop(leg) {
    const { record } = leg;
    const parts = [];
    const [least, greatest] = leg.window_deg;
    if (inSteps) {
      parts.push(html('p', { class: 'note' }, 'This machine takes its commands in steps: other angles inside the window are not all commands, so that there is no slider.'));
    } else if (greatest > least) {
      parts.push(slider(leg, least, greatest));
    } else {
      parts.push(html('p', { class: 'note' }, `One take-off angle alone is feasible: ${fixed(least, 4)}°.`));
    }
    const bound = html('p', {}, html('strong', {}, 'Bound by: '), `${bindingInWords(record.binding)} (the limits that set the least and the greatest feasible angle).`);
    return [html('div', {}, parts, bound), margins(record)];
  }

  function slider(leg, least, greatest) {
    const { record } = leg;
    const input = html('input', {
      type: 'range',
      id: 'angle',
      min: String(least),
      max: String(greatest),
      step: 'any',
      value: String(record.takeoff_angle_deg),
      'aria-describedby': 'angle-note',
      oninput: (event) => selection.tryAngle(Number(event.target.value)),
    });
    input.addEventListener('keydown', (event) => {
      // Steps of a fiftieth of the window: browsers step a range without steps by one degree, past a narrow window at once.
      const by = { ArrowLeft: -1, ArrowDown: -1, ArrowRight: 1, ArrowUp: 1 }[event.key];
      if (by === undefined) return;
      event.preventDefault();
      selection.tryAngle((selection.angle_deg ?? record.takeoff_angle_deg) + (by * (greatest - least)) / 50);
    });
    const planned = leg.arc;
    const margin = (key) => record.margins?.[key];
    const limit = (key) => (margin(key) === undefined ? null : record[key] + margin(key));
    const cells = (name, unit, value, stated, most) => {
      const now = html('td', { class: 'number', id: `tried-${name.replaceAll(' ', '-')}` });
      const row = html('tr', {}, html('th', { scope: 'row' }, `${name} (${unit})`), html('td', { class: 'number' }, digits(stated, 6)), now, html('td', { class: 'number' }, most === null ? '' : digits(most, 6)));
      return { row, tell: (arc) => (now.textContent = arc ? digits(value(arc), 6) : '–') };
    };
    const rows = [
      cells('take-off angle', '°', (arc) => arc.takeoff_angle_deg, record.takeoff_angle_deg, null),
      cells('take-off speed', 'm/s', (arc) => arc.takeoff_speed_m_s, record.takeoff_speed_m_s, limit('takeoff_speed_m_s')),
      cells('landing speed', 'm/s', (arc) => arc.landing_speed_m_s, record.landing_speed_m_s, limit('landing_speed_m_s')),
      cells('landing angle', '°', (arc) => arc.landing_angle_deg, record.landing_angle_deg, null),
      cells('flight time', 's', (arc) => arc.flight_time_s, record.flight_time_s, margin('flight_time_s') === undefined ? null : record.flight_time_s + margin('flight_time_s')),
      cells('apex over take-off', 'm', (arc) => arc.apex_height_m, record.apex_z_m - record.takeoff_z_m, margin('apex_height_m') === undefined ? null : planned.apex_height_m + margin('apex_height_m')),
    ];
    live = () => {
      const arc = selection.tried;
      input.value = String(selection.angle_deg ?? record.takeoff_angle_deg);
      input.setAttribute('aria-valuetext', `${fixed(Number(input.value), 2)} degrees`);
      for (const { tell } of rows) tell(arc);
    };
    return html(
      'div',
      { class: 'slider' },
      html('div', { class: 'no-print' }, html('label', { for: 'angle' }, `Take-off angle, ${fixed(least, 2)} to ${fixed(greatest, 2)}° feasible `), input, html('button', { type: 'button', onclick: () => selection.tryAngle(null) }, 'as planned')),
      html('table', {}, html('thead', {}, html('tr', {}, html('td', {}), ...['planned', 'tried', 'limit'].map((name) => html('th', { scope: 'col', class: 'number' }, name)))), html('tbody', {}, rows.map(({ row }) => row))),
      html('p', { class: 'note', id: 'angle-note' }, 'Every angle in the window joins the same two contacts within all limits of this hop, flown exactly; the speed follows from the angle. The other hops stay as planned, and success was estimated for the planned angle alone.'),
    );
  }

  function drive({ record }) {
    const facts = ['length_m', 'climb_m', 'descent_m', 'steepest_deg', 'time_s', 'turn_time_s', 'energy_j_kg'].filter((key) => typeof record[key] === 'number');
    const row = (key, value) => {
      const { words, unit } = marginInWords(key);
      return html('tr', {}, html('th', { scope: 'row' }, `${words} (${unit})`), html('td', { class: 'number' }, digits(value, 5)));
    };
    return [html('table', {}, html('tbody', {}, facts.map((key) => row(key, record[key])))), margins(record)];
  }
}

/** The margins of a leg in their units, and in standard deviations where the answer has them. */
function margins(record) {
  const sigmas = record.margins_sigma ?? {};
  const inSigma = (key) => sigmas[key.replace(/_(m_s|deg|m|s)$/, '_sigma')];
  const hasSigmas = Object.keys(sigmas).length > 0;
  const rows = Object.entries(record.margins ?? {})
    .filter(([key]) => key !== 'terrain_from_takeoff_m')
    .map(([key, value]) => {
      const { words, unit } = marginInWords(key);
      const at = key === 'terrain_m' && record.margins.terrain_from_takeoff_m !== undefined ? `, ${fixed(record.margins.terrain_from_takeoff_m, 2)} m from the take-off` : '';
      const sigma = inSigma(key);
      return html('tr', {}, html('th', { scope: 'row' }, `${words}${at}`), html('td', { class: 'number' }, `${digits(value, 4)} ${unit}`), hasSigmas && html('td', { class: 'number' }, sigma === undefined ? '' : `${digits(sigma, 3)} σ`));
    });
  const head = html('tr', {}, html('th', { scope: 'col' }, 'margin to'), html('th', { scope: 'col', class: 'number' }, 'left'), hasSigmas && html('th', { scope: 'col', class: 'number' }, 'in σ of the errors'));
  return html('table', { class: 'margins' }, html('thead', {}, head), html('tbody', {}, rows));
}
