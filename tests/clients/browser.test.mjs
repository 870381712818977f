// Real clients in a headless Chromium: from far to near without an error, coarser and lighter far away.
import assert from 'node:assert/strict';
import fs from 'node:fs';
import path from 'node:path';
import { after, before, test } from 'node:test';
import { launch, open as openPage, screenshot, serve } from './browser.mjs';
import { files, finestContents, readGlb, root, trianglesOf } from './outputs.mjs';

let server, browser;
before(async () => { server = await serve(); browser = await launch(); });
after(async () => { await browser?.close(); server?.close(); });

async function open(url) {
  const opened = await openPage(browser, `${server.address}/pages/${url}`);
  await opened.page.waitForFunction(() => window.client);
  return opened;
}

/** Bytes of tiles answered since `from`. */
const tileBytes = (from) => server.log.slice(from).filter(({ url }) => url.endsWith('.glb')).reduce((sum, { bytes }) => sum + bytes, 0);

async function flyIn(client, folder, name, stops = [['far', 8000], ['middle', 200], ['near', 60]]) {
  const finest = finestContents(path.join(root, folder));
  const triangles = finest.reduce((sum, file) => sum + trianglesOf(file), 0);
  const bytes = finest.reduce((sum, file) => sum + fs.statSync(file).size, 0);
  const started = server.log.length;
  const { page, errors } = await open(`${client}.html?tileset=/out/${folder}/tileset.json`);
  const seen = [];
  for (const [stop, range] of stops) {
    const counters = await page.evaluate((metres) => window.client.stop(metres), range);
    counters.bytes = tileBytes(started);
    seen.push(counters);
    await screenshot(page, `${name}-${stop}`);
    assert.ok(counters.pixels > 0, `nothing is drawn ${stop}: ${JSON.stringify(counters)}`);
  }
  const picked = await page.evaluate(() => window.client.pick());
  assert.deepEqual(await page.evaluate(() => window.client.failures), []);
  assert.deepEqual(errors, []);
  const [far, middle, near] = seen;
  console.log(name, JSON.stringify({ far, middle, near, triangles, bytes, picked }));
  assert.ok(far.triangles <= 0.05 * triangles, `far away ${far.triangles} of ${triangles} triangles`);
  assert.ok(far.bytes <= 0.05 * bytes, `far away ${far.bytes} of ${bytes} bytes`);
  assert.ok(far.triangles < middle.triangles && far.triangles < near.triangles, 'more triangles near than far');
  assert.ok(near.pixels > middle.pixels && middle.pixels > far.pixels);
  await page.close();
  return picked;
}

test('CesiumJS flies in from far to near', async () => {
  const picked = await flyIn('cesium', 'earth', 'cesium');
  assert.match(picked?.name ?? '', /^house_/);
});

test('3DTilesRendererJS flies in from far to near, and picks a building', async () => {
  const picked = await flyIn('tiles-renderer', 'local', 'tiles-renderer');
  assert.match(picked?.name ?? '', /^house_/);
});

test('CesiumJS follows external tilesets to 300 houses', async () => {  // 3DTilesRendererJS does in the viewer's test
  const picked = await flyIn('cesium', 'street', 'cesium-street', [['far', 30000], ['middle', 500], ['near', 60]]);
  assert.match(picked?.name ?? '', /^b\d+$/);
});

test('3DTilesRendererJS reads meshopt', async () => {
  const { page, errors } = await open('tiles-renderer.html?tileset=/out/meshopt/tileset.json');
  const near = await page.evaluate(() => window.client.stop(150));
  await screenshot(page, 'tiles-renderer-meshopt');
  assert.ok(near.pixels > 1000 && near.triangles > 0);
  assert.deepEqual(await page.evaluate(() => window.client.failures), []);
  assert.deepEqual(errors, []);
  await page.close();
});

