// The page of `colod view`, served by colod itself: what its settings and a click do.
import assert from 'node:assert/strict';
import { spawn } from 'node:child_process';
import path from 'node:path';
import { createInterface } from 'node:readline';
import { after, before, test } from 'node:test';
import { launch, open, screenshot } from './browser.mjs';
import { finestContents, root, trianglesOf } from './outputs.mjs';

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

/** What is told of the picked building, in metres. */
function toldMetres(page) {
  return page.evaluate(() => Object.fromEntries(['pixel', 'gsd', 'deviation'].map((key) => [key, parseFloat(document.getElementById(`row-${key}`).textContent)])));
}

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

/** Calls so far that drew on the page's canvas, counted from the first time that this is asked. */
function drawn(page) {
  return page.evaluate(() => {
    if (window.drawn !== undefined) return window.drawn;
    window.drawn = 0;
    for (const name of ['drawArrays', 'drawElements']) {
      const draw = WebGL2RenderingContext.prototype[name];
      WebGL2RenderingContext.prototype[name] = function (...a) { ++window.drawn; return draw.apply(this, a); };
    }
    return 0;
  });
}

/** Throws unless something is drawn within three minutes after `act`. */
async function draws(page, act, name) {
  const before = await drawn(page);
  await act();
  await page.waitForFunction((count) => window.drawn > count, before)
    .catch(() => { throw new Error(`${name} draws nothing`); });
}

/** Nothing is drawn for 0.7 s: throws unless that comes within a minute. */
async function idle(page) {
  for (let i = 0; i < 60; ++i) {
    const before = await drawn(page);
    await page.waitForTimeout(700);
    if (await drawn(page) === before) return;
  }
  throw new Error('the page draws on and on');
}

const scenes = {
  local: { finer: 4, place: /^local/, name: /^house_\d\d$/, source: /source\s+house_\d\d\.obj/ },
  earth: { finer: 4, place: /UTM zone 32N/, name: /^house_\d\d$/, source: /source\s+house_\d\d\.obj/ },
  street: { finer: 8, place: /touching plane/, name: /^b\d+$/, source: /source\s+b\d+\.obj/ },  // 300 houses: external tilesets
};

test('an idle page draws nothing, and draws when something changes', async (t) => {
  const { page, errors } = await view(t, 'local');
  await idle(page);
  const changes = {
    wheel: async () => { await page.mouse.move(420, 240); await page.mouse.wheel(0, -200); },
    turn: async () => { await page.mouse.move(420, 240); await page.mouse.down(); await page.mouse.move(470, 250, { steps: 3 }); await page.mouse.up(); },
    colour: () => page.check('input[value=building]'),
    edges: () => page.uncheck('#edges'),
    error: () => page.fill('#error', '1'),
    finest: () => page.check('#finest'),
    home: () => page.click('#home'),
    pick: () => pick(page),
    size: () => page.setViewportSize({ width: 700, height: 500 }),
  };
  for (const [name, act] of Object.entries(changes)) {
    await draws(page, act, name);
    await idle(page);
  }
  assert.deepEqual(errors, []);
});

for (const [folder, expected] of Object.entries(scenes)) {
  test(`the viewer shows, colours, refines and explains (${folder})`, async (t) => {
    const { page, errors } = await view(t, folder);
    assert.match(await page.innerText('#place'), expected.place);
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
    assert.ok(coarse > 0 && fine > expected.finer * coarse, `${coarse} triangles at 256 pixels, ${fine} at 1`);
    assert.match(await page.innerText('#layers'), /layer 2/);
    for (const id of ['frames', 'tiles', 'bytes']) assert.ok(await counter(page, id) > 0, id);

    await pick(page);
    assert.match(await page.innerText('#building h1'), expected.name);
    const told = await page.innerText('#building table');
    for (const row of [/layer\s+.*2/, /a pixel covers\s+\d+\.\d{3} m/, /shown from g\s+0\.000 m/, /deviation\s+0\.0\d\d m/, expected.source, /faces\s+[\d,]+/])
      assert.match(told, row);
    await screenshot(page, `viewer-${folder}-picked`);
    await page.keyboard.press('Escape');
    assert.equal(await page.isVisible('#building'), false);
    assert.deepEqual(errors, []);
  });
}

