// Bundles the page of `chta report` into dist/page.html: one file with its script, its style and the licence of three.js, and a
// Content-Security-Policy that allows these two and nothing else. The same sources and lock file give the same bytes.

import { createHash } from 'node:crypto';
import { mkdirSync, readFileSync, writeFileSync } from 'node:fs';
import { build } from 'esbuild';

const here = new URL('.', import.meta.url);
const read = (name) => readFileSync(new URL(name, here), 'utf8');
const hash = (text) => `sha256-${createHash('sha256').update(text).digest('base64')}`;

const bundled = await build({
  entryPoints: [new URL('src/main.js', here).pathname],
  bundle: true,
  minify: true,
  format: 'iife',
  target: 'es2022',
  charset: 'utf8',
  legalComments: 'none', // The page shows the whole licence.
  write: false,
});
// No text of the script may end its element.
const script = bundled.outputFiles[0].text.trim().replaceAll('</script', '<\\/script').replaceAll('<!--', '<\\!--');
const style = read('src/style.css').trim();
const { version } = JSON.parse(read('node_modules/three/package.json'));
const escaped = (text) => text.trim().replaceAll('&', '&amp;').replaceAll('<', '&lt;');

const parts = {
  '{script-hash}': hash(script),
  '{style-hash}': hash(style),
  '{style}': style,
  '{three-version}': version,
  '{three-licence}': escaped(read('node_modules/three/LICENSE')),
  '{script}': script,
};
const page = read('src/page.html').replace(/\{[a-z-]+\}/g, (name) => parts[name] ?? name);
mkdirSync(new URL('dist', here), { recursive: true });
writeFileSync(new URL('dist/page.html', here), page);
writeFileSync(new URL('dist/three.LICENSE', here), read('node_modules/three/LICENSE'));
console.log(`dist/page.html: ${page.length} characters, three.js ${version}`);
