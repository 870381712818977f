// Looks at a place in CesiumJS from several stops and writes down what that costs; bench/places starts it, in a copy of tests/clients
// with this folder over it.
//   node place.mjs TILESET FRAME STOPS.json OUT --lines 1080 --sse 16
// FRAME: colod's tileset of the place, in whose frame the stops are. Both lie below COLOD_CLIENTS_DATA. Each stop begins with nothing
// loaded. OUT gets run.json and a picture a stop.
import fs from 'node:fs';
import path from 'node:path';
import { parseArgs } from 'node:util';
import { launch, open, serve } from './browser.mjs';
import { readJson } from './outputs.mjs';

const { positionals: [tileset, frame, stopsFile, out], values } = parseArgs({ allowPositionals: true,
  options: { lines: { type: 'string', default: '1080' }, sse: { type: 'string', default: '16' } } });
const lines = Number(values.lines), folder = `/out/${path.posix.dirname(tileset)}/`;
fs.mkdirSync(out, { recursive: true });
const server = await serve(), browser = await launch();

async function look(stop) {
  const { page, errors } = await open(browser, 'about:blank');
  await page.setViewportSize({ width: Math.round(lines * 16 / 9), height: lines });
  const started = server.log.length;
  await page.goto(`${server.address}/pages/place-cesium.html?tileset=/out/${tileset}&frame=/out/${frame}`, { waitUntil: 'load' });
  await page.waitForFunction(() => window.client);
  const row = await page.evaluate(([where, sse]) => window.client.stop(where, sse), [stop, Number(values.sse)]);
  // Each file once: the page reads the frame's tileset, too, which may be the one that is shown.
  const answers = new Map(server.log.slice(started).filter(({ url }) => url.startsWith(folder)).map(({ url, bytes }) => [url, bytes]));
  row.bytes = [...answers.values()].reduce((sum, bytes) => sum + bytes, 0);
  row.files = answers.size;
  row.picture = path.join(out, `${stop.name}.png`);
  await page.screenshot({ path: row.picture });
  const failures = [...errors, ...await page.evaluate(() => window.client.failures)];
  await page.close();
  if (failures.length > 0) throw new Error(`${tileset}: ${failures.join('; ')}`);
  return { ...stop, ...row };
}

try {
  const rows = [];
  for (const stop of readJson(stopsFile)) {
    rows.push(await look(stop));  // minutes each, on a software renderer
    fs.writeFileSync(path.join(out, 'run.json'), `${JSON.stringify(rows, null, 1)}\n`);
  }
} finally {
  await browser.close();
  server.close();
}
