// The page of `colod view`: streams /out/tileset.json; the settings and counters are the elements of index.html.
import { BufferAttribute, CircleGeometry, Color, DirectionalLight, HemisphereLight, Mesh, MeshBasicMaterial, PerspectiveCamera,
  Raycaster, Scene, Vector2, Vector3, WebGLRenderer } from 'three';
import { OrbitControls } from 'three/addons/controls/OrbitControls.js';
import { dress, isTextured, layerColour, meshesOf, paint, showEdges, textureBytes, undress } from './paint.js';
import { idsOf, openTileset } from './tileset.js';

const $ = (id) => document.getElementById(id);
const canvas = $('scene'), settings = $('settings');
const renderer = new WebGLRenderer({ canvas, antialias: true, alpha: true });
const camera = new PerspectiveCamera(50, 1, 0.1, 1e5);
const controls = new OrbitControls(camera, canvas);
controls.maxPolarAngle = 0.495 * Math.PI;  // not below the ground
controls.zoomToCursor = true;
controls.screenSpacePanning = false;

const scene = new Scene();
const sun = new DirectionalLight('#fff4e0', 2);
sun.position.set(-0.5, 1, 0.75);
scene.add(new HemisphereLight('#eaf3ff', '#8f8a80', 1.7), sun);

let radius = 100, corners = [], targetSse = 16, selected = null, pressed = null;
let bytes = 0, frames = 0, since = performance.now();  // counters
let next = 0, calm = 0;  // the frame that is asked for; frames in which nothing has changed
let isBegun = false;  // the first tile has come
const kCalm = 3, kMargin = 1.08;

const tiles = openTileset('out/tileset.json', camera, renderer, (box, extras) => {
  radius = 0.5 * box.getSize(new Vector3()).length();
  corners = Array.from({ length: 8 }, (_, i) => new Vector3(...['x', 'y', 'z'].map((axis, k) => box[i >> k & 1 ? 'max' : 'min'][axis])));
  controls.maxDistance = 60 * radius;
  scene.add(ground(3 * radius));
  targetSse = extras.targetSse ?? targetSse;
  $('error').value = Math.log2(targetSse);
  readError();
  $('place').textContent = extras.crs ?? 'local, no place on Earth';
  home();
});
scene.add(tiles.group);
for (const event of ['needs-update', 'needs-render', 'tile-visibility-change']) tiles.addEventListener(event, wake);
controls.addEventListener('change', wake);
tiles.addEventListener('load-model', (tile) => {
  dress(tile.scene);
  isBegun = true;
  if (isTextured(tile.scene)) offerTextures();
  paint(tile.scene, settings.colour.value, selected);
});
tiles.addEventListener('dispose-model', (tile) => undress(tile.scene));
tiles.addEventListener('load-error', ({ url, error }) => {
  setState('failed');
  $('state').textContent = `${url}: ${error.message}`;
});

/** From the first tile on that has any, textures are what is shown, until the user says otherwise. */
function offerTextures() {
  if (!$('texture').hidden) return;
  $('texture').hidden = $('texture-memory').hidden = false;
  if (settings.colour.value !== 'plain') return;
  settings.colour.value = 'texture';
  $('edges').checked = false;
  showEdges(false);
  repaint();
}

/** A disc that fades into the background. */
function ground(size) {
  const disc = new CircleGeometry(size, 64).rotateX(-Math.PI / 2).translate(0, -0.02, 0);
  const { r, g, b } = new Color('#d5d6cf');
  const rgba = new Float32Array(4 * disc.getAttribute('position').count);
  for (let i = 0; i < rgba.length; i += 4) rgba.set([r, g, b, i === 0 ? 1 : 0], i);
  disc.setAttribute('color', new BufferAttribute(rgba, 4));
  const material = new MeshBasicMaterial({ vertexColors: true, transparent: true, depthWrite: false });
  return Object.assign(new Mesh(disc, material), { renderOrder: -1 });
}

