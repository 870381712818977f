// A loopback server over the clients' packages, the pages and what colod wrote, and a headless Chromium.
import fs from 'node:fs';
import http from 'node:http';
import os from 'node:os';
import path from 'node:path';
import { fileURLToPath } from 'node:url';
import { chromium } from 'playwright-core';
import { root } from './outputs.mjs';

const here = path.dirname(fileURLToPath(import.meta.url));
const mounts = { out: root, node_modules: path.join(here, 'node_modules'), pages: path.join(here, 'pages') };
const types = { '.html': 'text/html', '.js': 'text/javascript', '.mjs': 'text/javascript', '.json': 'application/json',
  '.wasm': 'application/wasm', '.glb': 'model/gltf-binary', '.css': 'text/css' };

/** Serves ranges too; `log` receives {url, bytes} for every answer. */
export async function serve() {
  const log = [];
  const server = http.createServer((request, response) => {
    const url = decodeURIComponent(new URL(request.url, 'http://localhost').pathname);
    if (url === '/favicon.ico') {  // browsers ask by themselves
      response.writeHead(204).end();
      return;
    }
    const [, mount, ...rest] = url.split('/');
    const base = mounts[mount], file = base && path.join(base, ...rest);
    if (!file || !file.startsWith(base) || !fs.existsSync(file) || !fs.statSync(file).isFile()) {
      response.writeHead(404).end();
      return;
    }
    let body = fs.readFileSync(file), status = 200;
    const headers = { 'Content-Type': types[path.extname(file)] ?? 'application/octet-stream', 'Accept-Ranges': 'bytes',
      'Cache-Control': 'no-store' };
    const range = /^bytes=(\d+)-(\d*)$/.exec(request.headers.range ?? '');
    if (range) {
      const last = Math.min(range[2] === '' ? body.length - 1 : Number(range[2]), body.length - 1);
      headers['Content-Range'] = `bytes ${range[1]}-${last}/${body.length}`;
      body = body.subarray(Number(range[1]), last + 1);
      status = 206;
    }
    log.push({ url, bytes: body.length });
    response.writeHead(status, headers).end(body);
  });
  await new Promise((done) => server.listen(0, '127.0.0.1', done));
  return { address: `http://127.0.0.1:${server.address().port}`, log, close: () => server.close() };
}

export async function launch() {
  const executablePath = ['/usr/bin/chromium', '/usr/bin/chromium-browser', '/usr/bin/google-chrome']
    .find((file) => fs.existsSync(file));
  return chromium.launch({ executablePath, headless: true, args: ['--no-sandbox', '--disable-quic', '--no-first-run',
    '--disable-background-networking', '--disable-component-update', '--disable-sync', '--use-gl=angle',
    '--use-angle=swiftshader', '--enable-unsafe-swiftshader', '--ignore-gpu-blocklist'] });
}

/** A page whose errors, console errors and failed requests end up in `errors`. */
export async function open(browser, url) {
  const page = await browser.newPage({ viewport: { width: 640, height: 480 } });
  const errors = [];
  page.on('pageerror', (error) => errors.push(String(error)));
  page.on('console', (message) => {
    if (message.type() === 'error') errors.push(message.text());
  });
  page.on('requestfailed', (request) => {  // requests that a page gives up, having read them or not, are its own affair
    const reason = request.failure()?.errorText;
    if (reason !== 'net::ERR_ABORTED') errors.push(`${reason}: ${request.url()}`);
  });
  page.setDefaultTimeout(180000);  // a software renderer on a busy machine
  await page.goto(url, { waitUntil: 'load' });
  return { page, errors };
}

/** Keeps a picture as a test artefact; returns its path. */
export async function screenshot(page, name) {
  const folder = process.env.COLOD_CLIENTS_PICTURES ?? path.join(os.tmpdir(), 'colod-clients');
  fs.mkdirSync(folder, { recursive: true });
  const file = path.join(folder, `${name}.png`);
  await page.screenshot({ path: file });
  return file;
}