test('three.js shows the finest level, once', async () => {
  const { page, errors } = await open('three.html');
  const glbs = files(path.join(root, 'local', 'buildings'), '.glb').slice(0, 3).map((file) => ['local/buildings', file]);
  glbs.push(['meshopt/buildings', files(path.join(root, 'meshopt', 'buildings'), '.glb')[0]]);
  glbs.push(['engine/engine', files(path.join(root, 'engine', 'engine'), '_LOD0.glb')[0]]);
  for (const [folder, file] of glbs) {
    const shown = await page.evaluate((url) => window.client.show(url), `/out/${folder}/${path.basename(file)}`);
    const { json } = readGlb(file);
    const mesh = json.meshes[json.nodes[0].mesh].primitives[0];
    assert.equal(shown.triangles, json.accessors[mesh.indices].count / 3);
    assert.equal(shown.calls, 1);
    assert.match(shown.names.join(), /_LOD0$/);
    assert.ok(shown.pixels > 5000);
  }
  await screenshot(page, 'three');
  assert.deepEqual(errors, []);
  await page.close();
});

test('Babylon.js loads a building progressively, coarsest first', async () => {
  const { page, errors } = await open('babylon.html');
  const file = files(path.join(root, 'local', 'buildings'), '.glb')[0];
  const started = server.log.length;
  const shown = await page.evaluate((url) => window.client.show(url), `/out/local/buildings/${path.basename(file)}`);
  await screenshot(page, 'babylon');
  const { json } = readGlb(file);
  const ranges = server.log.slice(started).filter(({ url }) => url.endsWith('.glb')).map(({ bytes }) => bytes);
  console.log('babylon', JSON.stringify(shown), ranges);
  assert.ok(shown.complete && shown.pixels > 5000, JSON.stringify(shown));
  const views = [2, 1, 0].map((lod) => json.meshes[json.nodes[lod].mesh].primitives[0].extensions.KHR_draco_mesh_compression.bufferView);
  assert.deepEqual(ranges.slice(-3), views.map((view) => json.bufferViews[view].byteLength), 'coarsest first, each by itself');
  assert.equal(shown.triangles, json.accessors[json.meshes[json.nodes[0].mesh].primitives[0].indices].count / 3);
  assert.deepEqual(errors, []);
  await page.close();
});

/**
 * Roofs are red and walls green, and not much else is drawn: at borders pixels mix, which from afar are most, and from where stand-ins
 * are shown a side has the mean of both.
 */
function assertPainted(bands, what, least = 0.8) {
  assert.ok(bands.red > least / 10 && bands.green > least / 10, `${what}: ${JSON.stringify(bands)}`);
  assert.ok(bands.red + bands.green + bands.blue > least, `${what}: ${JSON.stringify(bands)}`);
}

for (const [client, folder, stops] of [['cesium', 'textured-earth', [['far', 350], ['middle', 160], ['near', 50]]],
  ['tiles-renderer', 'textured', [['far', 350], ['middle', 160], ['near', 50]]], ['tiles-renderer', 'textured-webp', [['middle', 160], ['near', 50]]]]) {
  test(`${client} shows the colours of the source from afar and near (${folder})`, async () => {
    const { page, errors } = await open(`${client}.html?tileset=/out/${folder}/tileset.json`);
    const triangles = [];
    for (const [stop, range] of stops) {
      const shown = await page.evaluate((metres) => window.client.stop(metres), range);
      await screenshot(page, `${client}-${folder}-${stop}`);
      console.log(client, folder, stop, JSON.stringify(shown));
      assertPainted(shown.bands, stop, stop === 'far' ? 0.3 : 0.8);
      triangles.push(shown.triangles);
    }
    assert.ok(triangles.at(-1) > triangles[0], `another level near than far: ${triangles}`);
    assert.deepEqual(await page.evaluate(() => window.client.failures), []);
    assert.deepEqual(errors, []);
    await page.close();
  });
}

for (const client of ['three', 'babylon'])
  test(`${client} shows the colours of the source on every level`, async () => {
    const { page, errors } = await open(`${client}.html`);
    const engine = files(path.join(root, 'textured', 'engine'), '.glb').filter((file) => /house_00_LOD\d\.glb$/.test(file));
    assert.ok(engine.length >= 2, 'levels');
    for (const file of [...engine, files(path.join(root, 'textured', 'buildings'), '.glb')[0]]) {
      const shown = await page.evaluate((url) => window.client.show(url), `/out/${path.relative(root, file)}`);
      await screenshot(page, `${client}-textured-${path.basename(file, '.glb')}`);
      assertPainted(shown.bands, file);
    }
    assert.deepEqual(errors, []);
    await page.close();
  });
