// report.html in a headless Chromium, from the disk: it draws itself, sorts, filters, and asks for nothing.
import assert from 'node:assert/strict';
import fs from 'node:fs';
import path from 'node:path';
import { after, before, test } from 'node:test';
import { pathToFileURL } from 'node:url';
import { launch, screenshot } from './browser.mjs';
import { readJson, root } from './outputs.mjs';

let browser;
before(async () => { browser = await launch(); });
after(async () => { await browser?.close(); });

/** The page, with everything it asked for and complained about. */
async function openReport(folder, viewport, file = 'report.html') {
  const page = await browser.newPage({ viewport });
  const requests = [], errors = [];
  page.on('request', (request) => requests.push(request.url()));
  page.on('pageerror', (error) => errors.push(String(error)));
  page.on('console', (message) => { if (['error', 'warning'].includes(message.type())) errors.push(message.text()); });
  await page.goto(pathToFileURL(path.join(root, folder, file)).href, { waitUntil: 'load' });
  return { page, requests: () => requests.filter((url) => !url.startsWith('data:')).slice(1), errors };
}

/** Writes the page beside itself with other data; returns its name. */
function changeReport(folder, name, change) {
  const page = fs.readFileSync(path.join(root, folder, 'report.html'), 'utf8');
  fs.writeFileSync(path.join(root, folder, name), page.replace(/(id="report-data">)(.*?)(<\/script>)/s, (_, start, data, end) => {
    const report = JSON.parse(data);
    change(report);
    return start + JSON.stringify(report).replaceAll('<', '\\u003c') + end;
  }));
  return name;
}

/** How high each step of a curve stands over the axis, as shares of the first. */
const heights = (page, name) => page.locator(`#switching svg:has(.drawn.${name})`).evaluate((svg, curve) => {
  const base = Number(/V([\d.]+)H/.exec(svg.querySelector('.axis').getAttribute('d'))[1]);
  const [first, ...rest] = svg.querySelector(`.drawn.${curve}`).getAttribute('d').match(/(?<=V|M\d+ )[\d.]+/g).map((y) => base - y);
  return [1, ...rest.map((height) => height / first)];
}, name);

/** The text of a column of the table, from top to bottom. */
const column = (page, index) => page.locator(`#table tbody tr > :nth-child(${index + 1})`).allTextContents();
const headings = (page) => page.locator('#table thead tr:last-child th').allTextContents();
const number = (text) => Number(text.replace(/[^0-9.]/g, ''));

/** As the page sorts them at first: by the worst layer's points for looks. */
const byLooks = (all) => {
  const points = (b) => Math.max(...b.layers.map((l) => l.looks.points));
  return [...all].sort((a, b) => points(b) - points(a));
};

test('the report opens from the disk without a request and shows every building', async () => {
  const { page, requests, errors } = await openReport('local', { width: 1400, height: 900 });
  const report = readJson(path.join(root, 'local', 'report.json'));
  assert.equal(await page.locator('#table tbody tr').count(), report.buildings.length);
  assert.equal(await page.locator('.card').count(), report.buildings.length);
  for (const id of ['overview', 'plots', 'coanalysis', 'time', 'parameters']) assert.ok(await page.locator(`#${id}`).isVisible(), id);
  assert.ok(await page.locator('#plots svg').count() >= 3);
  const pixels = await page.evaluate(() => new Set(document.getElementById('matrix').getContext('2d')
    .getImageData(0, 0, 50, 50).data.filter((_, i) => i % 4 === 0)).size);
  assert.ok(pixels > 5, `the matrix has ${pixels} shades`);
  await screenshot(page, 'report');
  assert.deepEqual(requests(), []);
  assert.deepEqual(errors, []);
  await page.close();
});

test('a click on a heading sorts the table, and pictures follow', async () => {
  const { page, errors } = await openReport('local', { width: 1400, height: 900 });
  const titles = await headings(page), faces = titles.lastIndexOf('Faces');
  const head = page.locator('#table thead tr:last-child th').nth(faces);
  for (const [order, sign] of [['descending', -1], ['ascending', 1]]) {
    await head.locator('button').click();
    assert.equal(await head.getAttribute('aria-sort'), order);
    const shown = (await column(page, faces)).map(number);
    assert.ok(shown.every((x, i) => i === 0 || sign * (x - shown[i - 1]) >= 0), shown.join());
    assert.ok(shown.at(-1) !== shown[0]);
  }
  const names = await column(page, 0);
  assert.deepEqual(await page.locator('.card h3').evaluateAll((all) => all.map((h) => h.firstChild.textContent)), names);
  await page.locator('input[type=search]').fill(names[3]);
  assert.deepEqual(await column(page, 0), [names[3]]);
  assert.deepEqual(errors, []);
  await page.close();
});

