// Drives one client over the stops of a tileset and writes down what it draws; bench/streaming starts it, in a copy of
// tests/clients with this folder over it.
//   node streaming.mjs CLIENT TILESET PATHS.json OUT --stops 12 --lines 540 [--no-pictures]
// CLIENT: cesium or tiles-renderer. TILESET lies below COLOD_CLIENTS_DATA. OUT gets run.json and two pictures a stop: as the client
// draws at the tileset's error, and the finest.
import fs from 'node:fs';
import path from 'node:path';
import { parseArgs } from 'node:util';
import { launch, open as openPage, serve } from './browser.mjs';
import { readJson, root } from './outputs.mjs';

const { positionals: [client, tileset, pathsFile, out], values } = parseArgs({ allowPositionals: true,
  options: { stops: { type: 'string', default: '12' }, lines: { type: 'string', default: '540' }, 'no-pictures': { type: 'boolean' } } });
const { aspect, fovy_deg, paths } = readJson(pathsFile);
const lines = Number(values.lines), most = Number(values.stops);
const { offset = [0, 0, 0], targetSse = 16 } = readJson(path.join(root, tileset)).asset.extras ?? {};
const folder = path.posix.dirname(tileset);
fs.mkdirSync(out, { recursive: true });

const server = await serve(), browser = await launch();

async function open() {
  const { page, errors } = await openPage(browser, `${server.address}/pages/streaming-${client}.html?tileset=/out/${tileset}`);
  await page.setViewportSize({ width: Math.round(lines * aspect), height: lines });
  await page.reload({ waitUntil: 'load' });  // in this size from the beginning
  await page.waitForFunction(() => window.client);
  return { page, errors };
}

/** Bytes of tiles answered since `from`, but the tileset itself. */
const bytesSince = (from) => server.log.slice(from).filter(({ url }) => url.startsWith(`/out/${folder}/`) && url !== `/out/${tileset}`)
  .reduce((sum, { bytes }) => sum + bytes, 0);

/** At most `most` stops, first and last among them, each with its number. */
function chosen(stops) {
  const count = Math.min(most, stops.length);
  const numbers = Array.from({ length: count }, (_, i) => Math.round(i * (stops.length - 1) / Math.max(1, count - 1)));
  return numbers.map((number) => ({ number, ...stops[number] }));
}

const local = ({ eye, target }) => ({ eye: eye.map((c, k) => c - offset[k]), target: target.map((c, k) => c - offset[k]) });

const nameOf = (url) => path.posix.relative(`/out/${folder}`, decodeURIComponent(new URL(url).pathname));

const look = (page, stop, limit) => page.evaluate(([where, pixels]) => window.client.stop(where, pixels), [local(stop), limit]);

async function close({ page, errors }) {
  const failures = [...errors, ...await page.evaluate(() => window.client.failures)];
  if (failures.length > 0) throw new Error(`${client}, ${tileset}: ${failures.join('; ')}`);
  await page.close();
}

/** One path from its first stop on, with nothing loaded before. */
async function drive({ name, stops }) {
  const started = server.log.length, opened = await open(), rows = [];
  for (const stop of chosen(stops)) {
    const { triangles, drawn } = await look(opened.page, stop, targetSse);
    const row = { ...stop, triangles, loaded_bytes: bytesSince(started) };
    row.drawn = drawn.map(({ url, features }) => ({ uri: nameOf(url), features }));
    row.bytes = row.drawn.reduce((sum, { uri }) => sum + fs.statSync(path.join(root, folder, uri)).size, 0);
    if (!values['no-pictures']) {
      row.picture = `${name}-${stop.number}.png`;
      await opened.page.screenshot({ path: path.join(out, row.picture) });
    }
    rows.push(row);
  }
  await close(opened);
  return { name, stops: rows };
}

async function drawFinest(runs) {
  const opened = await open();
  for (const { name, stops } of runs)
    for (const stop of stops) {
      await look(opened.page, stop, 0);
      stop.finest = `${name}-${stop.number}-finest.png`;
      await opened.page.screenshot({ path: path.join(out, stop.finest) });
    }
  await close(opened);
}

try {
  const runs = [];
  for (const each of paths) runs.push(await drive(each));
  if (!values['no-pictures']) await drawFinest(runs);
  fs.writeFileSync(path.join(out, 'run.json'), `${JSON.stringify({ client, lines, fovy_deg, limit: targetSse, paths: runs }, null, 1)}\n`);
} finally {
  await browser.close();
  server.close();
}