test('a picked building tells what a pixel covers, and by that its layer gives way to the finest one', async (t) => {
  const { page, errors } = await view(t, 'local');
  await pick(page);
  let before;
  for (let slider = 8, isFinest = false; !isFinest; slider -= 0.5) {
    assert.ok(slider >= 0, 'the finest layer never comes');
    await page.fill('#error', String(slider));
    await ready(page);
    const told = await toldMetres(page), times = 2 ** (4 - slider);  // 16 pixels, where the slider begins: at g
    assert.ok(told.pixel >= times * told.gsd - 0.001, `g ${told.gsd} m where a pixel covers ${told.pixel} m, slider at ${slider}`);
    isFinest = told.gsd === 0;
    if (isFinest) assert.ok(before.pixel <= 1.05 * times * before.gsd, `finer than g ${before.gsd} m where a pixel covered ${before.pixel} m, slider at ${slider}`);
    before = told;
  }
  for (const [slider, meaning] of [['8', /at 0\.063 times the measured g$/], ['4', /at the measured g$/], ['2', /at 4 times the measured g$/]]) {
    await page.fill('#error', slider);
    assert.match(await page.innerText('#meaning'), meaning);
  }
  assert.deepEqual(errors, []);
});

test('the finest layers can be shown in place, and the slider holds again after that', async (t) => {
  const { page, errors } = await view(t, 'local');
  await page.fill('#error', '8');
  await ready(page);
  const coarse = await counter(page, 'triangles');
  await page.keyboard.press('f');
  await ready(page);
  assert.equal(await counter(page, 'triangles'), finestContents(path.join(root, 'local')).reduce((sum, file) => sum + trianglesOf(file), 0));
  assert.match(await page.innerText('#meaning'), /finest/);
  await pick(page);
  const far = await toldMetres(page);
  assert.equal(far.gsd, 0);
  await page.setViewportSize({ width: 640, height: 240 });
  await page.waitForFunction((metres) => parseFloat(document.getElementById('row-pixel').textContent) > 1.5 * metres, far.pixel);
  assert.ok(Math.abs((await toldMetres(page)).pixel / far.pixel - 2) < 0.02, 'half the lines: a pixel covers twice as much');
  await page.setViewportSize({ width: 640, height: 480 });
  await page.uncheck('#finest');
  await ready(page);
  assert.equal(await counter(page, 'triangles'), coarse);
  assert.deepEqual(errors, []);
});

/** Shares of the view's pixels that have the colours which paint.mjs gave roofs and walls. */
async function bands(page) {
  const picture = (await page.screenshot({ clip: { x: 260, y: 60, width: 380, height: 360 } })).toString('base64');
  return page.evaluate(async (png) => {
    const image = await createImageBitmap(await (await fetch(`data:image/png;base64,${png}`)).blob());
    const context = new OffscreenCanvas(image.width, image.height).getContext('2d');
    context.drawImage(image, 0, 0);
    const data = context.getImageData(0, 0, image.width, image.height).data;
    const share = (rgb) => {
      let count = 0;
      for (let i = 0; i < data.length; i += 4) if (rgb.every((value, k) => Math.abs(value - data[i + k]) <= 20)) ++count;
      return count / (image.width * image.height);
    };
    return { red: share([220, 30, 30]), green: share([30, 160, 40]) };
  }, picture);
}

test('textures are shown where there are any, on every level, and their memory is told', async (t) => {
  const { page, errors } = await view(t, 'textured');
  assert.equal(await page.isChecked('input[value=texture]'), true);
  for (const slider of ['8', '4', '0']) {
    await page.fill('#error', slider);
    await ready(page);
    const { red, green } = await bands(page);
    await screenshot(page, `viewer-textured-${slider}`);
    assert.ok(red > 0.005 && green > 0.005, `slider at ${slider}: ${red} red, ${green} green`);
    assert.ok(await counter(page, 'textures') > 0 || slider === '8', 'textures are counted');
  }
  for (const mode of ['plain', 'layer', 'building']) {
    await page.check(`input[value=${mode}]`);
    await ready(page);
    const { red, green } = await bands(page);
    assert.ok(red + green < 0.002, `${mode}: ${red} red, ${green} green`);
  }
  await page.check('input[value=texture]');
  await ready(page);
  assert.ok((await bands(page)).red > 0.005);
  assert.deepEqual(errors, []);
});

test('without textures none are offered', async (t) => {
  const { page } = await view(t, 'local');
  assert.equal(await page.isVisible('#texture'), false);
  assert.equal(await page.isVisible('#texture-memory'), false);
});
