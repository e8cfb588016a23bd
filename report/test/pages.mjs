// Opens pages of answers in Chromium and drives them: `node report/test/pages.mjs CHROMIUM FOLDER...`. A folder holds page.html, and beside it
// the documents that it was made of, under the names under which the page saves them. Ends with status 1 where anything is not as it should be.

import assert from 'node:assert/strict';
import { existsSync, readFileSync, writeFileSync } from 'node:fs';
import { basename, join, resolve } from 'node:path';
import { pathToFileURL } from 'node:url';
import { Chromium } from './chromium.mjs';

const [program, ...folders] = process.argv.slice(2);
assert.ok(program && folders.length > 0, 'usage: node report/test/pages.mjs CHROMIUM FOLDER...');

/** Take-off speed by the equation as it is printed, not by the page's own. */
function speedOf({ record, angle_deg, gravity_m_s2 }) {
  const angle = (angle_deg * Math.PI) / 180;
  const onMap = record.takeoff_map_x_m === undefined ? [] : [Math.hypot(record.landing_map_x_m - record.takeoff_map_x_m, record.landing_map_y_m - record.takeoff_map_y_m)];
  const speeds = [Math.abs(record.landing_x_m - record.takeoff_x_m), ...onMap].map((run_m) => {
    const rise_m = record.landing_z_m - record.takeoff_z_m;
    return Math.sqrt((gravity_m_s2 * run_m ** 2) / (2 * Math.cos(angle) ** 2 * (run_m * Math.tan(angle) - rise_m)));
  });
  return speeds;
}

const isNear = (a, b, tolerance) => Math.abs(a - b) <= tolerance * Math.max(1e-9, Math.abs(b));

async function documentsAreThose(tab, folder) {
  const held = await tab.value(`[...document.querySelectorAll('script.answer')].map((node) => [node.dataset.name, node.textContent])`);
  for (const [name, text] of held) {
    const file = readFileSync(join(folder, name), 'utf8');
    assert.deepEqual(JSON.parse(text), JSON.parse(file), `${name} in the page is not the document`);
    assert.equal(text.trim().replaceAll('\\u003c', '<'), file.trim().replaceAll('\\u003c', '<'), `${name} has other bytes`);
  }
  return Object.fromEntries(held.map(([name, text]) => [name, JSON.parse(text)]));
}

/** Selects legs in every view, and looks at all others. */
async function selectionIsEverywhere(tab, path, hasMap) {
  const chosen = [path.length - 1, Math.floor(path.length / 2), 0];
  const views = ['#profile', '#legs', ...(hasMap ? ['#plan'] : [])];
  const selected = async () => {
    const found = await tab.value(`JSON.stringify(${JSON.stringify(views)}.map((view) => [...new Set([...document.querySelectorAll(view + ' .selected[data-leg], ' + view + ' [aria-selected=true][data-leg]')].map((node) => node.dataset.leg))]))`);
    return JSON.parse(found);
  };
  for (const view of views) {
    for (const leg of chosen) {
      const event = `new MouseEvent('click', { bubbles: true })`;
      await tab.value(`document.querySelector('${view} [data-leg="${leg}"]').dispatchEvent(${event}), true`);
      await tab.settled();
      assert.deepEqual(await selected(), views.map(() => [String(leg)]), `a click on leg ${leg} in ${view}`);
      const name = path[leg].kind === 'drive' ? `Drive (leg ${path[leg].leg})` : `Hop ${path[leg].hop}`;
      assert.equal(await tab.value(`document.getElementById('hop-name').textContent`), name);
    }
  }
  if (path.length < 2) return;
  await tab.value(`document.querySelector('#profile .figure').focus(), true`);
  await tab.key('ArrowRight');
  assert.deepEqual((await selected())[0], ['1'], 'the right arrow selects the next leg');
  await tab.key('ArrowLeft');
  assert.deepEqual((await selected())[0], ['0']);
}

/** Moves the slider of a hop over its window: the speeds are those of the equation, and within the limits that the answer states. */
async function sliderMoves(tab, path, gravity_m_s2) {
  let moved = 0;
  for (const [leg, record] of path.entries()) {
    if (record.kind === 'drive' || moved >= 4) continue;
    await tab.value(`document.querySelector('#legs [data-leg="${leg}"]').click(), true`);
    if (!(await tab.value(`Boolean(document.getElementById('angle'))`))) continue;
    moved += 1;
    const [least, greatest] = [record.takeoff_angle_min_deg, record.takeoff_angle_max_deg];
    for (const angle_deg of [least, (least + greatest) / 2, greatest]) {
      const [speed, landing, arcs] = await tab.value(`(() => {
        const input = document.getElementById('angle');
        input.value = ${angle_deg};
        input.dispatchEvent(new Event('input'));
        const number = (id) => Number(document.getElementById(id).textContent.replace('−', '-'));
        return [number('tried-take-off-speed'), number('tried-landing-speed'), document.querySelectorAll('.arc.tried').length];
      })()`);
      assert.ok(speedOf({ record, angle_deg, gravity_m_s2 }).some((expected) => isNear(speed, expected, 2e-5)), `hop ${record.hop} at ${angle_deg}°: ${speed} m/s`);
      assert.ok(speed <= (record.takeoff_speed_m_s + (record.margins.takeoff_speed_m_s ?? Infinity)) * (1 + 1e-4), `hop ${record.hop} at ${angle_deg}° takes off with ${speed} m/s`);
      assert.ok(landing <= (record.landing_speed_m_s + (record.margins.landing_speed_m_s ?? Infinity)) * (1 + 1e-4), `hop ${record.hop} at ${angle_deg}° lands with ${landing} m/s`);
      assert.ok(arcs >= 1, 'the tried arc is drawn');
    }
    await tab.value(`document.getElementById('angle').focus(), true`);
    const before = await tab.value(`document.getElementById('tried-take-off-angle').textContent`);
    await tab.key('ArrowLeft');
    assert.notEqual(await tab.value(`document.getElementById('tried-take-off-angle').textContent`), before, 'the left arrow moves the slider');
  }
  return moved;
}

