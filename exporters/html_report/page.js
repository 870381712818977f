// What all parts of the page share: the data, elements and the way numbers are written.
const data = (id) => JSON.parse(document.getElementById(`${id}-data`).textContent);
const report = data('report'), parts = data('parts'), pictures = data('pictures');
const layerCount = report.parameters.layers;
const layers = Array.from({ length: layerCount }, (_, k) => k);

/** An element; children are elements or text, never markup. */
function make(tag, attributes = {}, ...children) {
  const element = tag.startsWith('svg:') ? document.createElementNS('http://www.w3.org/2000/svg', tag.slice(4)) : document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) {
    if (value === undefined || value === null || value === false) continue;
    if (name === 'style') for (const [key, part] of Object.entries(value)) element.style.setProperty(key, part);
    else if (name.startsWith('on')) element.addEventListener(name.slice(2), value);
    else element.setAttribute(name, value === true ? '' : value);
  }
  element.append(...children.filter((child) => child !== undefined && child !== null && child !== false));
  return element;
}

const section = (id) => document.getElementById(id);
const none = '–';
const isNumber = (x) => typeof x === 'number' && Number.isFinite(x);
const grouped = new Intl.NumberFormat('en', { maximumFractionDigits: 0 });
const whole = (x) => (isNumber(x) ? grouped.format(x) : none);
const metres = (x) => (isNumber(x) ? x.toFixed(3) : none);
const percent = (x, digits = 0) => (isNumber(x) ? `${(100 * x).toFixed(digits)} %` : none);
const count = (n, one, many = `${one}s`) => `${whole(n)} ${n === 1 ? one : many}`;

function seconds(x) {
  if (!isNumber(x)) return none;
  if (x >= 120) return `${Math.floor(x / 60)} min ${Math.round(x % 60)} s`;
  return `${x.toFixed(x < 10 ? 2 : x < 100 ? 1 : 0)} s`;
}

function bytes(x) {
  const power = x >= 2 ** 30 ? 3 : x >= 2 ** 20 ? 2 : 1;
  return `${(x / 1024 ** power).toFixed(power === 3 ? 2 : 0)} ${['', 'KiB', 'MiB', 'GiB'][power]}`;
}

/** 12,345 or 1.23 M: for large figures. */
const large = (x) => (x >= 1e9 ? `${(x / 1e9).toFixed(2)} G` : x >= 1e6 ? `${(x / 1e6).toFixed(x >= 1e7 ? 1 : 2)} M` : whole(x));

function median(values) {
  const sorted = values.filter(isNumber).sort((a, b) => a - b);
  return sorted.length ? sorted[Math.floor((sorted.length - 1) / 2)] : undefined;
}

const sum = (values) => values.reduce((total, x) => total + (x || 0), 0);

/** "layer 0 (coarsest)". */
function layerName(k) {
  const what = layerCount === 1 ? '' : k === 0 ? ' (coarsest)' : k === layerCount - 1 ? ' (finest)' : '';
  return `Layer ${k}${what}`;
}

const colorOf = (k) => parts.colors?.[k] ?? '#888';

/** What the page needs of each building, in the order of the report. */
const buildings = report.buildings.map((b, index) => {
  const own = layers.map((k) => b.layers.find((l) => l.layer === k));
  const isFailed = Boolean(b.failure) || own.some((l) => !l || l.failure);
  const isOpen = own.some((l) => l && !l.failure && !l.watertight);
  const looks = own.filter((l) => l?.looks).map((l) => l.looks);
  const points = looks.length ? Math.max(...looks.map((l) => l.points)) : undefined;
  return { ...b, index, own, isFailed, isOpen, points, size: b.faces || b.vertices, unit: b.faces ? 'faces' : 'points' };
});
