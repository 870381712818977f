// The official readers and validators over a run of 25 buildings.
import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import fs from 'node:fs';
import path from 'node:path';
import { test } from 'node:test';
import { fileURLToPath } from 'node:url';
import draco3d from 'draco3d';
import validator from 'gltf-validator';
import { columnsOf, files, readGlb, readJson, root, tilesOf } from './outputs.mjs';

const tools = fileURLToPath(new URL('node_modules/3d-tiles-tools/build/src/cli.mjs', import.meta.url));

for (const [folder, least] of [['local', 25], ['meshopt', 25], ['plain', 25], ['textured', 6], ['textured-webp', 6]]) {
  test(`gltf-validator finds no error in any GLB (${folder})`, async () => {
    const glbs = files(path.join(root, folder), '.glb');
    assert.ok(glbs.length >= least);
    for (const file of glbs) {
      const report = await validator.validateBytes(new Uint8Array(fs.readFileSync(file)), { maxIssues: 20 });
      assert.equal(report.issues.numErrors, 0, `${file}: ${JSON.stringify(report.issues.messages)}`);
    }
  });
}

test('Draco streams decode with draco3d and match their accessors', async () => {
  const draco = await draco3d.createDecoderModule({});
  let streams = 0;
  for (const file of files(path.join(root, 'local'), '.glb')) {
    const { json, binary } = readGlb(file);
    for (const primitive of json.meshes.flatMap((m) => m.primitives)) {
      const extension = primitive.extensions?.KHR_draco_mesh_compression;
      if (!extension) continue;
      const view = json.bufferViews[extension.bufferView];
      const bytes = binary.subarray(view.byteOffset, view.byteOffset + view.byteLength);
      const buffer = new draco.DecoderBuffer();
      buffer.Init(new Int8Array(bytes), bytes.length);
      const decoder = new draco.Decoder(), mesh = new draco.Mesh();
      assert.ok(decoder.DecodeBufferToMesh(buffer, mesh).ok(), file);
      assert.equal(mesh.num_faces() * 3, json.accessors[primitive.indices].count);
      for (const [name, id] of Object.entries(extension.attributes)) {
        const accessor = json.accessors[primitive.attributes[name]];
        assert.equal(accessor.count, mesh.num_points(), `${file} ${name}`);
        const attribute = decoder.GetAttributeByUniqueId(mesh, id);
        const values = new draco.DracoFloat32Array();
        assert.ok(decoder.GetAttributeFloatForAllPoints(mesh, attribute, values));
        assert.equal(values.size(), accessor.count * (accessor.type === 'VEC3' ? 3 : 1));
        if (name !== 'POSITION') continue;
        const min = [Infinity, Infinity, Infinity], max = [-Infinity, -Infinity, -Infinity];
        for (let i = 0; i < values.size(); ++i) {
          min[i % 3] = Math.min(min[i % 3], values.GetValue(i));
          max[i % 3] = Math.max(max[i % 3], values.GetValue(i));
        }
        assert.deepEqual(min, accessor.min, file);
        assert.deepEqual(max, accessor.max, file);
      }
      ++streams;
      for (const object of [mesh, decoder, buffer]) draco.destroy(object);
    }
  }
  assert.ok(streams >= 100);
});

test('tiles refine where a pixel covers less than the g of their features', () => {
  for (const [folder, isPlanned] of [['local', true], ['earth', true], ['street', false]]) {  // the street has no plan of a scene
    const { targetSse, switching } = readJson(path.join(root, folder, 'tileset.json')).asset.extras;
    const scene = new Set(switching.layers?.map(({ gsd }) => Math.fround(gsd)));
    const seen = { standIns: 0, layers: 0 };
    for (const { tile, file } of tilesOf(path.join(root, folder))) {
      const { layer, coarsest_layer: coarsest, gsd, deviation } = columnsOf(file);
      const largest = targetSse * Math.max(...gsd);
      if (tile.children) assert.ok(tile.geometricError >= largest * (1 - 1e-6), `${file}: ${tile.geometricError}, its g asks for ${largest}`);
      else assert.deepEqual([tile.geometricError, Math.max(...gsd)], [0, 0], file);
      for (const [i, k] of layer.entries()) {
        ++seen[k < 0 ? 'standIns' : 'layers'];
        assert.ok(coarsest[i] <= k && deviation[i] >= 0, file);
        if (k >= 0) assert.ok(coarsest[i] >= 0 && scene.has(gsd[i]) === isPlanned, `${file}: g ${gsd[i]}, the scene has ${[...scene]}`);
      }
      const { layer: own, coarsestLayer } = tile.extras ?? {};
      if (own !== undefined) assert.deepEqual([own, coarsestLayer], [layer[0], coarsest[0]], file);
    }
    assert.ok(seen.standIns > 0 && seen.layers > 0, folder);
  }
});

test('a building has one g and deviation in the nodes and the table of its GLB and in the report', () => {
  const folder = path.join(root, 'local'), { buildings, switching } = readJson(path.join(folder, 'report.json'));
  for (const { name, layers } of buildings) {
    const file = path.join(folder, 'buildings', `${name}.glb`), { json } = readGlb(file), columns = columnsOf(file);
    for (const { extras } of json.nodes.filter((node) => node.extras?.layers)) {
      const told = layers[extras.layer], row = columns.layer.indexOf(extras.layer);
      assert.equal(extras.gsd, told.gsd, file);
      assert.equal(columns.gsd[row], Math.fround(told.gsd), file);
      assert.ok(extras.deviation >= told.deviation, file);
      assert.deepEqual(extras.layers, layers.map((l) => l.layer).slice(columns.coarsest_layer[row], extras.layer + 1), file);
      assert.ok(extras.layer === layers.length - 1 ? told.gsd === 0 : told.gsd === switching.layers[extras.layer].gsd, file);
    }
    assert.equal(json.nodes.filter((node) => node.extras?.layers).length, layers.filter((l) => !l.like_finer).length, file);
  }
});

test('3d-tiles-tools reads the tileset and the 3tz, and finds the same files in both', () => {
  const folder = path.join(root, 'local');
  const unpacked = path.join(root, 'from-3tz'), packed = path.join(root, 'from-folder.3tz');
  const run = (...args) => execFileSync(process.execPath, [tools, ...args], { stdio: 'pipe' });
  run('convert', '-i', path.join(folder, 'tileset.3tz'), '-o', unpacked, '-f');
  run('convert', '-i', path.join(folder, 'tileset.json'), '-o', packed, '-f');
  for (const file of files(unpacked, '').filter((name) => fs.statSync(name).isFile())) {
    const other = path.join(folder, path.relative(unpacked, file));
    assert.deepEqual(fs.readFileSync(file), fs.readFileSync(other), other);
  }
  assert.equal(files(path.join(unpacked, 'tiles'), '.glb').length, files(path.join(folder, 'tiles'), '.glb').length);
  assert.ok(fs.statSync(packed).size > 0);
});

test("colod's own checks find no fault", () => {
  for (const folder of ['local', 'meshopt', 'plain', 'earth'])
    execFileSync(process.env.COLOD, ['info', '--check', path.join(root, folder)], { stdio: 'pipe' });
});