/** The whole scene, as near as its box allows. */
function home() {
  const back = new Vector3(-0.55, 0.75, 1).normalize(), tan = Math.tan(0.5 * camera.fov * Math.PI / 180);
  controls.target.copy(corners[0]).lerp(corners[7], 0.5);
  camera.position.copy(controls.target).add(back);
  camera.lookAt(controls.target);
  const turn = camera.quaternion.clone().invert();
  const needed = corners.map((corner) => {
    const { x, y, z } = corner.clone().sub(controls.target).applyQuaternion(turn);
    return z + Math.max(Math.abs(y), Math.abs(x) / camera.aspect) / tan;
  });
  camera.position.copy(controls.target).addScaledVector(back, kMargin * Math.max(...needed));
  wake();
}

/** The slider is logarithmic: 1 … 256 pixels. */
function readError() {
  const pixels = 2 ** $('error').value, isFinest = $('finest').checked;
  tiles.errorTarget = isFinest ? 0 : pixels;
  $('error').disabled = isFinest;
  $('error-text').textContent = `${short(pixels)} px`;
  $('meaning').textContent = isFinest ? 'the finest layers, however far' : `layers switch at ${times(targetSse / pixels)} measured g`;
  setState('loading');
}

const times = (factor) => (factor === 1 ? 'the' : `${short(factor)} times the`);

const short = (number) => number.toLocaleString('en', { maximumSignificantDigits: 2 });

function repaint() {
  tiles.forEachLoadedModel((model) => paint(model, settings.colour.value, selected));
  showLayers();
  wake();
}

/** What stands under a pointer: a hit of the raycaster, or nothing. */
function under(event) {
  const { width, height } = canvas.getBoundingClientRect();
  const ray = new Raycaster();
  ray.firstHitOnly = true;
  ray.setFromCamera(new Vector2(2 * event.offsetX / width - 1, 1 - 2 * event.offsetY / height), camera);
  return ray.intersectObject(tiles.group, true)[0];
}

function select(name) {
  selected = name;
  repaint();
  showBuilding();
}

const meshesIn = (tile) => (tile.engineData.scene ? meshesOf(tile.engineData.scene) : []);
const rowsIn = (tile) => meshesIn(tile).flatMap((mesh) => mesh.userData.rows ?? []);
const visibleMeshes = () => [...tiles.visibleTiles].flatMap(meshesIn);
const visibleRows = () => [...tiles.visibleTiles].flatMap(rowsIn);

const layerName = (layer) => (layer < 0 ? 'stand-in' : layer === 0 ? '0 (coarsest)' : String(layer));
const layersOf = ({ coarsest_layer: from, layer: to }) => (from === to ? layerName(to) : `${layerName(from)} to ${to}, alike`);
const metres = (length) => `${length.toFixed(3)} m`;

/** Metres that one pixel covers at the nearest point of a tile's box: what decides whether the client refines it. */
function pixelAt({ traversal }) {
  return traversal.distanceFromCamera * 2 * Math.tan(0.5 * camera.fov * Math.PI / 180) / renderer.getSize(new Vector2()).y;
}

/** What is shown of the selected building now, and why. */
function showBuilding() {
  $('building').hidden = selected === null;
  const tile = [...tiles.visibleTiles].find((visible) => rowsIn(visible).some(({ name }) => name === selected));
  if (!tile) return;
  const row = rowsIn(tile).find(({ name }) => name === selected);
  $('building').querySelector('h1').textContent = row.name;
  const told = { layer: layersOf(row), pixel: metres(pixelAt(tile)), gsd: metres(row.gsd), deviation: metres(row.deviation),
    faces: row.faces.toLocaleString('en'), source: row.source };
  for (const [key, value] of Object.entries(told)) $(`row-${key}`).textContent = value;
}

/** The legend: what is shown, coarsest first. */
function showLayers() {
  const counts = new Map();
  if (settings.colour.value === 'layer')
    for (const { layer } of visibleRows()) counts.set(layer, (counts.get(layer) ?? 0) + 1);
  $('layers').replaceChildren(...[...counts].sort((a, b) => a[0] - b[0]).map(([layer, count]) => {
    const item = document.createElement('li'), swatch = document.createElement('i'), number = document.createElement('data');
    swatch.style.background = layerColour(layer);
    number.value = number.textContent = count;
    item.append(swatch, layer < 0 ? 'stand-ins' : `layer ${layerName(layer)}`, number);
    return item;
  }));
}

