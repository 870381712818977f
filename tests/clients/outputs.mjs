// What the tests look at: folders that `run` made, and small readers of their files.
import fs from 'node:fs';
import path from 'node:path';

export const root = process.env.COLOD_CLIENTS_DATA;
if (!root) throw new Error('COLOD_CLIENTS_DATA is not set: start tests/clients/run');

/** All files below a folder with this ending, sorted. */
export function files(folder, ending) {
  return fs.readdirSync(folder, { recursive: true }).filter((name) => name.endsWith(ending)).sort()
    .map((name) => path.join(folder, name));
}

export function readJson(file) {
  return JSON.parse(fs.readFileSync(file, 'utf8'));
}

/** JSON and BIN chunk of a GLB. */
export function readGlb(file) {
  const bytes = fs.readFileSync(file);
  const length = bytes.readUInt32LE(12);
  return { json: JSON.parse(bytes.toString('utf8', 20, 20 + length)), binary: bytes.subarray(28 + length) };
}

/** Triangles of a GLB's primitives. */
export function trianglesOf(file) {
  const { json } = readGlb(file);
  return json.meshes.flatMap((m) => m.primitives).reduce((sum, p) => sum + json.accessors[p.indices].count / 3, 0);
}

/** GLBs of the tiles that nothing refines, by the tileset that names them and those that it leads to. */
export function finestContents(folder) {
  const found = [];
  const visit = (tile, below) => {
    const content = path.join(below, decodeURIComponent(tile.content.uri));
    if (content.endsWith('.json')) visit(readJson(content).root, path.dirname(content));
    else if (!tile.children) found.push(content);
    for (const child of tile.children ?? []) visit(child, below);
  };
  visit(readJson(path.join(folder, 'tileset.json')).root, folder);
  return found;
}
