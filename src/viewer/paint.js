// How buildings look: flat facets in a colour for each feature, and dark edges between facets.
import { BufferAttribute, Color, EdgesGeometry, LineBasicMaterial, LineSegments, MeshLambertMaterial } from 'three';
import { idsOf, rowsOf } from './tileset.js';

const surface = new MeshLambertMaterial({ vertexColors: true, polygonOffset: true, polygonOffsetFactor: 1, polygonOffsetUnits: 1 });
const line = new LineBasicMaterial({ color: '#1d2733', transparent: true, opacity: 0.5 });
const plain = new Color('#ece7dd'), chosen = new Color('#ffb020');
const kSharp = 15;  // degrees between facets from where on their edge is drawn
const layerColours = ['#4e79a7', '#59a14f', '#f28e2b', '#e15759', '#b07aa1', '#76b7b2', '#edc948', '#9c755f'];

/** CSS colour of a layer; −1 is a stand-in. */
export function layerColour(layer) {
  return layerColours[layer] ?? '#b7bec6';
}

/** The same hue for a name on all levels. */
function buildingColour(name) {
  let hash = 2166136261;
  for (const character of name) hash = Math.imul(hash ^ character.codePointAt(0), 16777619) >>> 0;
  return new Color().setHSL((hash % 360) / 360, 0.5, 0.57);
}

const colours = {
  plain: () => plain,
  layer: (row) => new Color(layerColour(row.layer)),
  building: (row) => buildingColour(row.name),
};

export function showEdges(isShown) {
  line.visible = isShown;
}

/** Makes a loaded tile ready: its rows at hand in userData.rows, our materials, edges. */
export function dress(scene) {
  for (const mesh of meshesOf(scene)) {
    mesh.userData.rows = rowsOf(mesh);
    mesh.material = surface;
    mesh.geometry.setAttribute('color', new BufferAttribute(new Float32Array(3 * mesh.geometry.getAttribute('position').count), 3));
    const edges = new LineSegments(new EdgesGeometry(mesh.geometry, kSharp), line);
    edges.raycast = () => {};
    mesh.add(edges);
  }
}

/** Frees what dress() made; the renderer of tiles frees its own. */
export function undress(scene) {
  scene.traverse((object) => { if (object.isLineSegments) object.geometry.dispose(); });
}

/** Colours by `mode` (a key of `colours`), the building named `selected` apart. */
export function paint(scene, mode, selected) {
  for (const mesh of meshesOf(scene)) {
    const { rows } = mesh.userData, ids = idsOf(mesh), attribute = mesh.geometry.getAttribute('color');
    const ofRow = rows.map((row) => (row.name === selected ? chosen : colours[mode](row)).toArray());
    for (let v = 0; v < attribute.count; ++v) attribute.array.set(ofRow[ids?.getX(v)] ?? plain.toArray(), 3 * v);
    attribute.needsUpdate = true;
  }
}

export function meshesOf(scene) {
  const meshes = [];
  scene.traverse((object) => { if (object.isMesh) meshes.push(object); });
  return meshes;
}
