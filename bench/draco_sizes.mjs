#!/usr/bin/env node
// Are colod's Draco streams larger than draco_encoder's (Debian's `draco`) on the same meshes at the same bits?
//   node bench/draco_sizes.mjs OUT      OUT: a folder that colod wrote; needs build/clients (tests/clients/run)
// Every stream is decoded with draco3d and encoded again at its own bits and at compression level 7, draco_encoder's default: as an OBJ
// whose materials stand for the feature ids, so that both hold the same, and as a PLY without ids, which draco_encoder alone then lacks.
// Prints a line of JSON; fails when any stream of colod's is larger than draco_encoder's of the same content.
import { execFileSync } from 'node:child_process';
import fs from 'node:fs';
import { createRequire } from 'node:module';
import os from 'node:os';
import path from 'node:path';

const require = createRequire(path.resolve(import.meta.dirname, '../build/clients/package.json'));
const draco = await require('draco3d').createDecoderModule({});
const scratch = fs.mkdtempSync(path.join(os.tmpdir(), 'colod-draco-'));

function decode(bytes, attributes) {
  const open = (decoder) => {
    const buffer = new draco.DecoderBuffer(), mesh = new draco.Mesh();
    buffer.Init(new Int8Array(bytes), bytes.length);
    if (!decoder.DecodeBufferToMesh(buffer, mesh).ok()) throw new Error('Draco');
    draco.destroy(buffer);
    return mesh;
  };
  const decoder = new draco.Decoder(), mesh = open(decoder);
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
  const raw = new draco.Decoder(), transform = new draco.AttributeQuantizationTransform();
  raw.SkipAttributeTransform(draco.POSITION);
  const untransformed = open(raw);
  transform.InitFromAttribute(raw.GetAttributeByUniqueId(untransformed, attributes.POSITION));
  const out = { positions: read(attributes.POSITION), normals: read(attributes.NORMAL), ids: read(attributes._FEATURE_ID_0), faces,
    bits: transform.quantization_bits() };
  for (const object of [face, transform, mesh, untransformed, decoder, raw]) draco.destroy(object);
  return out;
}

/** Bytes that draco_encoder makes of a file. */
function encoded(file, bits) {
  const drc = path.join(scratch, 'x.drc');
  execFileSync('draco_encoder', ['-i', file, '-o', drc, '-qp', String(bits), '-qn', '10', '-cl', '7'], { stdio: 'pipe' });
  return fs.statSync(drc).size;
}

function writePly({ positions, normals, faces }) {
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
  const file = path.join(scratch, 'x.ply');
  fs.writeFileSync(file, Buffer.concat([Buffer.from(header), body]));
  return file;
}

function writeObj({ positions, normals, ids, faces }) {
  const lines = [];
  for (let i = 0; i < positions.length; i += 3) {
    lines.push(`v ${positions.slice(i, i + 3).join(' ')}`);
    lines.push(`vn ${normals.slice(i, i + 3).join(' ')}`);
  }
  let id;
  for (const face of faces) {
    if (ids[face[0]] !== id) lines.push(`usemtl id${id = ids[face[0]]}`);
    lines.push(`f ${face.map((v) => `${v + 1}//${v + 1}`).join(' ')}`);
  }
  const file = path.join(scratch, 'x.obj');
  fs.writeFileSync(file, lines.join('\n') + '\n');
  return file;
}

const sums = { streams: 0, colod: 0, draco_encoder: 0, larger: 0, draco_encoder_without_ids: 0, larger_than_without_ids: 0 };
for (const name of fs.readdirSync(process.argv[2], { recursive: true }).filter((file) => file.endsWith('.glb')).sort()) {
  const glb = fs.readFileSync(path.join(process.argv[2], name)), length = glb.readUInt32LE(12);
  const json = JSON.parse(glb.toString('utf8', 20, 20 + length)), binary = glb.subarray(28 + length);
  for (const primitive of json.meshes.flatMap((mesh) => mesh.primitives)) {
    const extension = primitive.extensions?.KHR_draco_mesh_compression;
    if (!extension) continue;
    const { byteOffset, byteLength } = json.bufferViews[extension.bufferView];
    const mesh = decode(binary.subarray(byteOffset, byteOffset + byteLength), extension.attributes);
    const theirs = encoded(writeObj(mesh), mesh.bits), bare = encoded(writePly(mesh), mesh.bits);
    ++sums.streams;
    sums.colod += byteLength;
    sums.draco_encoder += theirs;
    sums.larger += byteLength > theirs;
    sums.draco_encoder_without_ids += bare;
    sums.larger_than_without_ids += byteLength > bare;
  }
}
fs.rmSync(scratch, { recursive: true });
console.log(JSON.stringify(sums));
process.exitCode = sums.larger === 0 ? 0 : 1;
