#!/usr/bin/env node
// Are colod's Draco streams larger than draco_encoder's (Debian's `draco`) on the same meshes at the same bits?
//   node bench/draco_sizes.mjs OUT      OUT: a folder that colod wrote; needs build/clients (tests/clients/run)
// Every stream is decoded with draco3d, written as a PLY with normals, and encoded at compression level 7, which is draco_encoder's
// default and colod's speed. colod's streams also hold the feature ids. Prints a line of JSON; fails when colod's sum is larger.
import { execFileSync } from 'node:child_process';
import fs from 'node:fs';
import { createRequire } from 'node:module';
import os from 'node:os';
import path from 'node:path';

const require = createRequire(path.resolve(import.meta.dirname, '../build/clients/package.json'));
const draco = await require('draco3d').createDecoderModule({});
const scratch = fs.mkdtempSync(path.join(os.tmpdir(), 'colod-draco-'));

function decode(bytes, attributes) {
  const buffer = new draco.DecoderBuffer(), decoder = new draco.Decoder(), mesh = new draco.Mesh();
  buffer.Init(new Int8Array(bytes), bytes.length);
  if (!decoder.DecodeBufferToMesh(buffer, mesh).ok()) throw new Error('Draco');
  const read = (id) => {
    const values = new draco.DracoFloat32Array();
    decoder.GetAttributeFloatForAllPoints(mesh, decoder.GetAttributeByUniqueId(mesh, id), values);
    return Float32Array.from({ length: values.size() }, (_, i) => values.GetValue(i));
  };
  const face = new draco.DracoInt32Array(), faces = [];
  for (let f = 0; f < mesh.num_faces(); ++f) {
    decoder.GetFaceFromMesh(mesh, f, face);
    faces.push([face.GetValue(0), face.GetValue(1), face.GetValue(2)]);
  }
  const out = { positions: read(attributes.POSITION), normals: read(attributes.NORMAL), faces };
  for (const object of [face, mesh, decoder, buffer]) draco.destroy(object);
  return out;
}

/** Bits that cover the longest side in the mesh's own power-of-two step. */
function bitsOf({ positions }) {
  let step = 1;
  while (step > 2 ** -20 && positions.some((v) => v / step !== Math.round(v / step))) step /= 2;
  let longest = 0;
  for (let k = 0; k < 3; ++k) {
    let min = Infinity, max = -Infinity;
    for (let i = k; i < positions.length; i += 3) min = Math.min(min, positions[i]), max = Math.max(max, positions[i]);
    longest = Math.max(longest, max - min);
  }
  return Math.max(8, Math.ceil(Math.log2(longest / step + 2)));
}

function encoded({ positions, normals, faces }, bits) {
  const count = positions.length / 3;
  const header = `ply\nformat binary_little_endian 1.0\nelement vertex ${count}\n${['x', 'y', 'z', 'nx', 'ny', 'nz']
    .map((name) => `property float ${name}\n`).join('')}element face ${faces.length}\nproperty list uchar int vertex_indices\nend_header\n`;
  const body = Buffer.alloc(24 * count + 13 * faces.length);
  for (let v = 0; v < count; ++v)
    for (let k = 0; k < 3; ++k) {
      body.writeFloatLE(positions[3 * v + k], 24 * v + 4 * k);
      body.writeFloatLE(normals[3 * v + k], 24 * v + 12 + 4 * k);
    }
  faces.forEach((face, f) => {
    body[24 * count + 13 * f] = 3;
    face.forEach((v, c) => body.writeInt32LE(v, 24 * count + 13 * f + 1 + 4 * c));
  });
  const ply = path.join(scratch, 'x.ply'), drc = path.join(scratch, 'x.drc');
  fs.writeFileSync(ply, Buffer.concat([Buffer.from(header), body]));
  execFileSync('draco_encoder', ['-i', ply, '-o', drc, '-qp', String(bits), '-qn', '10', '-cl', '7'], { stdio: 'pipe' });
  return fs.statSync(drc).size;
}

const sums = { streams: 0, colod: 0, draco_encoder: 0, larger: 0 };
for (const name of fs.readdirSync(process.argv[2], { recursive: true }).filter((file) => file.endsWith('.glb')).sort()) {
  const glb = fs.readFileSync(path.join(process.argv[2], name)), length = glb.readUInt32LE(12);
  const json = JSON.parse(glb.toString('utf8', 20, 20 + length)), binary = glb.subarray(28 + length);
  for (const primitive of json.meshes.flatMap((mesh) => mesh.primitives)) {
    const extension = primitive.extensions?.KHR_draco_mesh_compression;
    if (!extension) continue;
    const { byteOffset, byteLength } = json.bufferViews[extension.bufferView];
    const mesh = decode(binary.subarray(byteOffset, byteOffset + byteLength), extension.attributes);
    const theirs = encoded(mesh, bitsOf(mesh));
    ++sums.streams;
    sums.colod += byteLength;
    sums.draco_encoder += theirs;
    sums.larger += byteLength > theirs;
  }
}
fs.rmSync(scratch, { recursive: true });
console.log(JSON.stringify(sums));
process.exitCode = sums.colod <= sums.draco_encoder ? 0 : 1;
