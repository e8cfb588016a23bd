// Where the numbers come from: documents, input files with checksums, version, and the commands that repeat them.

import { html } from './dom.js';

const commandOf = (name, { schema, vary, experiment }) => {
  const kind = schema.split('/')[1];
  if (kind.startsWith('run') || (name === 'result.json' && !kind.includes('legs'))) return `chta run ${name} -o again`;
  if (kind === 'trade') {
    const by = vary.map(({ key, values }) => `--vary ${key}=${values[0]}:${values[values.length - 1]}:${values.length}`);
    return `chta trade result.json ${by.join(' ')} --format json`;
  }
  const what = experiment ? ` --experiment ${experiment}` : '';
  return `chta ${kind.split('-')[0]} ${name}${what} --format json`;
};

export function provenanceSection(section, mission) {
  const { answers, value } = mission;
  const save = ({ name, text }) => {
    const url = URL.createObjectURL(new Blob([text], { type: 'application/json' }));
    html('a', { href: url, download: name }).click();
    URL.revokeObjectURL(url);
  };
  const documents = answers.map((answer) =>
    html(
      'tr',
      {},
      html('th', { scope: 'row' }, answer.name),
      html('td', {}, answer.value.schema),
      html('td', {}, answer.value.chta_version),
      html('td', {}, html('code', {}, commandOf(answer.name, answer.value))),
      html('td', { class: 'no-print' }, html('button', { type: 'button', onclick: () => save(answer) }, 'Save')),
    ),
  );
  const names = ['document', 'kind', 'chta', 'repeat it with'];
  section.append(
    html('p', {}, 'All numbers of this page come from these documents, which it holds unchanged. Saved beside their inputs, they repeat the answer:'),
    html('div', { class: 'scroll' }, html('table', {}, html('thead', {}, html('tr', {}, names.map((name) => html('th', { scope: 'col' }, name)), html('td', { class: 'no-print' }))), html('tbody', {}, documents))),
    html('p', {}, html('code', {}, `chta report ${answers.map(({ name }) => name).join(' ')} -o page.html`), ' makes this page again.'),
    html('div', { class: 'scroll' }, html('table', {}, html('caption', {}, 'Input files'), html('thead', {}, html('tr', {}, html('th', { scope: 'col' }, 'file, from the folder of the run'), html('th', { scope: 'col' }, 'SHA-256'))), html('tbody', {}, value.inputs.map(({ name, sha256 }) => html('tr', {}, html('th', { scope: 'row' }, name), html('td', {}, html('code', {}, sha256))))))),
  );
  if (value.crs) section.append(html('p', {}, `Reference system: ${value.crs.name}${value.crs.code ? ` (${value.crs.code})` : ''}; `, html('code', {}, value.crs.proj)));
  section.append(html('details', {}, html('summary', {}, 'The scenario as used'), scenarioTable(value.scenario)));
  const worst = Math.max(0, ...mission.hops.map((leg) => leg.speed_error));
  if (mission.hops.length > 0) {
    section.append(
      html('p', { class: 'note', id: 'self-check', 'data-worst': String(worst) }, worst < 1e-9
        ? 'The arcs of this page start with the stated speeds of all hops, to nine digits.'
        : `Attention: the arcs of this page differ from the stated take-off speeds by up to ${(100 * worst).toPrecision(2)} %.`),
    );
  }
}

function scenarioTable(scenario) {
  const rows = Object.entries(scenario).flatMap(([table, keys]) =>
    Object.entries(keys).map(([key, value]) => html('tr', {}, html('th', { scope: 'row' }, `${table}.${key}`), html('td', {}, typeof value === 'object' ? JSON.stringify(value) : String(value)))),
  );
  return html('table', { class: 'scenario' }, html('tbody', {}, rows));
}