async function gridIsLookedUp(tab, trade) {
  for (const at of [0, trade.vary[0].values.length - 1]) {
    const text = await tab.value(`(() => {
      const input = document.getElementById('trade-0');
      input.value = '${at}';
      input.dispatchEvent(new Event('input'));
      return document.getElementById('trade-answer').textContent + '|' + [...document.querySelectorAll('.cell[aria-selected=true]')].map((cell) => cell.textContent).join();
    })()`);
    const [answer, cell] = text.split('|');
    const row = trade.rows.find((candidate) => trade.vary.every(({ key, values }, i) => i > 0 || candidate[key] === values[at]) && String(candidate.hops ?? '–') === cell);
    assert.ok(row, `no computed cell has ${cell} hops at ${trade.vary[0].values[at]}`);
    assert.ok(row.hops === null || answer.includes(`at most ${row.hops} hop`), answer);
  }
}

/** A layer that refuses contact somewhere has a box and its share of the posts in the legend; without its mark it is off the map. */
async function layersAreShown(tab, layers) {
  const picture = () => tab.value(`document.querySelector('#plan .under canvas').toDataURL()`);
  const legend = () => tab.value(`document.querySelector('#plan .legend').textContent`);
  const boxes = await tab.value(`[...document.querySelectorAll('#plan .controls label')].map((label) => label.textContent.trim())`);
  const whole = await picture();
  // In base64, zeros are As.
  for (const { name, bits } of layers) {
    const marks = /[^A=]/.test(bits);
    assert.equal(boxes.includes(name), marks, `${name}: a box`);
    assert.equal((await legend()).includes(`${name}: `), marks, `${name}: the legend`);
    if (!marks) continue;
    const press = `[...document.querySelectorAll('#plan .controls label')].find((label) => label.textContent.trim() === ${JSON.stringify(name)}).querySelector('input').click(), true`;
    await tab.value(press);
    assert.ok(!(await legend()).includes(`${name}: `), `${name}: still in the legend`);
    assert.notEqual(await picture(), whole, `${name}: still on the map`);
    await tab.value(press);
    assert.equal(await picture(), whole, `${name}: not as before`);
  }
  return layers.length;
}

/** The view in three dimensions changes with the exaggeration and the keys. */
async function spaceTurns(tab) {
  const picture = () => tab.value(`document.querySelector('#space canvas').toDataURL()`);
  const first = await picture();
  await tab.value(`(() => { const input = document.getElementById('exaggeration'); input.value = '3'; input.dispatchEvent(new Event('input')); return true; })()`);
  const higher = await picture();
  assert.notEqual(higher, first, 'the exaggeration changes nothing');
  await tab.value(`document.querySelector('#space canvas').focus(), true`);
  await tab.key('ArrowLeft');
  assert.notEqual(await picture(), higher, 'the left arrow does not turn the view');
}

/** Texts whose contrast to their background is less than 4.5 to 1 (WCAG 2, level AA). */
const WEAK = `(() => {
  const canvas = Object.assign(document.createElement('canvas'), { width: 1, height: 1 }).getContext('2d', { willReadFrequently: true });
  const rgba = (colour) => { canvas.clearRect(0, 0, 1, 1); canvas.fillStyle = colour; canvas.fillRect(0, 0, 1, 1); return [...canvas.getImageData(0, 0, 1, 1).data]; };
  const light = (rgb) => { const [r, g, b] = rgb.map((part) => { const c = part / 255; return c <= 0.03928 ? c / 12.92 : ((c + 0.055) / 1.055) ** 2.4; }); return 0.2126 * r + 0.7152 * g + 0.0722 * b; };
  const weak = new Set();
  for (const node of document.querySelectorAll('body *')) {
    const text = [...node.childNodes].some((child) => child.nodeType === 3 && child.data.trim());
    if (!text || node instanceof SVGElement || node.closest('script, style, option') || !node.checkVisibility()) continue;
    let under = node;
    while (under && rgba(getComputedStyle(under).backgroundColor)[3] < 255) under = under.parentElement;
    const [a, b] = [rgba(getComputedStyle(node).color), under ? rgba(getComputedStyle(under).backgroundColor) : [255, 255, 255]].map((colour) => light(colour.slice(0, 3)));
    const ratio = (Math.max(a, b) + 0.05) / (Math.min(a, b) + 0.05);
    if (ratio < 4.5) weak.add(node.tagName + '.' + node.className + ' ' + node.textContent.slice(0, 30) + ' ' + ratio.toFixed(2));
  }
  return [...weak];
})()`;

