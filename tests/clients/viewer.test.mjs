// The page of `colod view`, served by colod itself: what its settings and a click do.
import assert from 'node:assert/strict';
import { spawn } from 'node:child_process';
import path from 'node:path';
import { createInterface } from 'node:readline';
import { after, before, test } from 'node:test';
import { launch, open, screenshot } from './browser.mjs';
import { root } from './outputs.mjs';

let browser;
before(async () => { browser = await launch(); });
after(async () => { await browser?.close(); });

/** The page over a folder that colod wrote, when its first tiles are there; closed with the test. */
async function view(t, folder) {
  const server = spawn(process.env.COLOD, ['view', path.join(root, folder)], { stdio: ['ignore', 'pipe', 'inherit'] });
  t.after(() => server.kill());
  const [address] = await Promise.race([createInterface(server.stdout)[Symbol.asyncIterator]().next().then(({ value }) => [value]),
    new Promise((done) => { server.once('exit', (code) => done([`colod view ended with ${code}`])); })]);
  assert.match(address, /^http:\/\/127\.0\.0\.1:\d+\/$/);
  const { page, errors } = await open(browser, address);
  t.after(() => page.close());
  await ready(page);
  return { page, errors };
}

/** All tiles are there, and drawn with the settings as they are. */
async function ready(page) {
  await page.waitForFunction(() => document.body.dataset.state === 'ready');
  await page.evaluate(() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done))));
}

const counter = (page, id) => page.evaluate((name) => Number(document.getElementById(name).value), id);

/** Clicks over a lattice until a building answers. */
async function pick(page) {
  for (let y = 100; y < 400; y += 20)
    for (let x = 260; x < 620; x += 20) {
      await page.mouse.click(x, y);
      if (await page.isVisible('#building')) return;
    }
}

/** Share of the view's pixels that are clearly coloured. */
async function colourfulness(page) {
  const picture = (await page.screenshot({ clip: { x: 260, y: 100, width: 380, height: 320 } })).toString('base64');
  return page.evaluate(async (png) => {
    const image = await createImageBitmap(await (await fetch(`data:image/png;base64,${png}`)).blob());
    const context = new OffscreenCanvas(image.width, image.height).getContext('2d');
    context.drawImage(image, 0, 0);
    const data = context.getImageData(0, 0, image.width, image.height).data;
    let count = 0;
    for (let i = 0; i < data.length; i += 4)
      if (Math.max(data[i], data[i + 1], data[i + 2]) - Math.min(data[i], data[i + 1], data[i + 2]) > 48) ++count;
    return count / (image.width * image.height);
  }, picture);
}

for (const folder of ['local', 'earth']) {
  test(`the viewer shows, colours, refines and explains (${folder})`, async (t) => {
    const { page, errors } = await view(t, folder);
    assert.match(await page.innerText('#place'), folder === 'earth' ? /UTM zone 32N/ : /^local/);
    const plain = await colourfulness(page);
    await screenshot(page, `viewer-${folder}`);

    await page.check('input[value=building]');
    await ready(page);
    const coloured = await colourfulness(page);
    await screenshot(page, `viewer-${folder}-buildings`);
    assert.ok(coloured > plain + 0.02, `coloured by building: ${coloured} of the picture, plain ${plain}`);

    await page.check('input[value=layer]');
    await page.waitForFunction(() => document.querySelectorAll('#layers li').length > 0);
    await page.fill('#error', '8');
    await ready(page);
    const coarse = await counter(page, 'triangles');
    assert.match(await page.innerText('#layers'), /stand-ins|layer 0/);
    await screenshot(page, `viewer-${folder}-coarse`);
    await page.fill('#error', '0');
    await ready(page);
    const fine = await counter(page, 'triangles');
    await screenshot(page, `viewer-${folder}-fine`);
    assert.ok(coarse > 0 && fine > 4 * coarse, `${coarse} triangles at 256 pixels, ${fine} at 1`);
    assert.match(await page.innerText('#layers'), /layer 2/);
    for (const id of ['frames', 'tiles', 'bytes']) assert.ok(await counter(page, id) > 0, id);

    await pick(page);
    assert.match(await page.innerText('#building h1'), /^house_\d\d$/);
    const told = await page.innerText('#building table');
    for (const row of [/layer\s+2/, /error\s+\d+\.\d{3} m/, /source\s+houses\/house_\d\d\.obj/, /faces\s+[\d,]+/]) assert.match(told, row);
    await screenshot(page, `viewer-${folder}-picked`);
    await page.keyboard.press('Escape');
    assert.equal(await page.isVisible('#building'), false);
    assert.deepEqual(errors, []);
  });
}