const finest = (building) => building.layers.at(-1), coarsest = (building) => building.layers[0];
const total = (buildings, layer, key) => buildings.reduce((sum, b) => sum + layer(b)[key], 0);
const kFar = 1080 / (2 * Math.tan(Math.PI / 6));  // metres away where a pixel of 1080 over 60 degrees covers one
const near = (a, b, text) => assert.ok(Math.abs(a - b) < 0.01, `${text}: ${a}, not ${b}`);

test('the report says when layers switch, and draws triangles and bytes against distance', async () => {
  const { page, errors } = await openReport('local', { width: 1400, height: 900 });
  const { switching, buildings } = readJson(path.join(root, 'local', 'report.json'));
  const rows = await page.locator('#switching tbody tr').allTextContents();
  for (const l of switching.layers.filter((layer) => layer.buildings > 0)) {
    const row = rows.find((text) => text.startsWith(`Layer ${l.layer}`));
    near(number(/from ([\d,.]+) m/.exec(row)[1]) / (l.gsd * kFar), 1, row);
    assert.ok(row.includes(l.gsd.toFixed(3)) && row.includes(String(l.buildings)), row);
    assert.match(row, l.too_coarse > 0 ? /[\d.]+ %, up to [\d.]+ ×/ : /0 %/);
  }
  const levels = new Set(switching.layers.filter((l) => l.buildings > 0).map((l) => l.gsd));
  assert.ok(levels.size > 0);
  assert.equal(await page.locator('#switching .switch').count(), levels.size);
  for (const [name, key] of [['triangles', 'faces'], ['bytes', 'bytes']]) {
    const steps = await heights(page, name);
    assert.equal(steps.length, levels.size + 1);
    near(steps.at(-1), total(buildings, coarsest, key) / total(buildings, finest, key), name);
  }
  await page.locator('#switching').scrollIntoViewIfNeeded();
  await screenshot(page, 'report-switching');
  assert.deepEqual(errors, []);
  await page.close();
});

test('the plot against distance tells what is drawn under the pointer', async () => {
  const { page } = await openReport('local', { width: 1400, height: 900 });
  const { buildings } = readJson(path.join(root, 'local', 'report.json'));
  const svg = page.locator('#switching svg');
  for (const [part, layer] of [[0.08, finest], [0.9, coarsest]]) {
    const triangles = total(buildings, layer, 'faces').toLocaleString('en');
    let told = '';
    for (let i = 0; !told.includes(`${triangles} triangles`) && i < 300; ++i) {  // cards above that come into view may still move it
      await svg.evaluate((plot) => plot.scrollIntoView({ block: 'center' }));
      const box = await svg.boundingBox();
      await page.mouse.move(box.x + box.width * part + i % 2, box.y + 60);
      told = await page.locator('#switching .tip').textContent();
    }
    const [, metres, gsd] = /^([\d,.]+) m, ([\d,.]+) m\/px/.exec(told).map(number);
    near(metres / (gsd * kFar), 1, told);
    assert.match(told, new RegExp(`m/px${triangles} triangles .*kB.*layer ${layer(buildings[0]).layer}: \\d+ buildings?`));
  }
  await page.close();
});

test("a building's card has its g, deviation and distances on every layer", async () => {
  const { page, errors } = await openReport('local', { width: 1400, height: 900 });
  const { buildings } = readJson(path.join(root, 'local', 'report.json'));
  const own = (await headings(page)).indexOf('Own g');
  const shown = byLooks(buildings);
  assert.deepEqual(await column(page, own), shown.map(({ layers: [l] }) => (l.like_finer ? 'as 1' : l.own_gsd.toFixed(3))));
  const card = page.locator('.card').first();
  await card.scrollIntoViewIfNeeded();
  await card.locator('summary', { hasText: 'Switching' }).click();
  const rows = await card.locator('details:has(summary:text("Switching")) tbody tr').evaluateAll((all) => all.map((row) => [...row.querySelectorAll('td')].map((cell) => cell.textContent)));
  assert.deepEqual(rows, shown[0].layers.map((l) => [...[l.gsd, l.own_gsd, l.deviation].map((x) => (l.like_finer ? `as ${l.layer + 1}` : x > 0 ? x.toFixed(3) : '0')),
    ...['mean', 'p95', 'p99', 'max'].map((key) => l.distance[key].toFixed(3))]));
  await screenshot(page, 'report-card');
  assert.deepEqual(errors, []);
  await page.close();
});

