// Gives made-up houses an image in which roofs are red, walls green and undersides blue: node paint.mjs FROM TO COUNT
import fs from 'node:fs';
import path from 'node:path';
import zlib from 'node:zlib';

const [from, to, count] = process.argv.slice(2);
const side = 48, bands = [[220, 30, 30], [30, 160, 40], [30, 40, 220]];  // a third of the rows each

/** PNG's checksum, which Node has since version 20 only. */
function crc32(bytes) {
  let crc = ~0;
  for (const byte of bytes) {
    crc ^= byte;
    for (let k = 0; k < 8; ++k) crc = crc & 1 ? (crc >>> 1) ^ 0xedb88320 : crc >>> 1;
  }
  return ~crc >>> 0;
}

/** An RGB image of bands. */
function png() {
  const rows = Buffer.concat(Array.from({ length: side }, (_, y) => Buffer.from([0, ...Array(side).fill(bands[Math.floor(3 * y / side)]).flat()])));
  const header = Buffer.alloc(13);
  header.writeUInt32BE(side, 0);
  header.writeUInt32BE(side, 4);
  header.set([8, 2, 0, 0, 0], 8);
  const chunk = (name, data) => {
    const body = Buffer.concat([Buffer.from(name), data]), framed = Buffer.alloc(body.length + 8);
    framed.writeUInt32BE(data.length, 0);
    body.copy(framed, 4);
    framed.writeUInt32BE(crc32(body), body.length + 4);
    return framed;
  };
  return Buffer.concat([Buffer.from([0x89, 0x50, 0x4e, 0x47, 0x0d, 0x0a, 0x1a, 0x0a]), chunk('IHDR', header), chunk('IDAT', zlib.deflateSync(rows)), chunk('IEND', Buffer.alloc(0))]);
}

/** Which band a face wears, by how much its normal looks up. */
function bandOf([a, b, c]) {
  const u = b.map((v, k) => v - a[k]), v = c.map((w, k) => w - a[k]);
  const cross = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]];
  const up = cross[2] / Math.hypot(...cross);
  return up > 0.2 ? 0 : up < -0.2 ? 2 : 1;
}

fs.mkdirSync(to, { recursive: true });
fs.writeFileSync(path.join(to, 'bands.png'), png());
fs.writeFileSync(path.join(to, 'bands.mtl'), 'newmtl bands\nKd 1 1 1\nmap_Kd bands.png\n');
for (const name of fs.readdirSync(from).filter((file) => file.endsWith('.obj')).sort().slice(0, Number(count))) {
  const points = [], lines = ['mtllib bands.mtl', 'usemtl bands', 'vt 0.5 0.833', 'vt 0.5 0.5', 'vt 0.5 0.167'];
  for (const line of fs.readFileSync(path.join(from, name), 'utf8').split('\n')) {
    const [key, ...rest] = line.trim().split(/\s+/);
    if (key === 'v') points.push(rest.map(Number));
    const corners = rest.map((corner) => parseInt(corner, 10));
    lines.push(key === 'f' ? `f ${corners.map((corner) => `${corner}/${bandOf(corners.slice(0, 3).map((i) => points[i - 1])) + 1}`).join(' ')}` : line);
  }
  fs.writeFileSync(path.join(to, name), lines.join('\n'));
}