const isReady = (tab) => tab.value(`document.documentElement.dataset.ready`);

function heard(tab, where) {
  assert.deepEqual(tab.errors, [], `${where}: errors`);
  assert.deepEqual(tab.requests.filter((url) => !url.startsWith('file:')), [], `${where}: it loads something`);
}

async function drive(chromium, folder) {
  const tab = await chromium.open(pathToFileURL(resolve(folder, 'page.html')).href);
  await tab.settled();
  assert.equal(await isReady(tab), 'yes', 'the script did not come to its end');
  const held = await documentsAreThose(tab, folder);
  const plan = Object.values(held).find((value) => value.path !== undefined);
  const parts = [`${plan.path.length} legs`];
  if (plan.path.length > 0) {
    const hasMap = await tab.value(`Boolean(document.querySelector('#plan [data-leg]'))`);
    await selectionIsEverywhere(tab, plan.path, hasMap);
    parts.push(`${await sliderMoves(tab, plan.path, plan.scenario.body.gravity_m_s2)} sliders`);
    const worst = await tab.value(`document.getElementById('self-check')?.dataset.worst ?? '0'`);
    assert.ok(Number(worst) < 1e-9, `the drawn arcs are off by ${worst}`);
  }
  const { posts, layers } = JSON.parse(await tab.value(`document.getElementById('ground').textContent`));
  if (layers) parts.push(`${await layersAreShown(tab, layers)} layers`);
  if (posts) {
    const said = await tab.value(`document.querySelector('#plan .legend').textContent`);
    const isWhole = posts.rows === posts.of_rows && posts.columns === posts.of_columns;
    assert.ok(posts.rows <= 512 && posts.columns <= 512, `${posts.rows} × ${posts.columns} posts`);
    assert.ok(said.includes(`${posts.rows} × ${posts.columns} posts`) && said.includes(`the DEM has ${posts.of_rows} × ${posts.of_columns}`) !== isWhole, said);
    assert.equal(said.includes(`thinned to one post in ${posts.stride} each way`), posts.stride > 1, said);
    if (posts.stride > 1) parts.push('thinned');
  }
  if (held['trade.json']) await gridIsLookedUp(tab, held['trade.json']);
  if (await tab.value(`Boolean(document.querySelector('#space canvas'))`)) {
    await spaceTurns(tab);
    parts.push('3-D');
  }
  assert.deepEqual(await tab.value(WEAK), [], 'weak contrast');
  const pdf = await tab.send('Page.printToPDF', { paperWidth: 8.27, paperHeight: 11.69, preferCSSPageSize: true });
  if (process.env.CHTA_PAGES_TO) writeFileSync(join(process.env.CHTA_PAGES_TO, `${basename(folder)}.pdf`), Buffer.from(pdf.data, 'base64'));
  await tab.resize(360, 800);
  await tab.settled();
  const [inner, wide] = await tab.value(`[document.documentElement.clientWidth, document.documentElement.scrollWidth]`);
  assert.ok(wide <= inner, `a window of ${inner} pixels scrolls to ${wide}`);
  heard(tab, basename(folder));
  await tab.close();
  return parts.join(', ');
}

async function withoutWebGl(chromium, folder) {
  const tab = await chromium.open(pathToFileURL(resolve(folder, 'page.html')).href);
  await tab.settled();
  assert.equal(await isReady(tab), 'yes', 'without WebGL the script did not come to its end');
  const space = await tab.value(`[document.querySelector('#space') !== null, document.getElementById('no-webgl') !== null].join()`);
  assert.ok(['true,true', 'false,false'].includes(space), 'the page does not say that the third dimension is left out');
  heard(tab, `${basename(folder)} without WebGL`);
  await tab.close();
}

let failed = 0;
for (const [more, test, what] of [[[], drive, 'driven'], [['--disable-3d-apis'], withoutWebGl, 'without WebGL']]) {
  const chromium = new Chromium(program, more);
  for (const folder of folders) {
    try {
      assert.ok(existsSync(join(folder, 'page.html')), 'no page.html');
      const said = await test(chromium, folder);
      console.log(`${basename(folder)}: ${what}${said ? `, ${said}` : ''}`);
    } catch (error) {
      failed += 1;
      console.error(`${basename(folder)}: ${what}: ${error.message}`);
    }
  }
  await chromium.close();
}
process.exit(failed === 0 ? 0 : 1);
