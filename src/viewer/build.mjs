// Bundles the page into a folder: node build.mjs FOLDER. CMake's target `viewer` calls this in a copy of this folder,
// beside the packages that npm has put there.
import fs from 'node:fs';
import path from 'node:path';
import { build } from 'esbuild';

const [out] = process.argv.slice(2);
if (!out) throw new Error('usage: node build.mjs FOLDER');
const draco = 'node_modules/three/examples/jsm/libs/draco/gltf';

fs.rmSync(out, { recursive: true, force: true });
await build({ entryPoints: ['viewer.js', 'viewer.css'], bundle: true, minify: true, format: 'esm', target: 'es2022',
  legalComments: 'eof', outdir: out, logLevel: 'warning' });
fs.mkdirSync(path.join(out, 'draco'));
for (const file of ['draco_wasm_wrapper.js', 'draco_decoder.wasm']) fs.copyFileSync(path.join(draco, file), path.join(out, 'draco', file));
const licences = ['three', '3d-tiles-renderer'].map((name) =>
  `${name}\n\n${fs.readFileSync(path.join('node_modules', name, 'LICENSE'), 'utf8')}`);
fs.writeFileSync(path.join(out, 'licences.txt'),
  `${licences.join('\n\n')}\n\ndraco/: Google's Draco decoder, under the Apache License 2.0 above\n`);
fs.copyFileSync('index.html', path.join(out, 'index.html'));  // last: `colod view` takes it for the sign that all is there