new PerformanceObserver((list) => {
  for (const entry of list.getEntries()) if (entry.name.includes('/out/')) bytes += entry.encodedBodySize;
  countBytes();
}).observe({ type: 'resource', buffered: true });

function count(id, value, text = value.toLocaleString('en')) {
  $(id).value = value;
  $(id).textContent = text;
}

/** Of all tiles that are loaded, shown or not. */
function countTextures() {
  let held = 0;
  tiles.forEachLoadedModel((model) => { held += textureBytes(model); });
  count('textures', held, (held / 2 ** 20).toLocaleString('en', { maximumFractionDigits: 1 }));
}

const countBytes = () => count('bytes', bytes, Math.round(bytes / 1000).toLocaleString('en'));

function countEverything() {
  const now = performance.now();
  count('frames', Math.round(1000 * frames / (now - since)));
  count('tiles', tiles.visibleTiles.size);
  count('triangles', visibleMeshes().reduce((sum, { geometry }) => sum + (geometry.index ?? geometry.getAttribute('position')).count / 3, 0));
  countBytes();
  countTextures();
  frames = 0;
  since = now;
  showLayers();
  showBuilding();
}

function setState(state) {
  if (state === 'loading') wake();
  if (state === document.body.dataset.state) return;
  document.body.dataset.state = state;
  if (state !== 'failed') $('state').textContent = state === 'loading' ? 'loading …' : '';
}

/** `ready` when something has come and nothing was left to load for some frames. */
function watch() {
  if (document.body.dataset.state === 'failed') ++calm;
  else if (!tiles.root || !isBegun || tiles.isLoading) setState('loading');
  else if (++calm === kCalm) {
    countEverything();
    setState('ready');
  }
}

/** Something changed: draws until all has been calm for some frames, and then no more. */
function wake() {
  calm = 0;
  if (next) return;
  next = requestAnimationFrame(frame);
  if (frames === 0) since = performance.now();
}

function frame() {
  next = 0;
  controls.update();
  const distance = camera.position.distanceTo(controls.target);
  camera.near = Math.max(0.05, distance / 200);
  camera.far = distance + 8 * radius;
  camera.updateProjectionMatrix();
  camera.updateMatrixWorld();
  tiles.update();
  renderer.render(scene, camera);
  ++frames;
  watch();
  if (performance.now() > since + 500) countEverything();
  if (calm < kCalm) next ||= requestAnimationFrame(frame);
}

new ResizeObserver(() => {
  renderer.setPixelRatio(Math.min(devicePixelRatio, 2));
  renderer.setSize(innerWidth, innerHeight, false);
  camera.aspect = innerWidth / innerHeight;
  tiles.setResolutionFromRenderer(camera, renderer);
  wake();
}).observe(canvas);
canvas.addEventListener('webglcontextrestored', wake);

canvas.addEventListener('pointerdown', (event) => { pressed = event; });
canvas.addEventListener('pointerup', (event) => {
  const isClick = pressed && event.button === 0 && Math.hypot(event.x - pressed.x, event.y - pressed.y) < 5;
  if (!isClick) return;
  const hit = under(event);
  select(hit?.object.userData.rows[idsOf(hit.object)?.getX(hit.face.a)]?.name ?? null);
});
canvas.addEventListener('dblclick', (event) => {
  const hit = under(event);
  if (!hit) return;
  camera.position.lerp(hit.point, 0.6);
  controls.target.copy(hit.point);
  wake();
});
addEventListener('keydown', ({ key, repeat, ctrlKey, metaKey }) => {
  if (key === 'Escape') select(null);
  if (key === 'f' && !repeat && !ctrlKey && !metaKey) $('finest').click();
});
settings.addEventListener('submit', (event) => event.preventDefault());
for (const choice of settings.colour) choice.addEventListener('input', repaint);
$('edges').addEventListener('input', () => { showEdges($('edges').checked); wake(); });
$('error').addEventListener('input', readError);
$('finest').addEventListener('input', readError);
$('home').addEventListener('click', home);
$('close').addEventListener('click', () => select(null));
wake();
