// How buildings look: in their textures, or flat facets in a colour for each feature; and dark edges between facets.
import { BufferAttribute, Color, EdgesGeometry, LineBasicMaterial, LineSegments, MeshBasicMaterial, MeshLambertMaterial } from 'three';
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
  texture: () => plain,  // of what has none
  plain: () => plain,
  layer: (row) => new Color(layerColour(row.layer)),
  building: (row) => buildingColour(row.name),
};

export function showEdges(isShown) {
  line.visible = isShown;
}

/** The light in a texture, or in colours of vertices, is its own; null: a mesh has neither. */
function lookOf({ material, geometry }) {
  const light = geometry.getAttribute('color') ?? null;
  return material.map || light ? { material: new MeshBasicMaterial({ map: material.map, vertexColors: true, polygonOffset: true, polygonOffsetFactor: 1, polygonOffsetUnits: 1 }), light } : null;
}

export const isTextured = (scene) => meshesOf(scene).some(({ userData }) => userData.look);

/** Bytes that a scene's textures take of the graphics card, with their mip chains. */
export function textureBytes(scene) {
  const images = new Set(meshesOf(scene).map(({ userData }) => userData.look?.material.map?.image).filter(Boolean));
  return [...images].reduce((sum, { width, height }) => sum + 4 * width * height * 4 / 3, 0);
}

/** Makes a loaded tile ready: its rows at hand in userData.rows, our materials, edges. */
export function dress(scene) {
  for (const mesh of meshesOf(scene)) {
    mesh.userData.rows = rowsOf(mesh);
    mesh.userData.look = lookOf(mesh);
    mesh.material = surface;
    mesh.geometry.setAttribute('color', new BufferAttribute(new Float32Array(3 * mesh.geometry.getAttribute('position').count), 3));
    const edges = new LineSegments(new EdgesGeometry(mesh.geometry, kSharp), line);
    edges.raycast = () => {};
    mesh.add(edges);
  }
}

/** Frees what dress() made; the renderer of tiles frees its own. */
export function undress(scene) {
  scene.traverse((object) => {
    if (object.isLineSegments) object.geometry.dispose();
    object.userData.look?.material.dispose();
  });
}

/** Colours by `mode` (a key of `colours`), the building named `selected` apart. */
export function paint(scene, mode, selected) {
  for (const mesh of meshesOf(scene)) {
    const { rows, look } = mesh.userData, isLook = mode === 'texture' && look;
    mesh.material = isLook ? look.material : surface;
    const ids = idsOf(mesh), attribute = mesh.geometry.getAttribute('color');
    const ofRow = rows.map((row) => (row.name === selected ? chosen : colours[mode](row)).toArray());
    for (let v = 0; v < attribute.count; ++v) {
      const isChosen = rows[ids?.getX(v)]?.name === selected;
      const own = look?.light ? [look.light.getX(v), look.light.getY(v), look.light.getZ(v)] : [1, 1, 1];
      attribute.array.set(isLook && !isChosen ? own : ofRow[ids?.getX(v)] ?? plain.toArray(), 3 * v);
    }
    attribute.needsUpdate = true;
  }
}

export function meshesOf(scene) {
  const meshes = [];
  scene.traverse((object) => { if (object.isMesh) meshes.push(object); });
  return meshes;
}
