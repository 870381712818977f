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

/** The numeric columns of a GLB's property table by name, an entry per feature. */
export function columnsOf(file) {
  const { json, binary } = readGlb(file);
  const { schema, propertyTables: [table] } = json.extensions.EXT_structural_metadata;
  const read = { INT16: [2, 'readInt16LE'], UINT32: [4, 'readUInt32LE'], FLOAT32: [4, 'readFloatLE'] };
  return Object.fromEntries(Object.entries(schema.classes[table.class].properties).filter(([, { componentType }]) => componentType).map(([name, { componentType }]) => {
    const { byteOffset = 0 } = json.bufferViews[table.properties[name].values], [size, method] = read[componentType];
    return [name, Array.from({ length: table.count }, (_, i) => binary[method](byteOffset + i * size))];
  }));
}

/** Triangles of a GLB's primitives. */
export function trianglesOf(file) {
  const { json } = readGlb(file);
  return json.meshes.flatMap((m) => m.primitives).reduce((sum, p) => sum + json.accessors[p.indices].count / 3, 0);
}

/** Tiles with a GLB, each with that file, of the tileset and those that it leads to. */
export function tilesOf(folder) {
  const found = [];
  const visit = (tile, below) => {
    const file = path.join(below, decodeURIComponent(tile.content.uri));
    if (file.endsWith('.json')) visit(readJson(file).root, path.dirname(file));
    else found.push({ tile, file });
    for (const child of tile.children ?? []) visit(child, below);
  };
  visit(readJson(path.join(folder, 'tileset.json')).root, folder);
  return found;
}

/** GLBs of the tiles that nothing refines. */
export function finestContents(folder) {
  return tilesOf(folder).filter(({ tile }) => !tile.children).map(({ file }) => file);
}