test('the worst looks come first, and a card says what is wrong', async () => {
  const file = changeReport('local', 'looks.html', ({ buildings }) => {
    Object.assign(buildings[3].layers[1].looks, { points: 60, faults: ['flap', 'leaning'], flaps: 12.34, upright: 0.5 });
  });
  const { page, errors } = await openReport('local', { width: 1400, height: 900 }, file);
  const looks = (await headings(page)).indexOf('Looks');
  assert.equal(await page.locator('#table thead tr:last-child th').nth(looks).getAttribute('aria-sort'), 'descending');
  const shown = (await column(page, looks)).map(number);
  assert.equal(shown[0], 60);
  assert.ok(shown.every((x, i) => i === 0 || x <= shown[i - 1]), shown.join());
  const card = page.locator('.card').first();
  assert.equal(await card.getAttribute('id'), 'b3');
  await card.scrollIntoViewIfNeeded();
  await card.locator('summary', { hasText: 'Looks' }).click();
  const row = await card.locator('details:has(summary:text("Looks")) tbody tr').nth(1).textContent();
  assert.match(row, /60: flaps, leaning walls50 %.*12\.3/);
  assert.deepEqual(errors, []);
  await page.close();
});

test('what was left out is told, alike layers are named, and bytes may be missing', async () => {
  const file = changeReport('local', 'changed.html', ({ switching, buildings }) => {
    buildings[0].left_out = [{ reason: 'ground', area: 12.34, share: 0.056, farthest: 7.8 }, { reason: 'floater', area: 0, share: 0.01, farthest: 9.1 }];
    switching.scope = 'building';
    Object.assign(switching.layers[0], { gsd: switching.layers[1].gsd, buildings: 0 });
    for (const { layers: [first, second] } of buildings) Object.assign(first, { ...second, layer: 0, like_finer: true });
    for (const l of buildings.flatMap((b) => b.layers)) delete l.bytes;
  });
  const { page, errors } = await openReport('local', { width: 1400, height: 900 }, file);
  assert.ok((await column(page, (await headings(page)).indexOf('Left out'))).includes('6.6 %'));
  const card = page.locator('#b0');
  await card.scrollIntoViewIfNeeded();
  await card.locator('.strip').waitFor();
  assert.match(await card.textContent(), /ground \(12\.3 m², 5\.6 %\), up to 7\.8 m away; pieces afloat \(1\.0 %\), up to 9\.1 m away/);
  assert.match(await card.locator('figcaption').nth(1).textContent(), /faces, as layer 1$/);
  assert.match((await page.locator('#switching tbody tr').allTextContents()).at(-1), /^Layer 0.*as layer 1/);
  assert.match(await page.locator('#switching').textContent(), /Each building switches by its own g/);
  assert.equal(await page.locator('#switching .drawn.bytes').count(), 0);
  assert.equal(await page.locator('#switching svg .drawn.triangles').count(), 1);
  assert.deepEqual(errors, []);
  await page.close();
});

test('pictures are decoded when they come into view, on a narrow screen too', async () => {
  for (const width of [1400, 600]) {
    const { page, errors } = await openReport('local', { width, height: 900 });
    const card = page.locator('.card').last();
    await page.waitForFunction(() => {
      document.querySelector('.card:last-child').scrollIntoView({ block: 'end' });  // cards above that come into view move it
      const images = [...document.querySelectorAll('.card:last-child img')];
      return images.length > 0 && images.every((image) => image.complete && image.naturalWidth > 0);
    });
    assert.equal(await card.locator('img').count(), 4);
    assert.ok(await page.evaluate(() => document.documentElement.scrollWidth <= innerWidth), `too wide at ${width}`);
    await screenshot(page, `report-pictures-${width}`);
    assert.deepEqual(errors, []);
    await page.close();
  }
});

test('the plots tell about the building under the pointer', async () => {
  const { page } = await openReport('local', { width: 1400, height: 900 });
  const svg = page.locator('#plots svg').first();
  let told = '';
  for (let i = 0; told === '' && i < 300; ++i) {  // cards above that come into view may still move it
    await svg.evaluate((plot) => plot.scrollIntoView({ block: 'center' }));
    const box = await svg.boundingBox();
    await page.mouse.move(box.x + box.width / 2 + i % 2, box.y + 60);
    told = await page.locator('#plots .tip').first().textContent();
  }
  assert.match(told, /house_\d+.*source: [\d,]+.*layer 0: \d+/s);
  await page.close();
});

test('a building that failed is marked, with its reason as text', async () => {
  const { page, errors } = await openReport('failed', { width: 1400, height: 900 });
  const report = readJson(path.join(root, 'failed', 'report.json'));
  assert.ok(report.failures.length + report.buildings.filter((b) => b.failure).length > 0);
  assert.match(await page.locator('#problems').textContent(), /failure/);
  for (const failure of report.failures) assert.ok((await page.locator('#problems').textContent()).includes(failure.message));
  assert.equal(await page.locator('#overview .bad').count() > 0, true);
  assert.equal(await page.locator('b b, script + b, main img[onerror]').count(), 0);
  assert.ok((await column(page, 0)).some((name) => name.includes('<b>')) || !report.buildings.some((b) => b.name.includes('<b>')));
  await screenshot(page, 'report-failed');
  assert.deepEqual(errors, []);
  await page.close();
  assert.ok(fs.statSync(path.join(root, 'failed', 'report.html')).size > 0);
});
