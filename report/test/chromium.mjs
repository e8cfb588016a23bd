// Chromium without a window, driven over the pipes of its DevTools protocol: no package, and no port.

import { spawn } from 'node:child_process';
import { mkdtempSync, rmSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';

const ARGUMENTS = ['--headless=new', '--remote-debugging-pipe', '--no-sandbox', '--no-first-run', '--disable-extensions', '--disable-background-networking', '--hide-scrollbars'];

export class Chromium {
  #next = 0;
  #waiting = new Map();
  #listeners = [];

  /** `program`: its path; `more`: further arguments, such as those that take WebGL away. */
  constructor(program, more = []) {
    this.profile = mkdtempSync(join(tmpdir(), 'chta-page-'));
    this.process = spawn(program, [...ARGUMENTS, ...more, `--user-data-dir=${this.profile}`, 'about:blank'], { stdio: ['ignore', 'ignore', 'ignore', 'pipe', 'pipe'] });
    const [, , , input, output] = this.process.stdio;
    this.input = input;
    let rest = '';
    output.setEncoding('utf8');
    output.on('data', (text) => {
      const messages = (rest + text).split('\0');
      rest = messages.pop();
      messages.forEach((message) => this.#receive(JSON.parse(message)));
    });
    this.process.on('exit', () => this.#waiting.forEach(({ reject }) => reject(new Error('Chromium has ended'))));
  }

  #receive(message) {
    if (message.id === undefined) return this.#listeners.forEach((listener) => listener(message));
    const { resolve, reject } = this.#waiting.get(message.id);
    this.#waiting.delete(message.id);
    if (message.error) reject(new Error(message.error.message));
    else resolve(message.result);
  }

  listen(listener) {
    this.#listeners.push(listener);
  }

  send(method, params = {}, sessionId = undefined) {
    this.#next += 1;
    const id = this.#next;
    this.input.write(`${JSON.stringify({ id, method, params, sessionId })}\0`);
    return new Promise((resolve, reject) => this.#waiting.set(id, { resolve, reject }));
  }

  /** Opens a file in a tab, and waits until its load event. */
  async open(url, width = 1280, height = 900) {
    const { targetId } = await this.send('Target.createTarget', { url: 'about:blank' });
    const { sessionId } = await this.send('Target.attachToTarget', { targetId, flatten: true });
    const tab = new Tab(this, targetId, sessionId);
    this.listen((message) => message.sessionId === sessionId && tab.receive(message));
    for (const domain of ['Page', 'Runtime', 'Log', 'Network']) await tab.send(`${domain}.enable`);
    await tab.resize(width, height);
    const loaded = new Promise((resolve) => (tab.loaded = resolve));
    await tab.send('Page.navigate', { url });
    await loaded;
    return tab;
  }

  async close() {
    await this.send('Browser.close').catch(() => {});
    if (this.process.exitCode === null) await new Promise((resolve) => this.process.once('exit', resolve));
    rmSync(this.profile, { recursive: true, force: true });
  }
}

export class Tab {
  /** What the page complained of: exceptions, errors on the console, violations of its policy. */
  errors = [];
  /** What it asked for beside itself. */
  requests = [];

  constructor(chromium, targetId, sessionId) {
    Object.assign(this, { chromium, targetId, sessionId });
  }

  send(method, params) {
    return this.chromium.send(method, params, this.sessionId);
  }

  receive({ method, params }) {
    if (method === 'Page.loadEventFired') this.loaded?.();
    if (method === 'Runtime.exceptionThrown') this.errors.push(params.exceptionDetails.exception?.description ?? params.exceptionDetails.text);
    if (method === 'Runtime.consoleAPICalled' && ['error', 'assert'].includes(params.type)) this.errors.push(params.args.map((arg) => arg.value ?? arg.description).join(' '));
    if (method === 'Log.entryAdded' && params.entry.level === 'error') this.errors.push(params.entry.text);
    if (method === 'Network.requestWillBeSent') this.requests.push(params.request.url);
  }

  resize(width, height) {
    return this.send('Emulation.setDeviceMetricsOverride', { width, height, deviceScaleFactor: 1, mobile: false });
  }

  /** The value of an expression in the page. */
  async value(expression) {
    const { result, exceptionDetails } = await this.send('Runtime.evaluate', { expression, returnByValue: true, awaitPromise: true });
    if (exceptionDetails) throw new Error(exceptionDetails.exception?.description ?? exceptionDetails.text);
    return result.value;
  }

  /** Waits for two frames: what an event changes is then drawn. */
  settled() {
    return this.value('new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(() => done(true))))');
  }

  async key(key) {
    await this.send('Input.dispatchKeyEvent', { type: 'keyDown', key, code: key });
    await this.send('Input.dispatchKeyEvent', { type: 'keyUp', key, code: key });
    await this.settled();
  }

  async screenshot(whole = true) {
    const { data } = await this.send('Page.captureScreenshot', { format: 'png', captureBeyondViewport: whole });
    return Buffer.from(data, 'base64');
  }

  async close() {
    await this.chromium.send('Target.closeTarget', { targetId: this.targetId });
  }
}
