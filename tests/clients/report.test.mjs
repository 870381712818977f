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
async function openReport(folder, viewport) {
  const page = await browser.newPage({ viewport });
  const requests = [], errors = [];
  page.on('request', (request) => requests.push(request.url()));
  page.on('pageerror', (error) => errors.push(String(error)));
  page.on('console', (message) => { if (['error', 'warning'].includes(message.type())) errors.push(message.text()); });
  await page.goto(pathToFileURL(path.join(root, folder, 'report.html')).href, { waitUntil: 'load' });
  return { page, requests: () => requests.filter((url) => !url.startsWith('data:')).slice(1), errors };
}

/** The text of a column of the table, from top to bottom. */
const column = (page, index) => page.locator(`#table tbody tr > :nth-child(${index + 1})`).allTextContents();
const headings = (page) => page.locator('#table thead tr:last-child th').allTextContents();
const number = (text) => Number(text.replace(/[^0-9.]/g, ''));

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
