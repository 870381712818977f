// The co-analysis, time and parameters.

const statusText = { optimal: 'proven optimal', gap: 'best found, with a proven bound', empty: 'no segments' };

/** Dark to light: low to high similarity. */
const ramp = [[48, 18, 84], [50, 70, 140], [34, 120, 142], [38, 168, 128], [122, 209, 81], [253, 231, 37]];
function rampAt(t) {
  const at = Math.min(Math.max(t, 0), 1) * (ramp.length - 1), i = Math.min(Math.floor(at), ramp.length - 2);
  return ramp[i].map((c, k) => Math.round(c + (at - i) * (ramp[i + 1][k] - c)));
}
const rgb = (color) => `rgb(${color.join(' ')})`;

/** The symmetric matrix of bytes that the rows from the diagonal on hold. */
function unpack({ layer, values }) {
  const text = atob(values), n = layer.length, matrix = new Uint8Array(n * n);
  for (let i = 0, at = 0; i < n; ++i)
    for (let j = i; j < n; ++j, ++at) matrix[i * n + j] = matrix[j * n + i] = text.charCodeAt(at);
  return matrix;
}

function showMatrix(similarity) {
  const n = similarity.layer.length, matrix = unpack(similarity);
  const canvas = make('canvas', { width: n, height: n, id: 'matrix', role: 'img', 'aria-label': `Similarity of ${n} segments` });
  const context = canvas.getContext('2d'), image = context.createImageData(n, n);
  const table = Array.from({ length: 256 }, (_, v) => rampAt(v / 255));
  for (let i = 0; i < n * n; ++i) image.data.set([...table[matrix[i]], 255], 4 * i);
  context.putImageData(image, 0, 0);
  const stops = (direction) => {
    const steps = [];
    similarity.layer.forEach((k, i) => {
      if (i === 0 || k !== similarity.layer[i - 1]) steps.push(`${colorOf(k)} ${(100 * i) / n}%`);
      if (i === n - 1 || k !== similarity.layer[i + 1]) steps.push(`${colorOf(k)} ${(100 * (i + 1)) / n}%`);
    });
    return `linear-gradient(to ${direction}, ${steps.join(', ')})`;
  };
  const reading = make('p', { class: 'reading' }, 'Point at the matrix to read it.');
  const nameOf = (i) => `${buildings[similarity.building[i]]?.name}, segment ${similarity.segment[i]} (layer ${similarity.layer[i]}, extent ${similarity.extent[i]?.toFixed(2)} m)`;
  canvas.addEventListener('pointermove', (event) => {
    const area = canvas.getBoundingClientRect();
    const j = Math.min(n - 1, Math.max(0, Math.floor(((event.clientX - area.left) / area.width) * n)));
    const i = Math.min(n - 1, Math.max(0, Math.floor(((event.clientY - area.top) / area.height) * n)));
    reading.replaceChildren(make('b', {}, (matrix[i * n + j] / 255).toFixed(2)), ` between ${nameOf(i)} and ${nameOf(j)}`);
  });
  const total = report.coanalysis.segments;
  return make('div', {}, make('h3', {}, 'Similarity of segments'),
    make('p', { class: 'note' }, `${n < total ? `${whole(n)} of ${whole(total)} segments, evenly picked` : `All ${count(n, 'segment')}`}, in the order of layers (the strips at the sides) and there of falling extent. 1: the same shape and size.`),
    make('div', { class: 'matrix' }, make('span'), make('span', { style: { background: stops('right') } }), make('span', { style: { background: stops('bottom') } }), canvas),
    make('div', { class: 'scale' }, '0', make('span', { class: 'ramp', style: { background: `linear-gradient(to right, ${ramp.map(rgb).join(', ')})` } }), '1'), reading);
}

const table = (heads, rows) => make('table', {}, make('thead', {}, make('tr', {}, ...heads.map((h) => make('th', { scope: 'col' }, h)))),
  make('tbody', {}, ...rows.map((row) => make('tr', {}, ...row.map((cell, i) => (i === 0 ? make('th', { scope: 'row' }, cell) : make('td', {}, cell)))))));
const layerCell = (k) => make('span', {}, make('span', { class: 'swatch', style: { '--c': colorOf(k) } }), layerName(k));

function showClusters() {
  const box = make('div', {}, make('h3', {}, 'Clusters'), table(['Layer', 'Segments', 'Buildings', 'Flat', 'Extent', 'Area'],
    parts.clusters.map((c) => [layerCell(c.layer), whole(c.segments), whole(c.buildings), whole(c.flat), `${c.extent.toFixed(2)} m`, `${large(c.area)} m²`])),
    make('p', { class: 'note' }, 'Layer 0 is chosen by the binary program, each further layer is a cluster. Buildings: that have such segments; how many each, the last plot above shows. Flat: of one plane. Extent: standard deviation along the longest axis, median.'));
  if (parts.between) {
    const cell = (v) => make('span', {}, isNumber(v) ? v.toFixed(2) : none);
    box.append(make('h3', {}, 'Mean similarity between layers'), table(['', ...layers.map((k) => `Layer ${k}`)], parts.between.map((row, k) => [layerCell(k), ...row.map(cell)])));
  }
  return box;
}

function showConsistency(types) {
  const rows = Object.entries(types).map(([type, t]) => [type, whole(t.seen), whole(t.unseen), whole(t.never), ...layers.map((k) => whole(t.first[k])),
    t.majority_layer < 0 ? none : `Layer ${t.majority_layer}`, percent(t.on_majority_layer), percent(t.of_appearing), percent(t.on_expected_layer), whole(t.buildings), percent(t.buildings_agreeing)]);
  return make('div', { id: 'consistency' }, make('h3', {}, 'Consistency against the ground truth'),
    make('p', { class: 'note' }, 'Parts of each kind by the layer on which they appear first. Shares are of the parts that the source shows; agreeing: buildings all of whose parts lie on the majority layer.'),
    make('div', { class: 'wide' }, table(['Part', 'Seen', 'Unseen', 'Never', ...layers.map((k) => `First on ${k}`), 'Majority', 'On majority', 'Of appearing', 'On expected', 'Buildings', 'Agreeing'], rows)));
}

function showCoanalysis() {
  const c = report.coanalysis, box = section('coanalysis'), digits = (x) => (isNumber(x) ? String(Number(x.toPrecision(6))) : none);
  const facts = [['Segments', `${whole(c.segments)} in ${count(c.buildings, 'building')}`], ['Objective of layer 0', digits(c.objective)], ['Proven upper bound', digits(c.bound)],
    ['Gap', percent(c.gap, 3)], ['Status', `${c.status}: ${statusText[c.status] ?? ''}`], ['Layers from', report.buildings.some((b) => b.prior) ? 'the prior that was given' : 'this scene'], ['Time', seconds(c.seconds)]];
  const left = make('div', {}, make('dl', { class: 'facts' }, ...facts.flatMap(([name, value]) => [make('dt', {}, name), make('dd', {}, value)])));
  if (parts.clusters) left.append(showClusters());
  box.append(make('div', { class: 'columns' }, left, parts.similarity && showMatrix(parts.similarity)));
  if (report.consistency) box.append(showConsistency(report.consistency));
}

const stages = { read: 'Reading', planes: 'Planes', visibility: 'Visibility', segments: 'Segments', similarity: 'Descriptors', extraction: 'Extraction', measure: 'Measuring', pictures: 'Pictures', export: 'Export' };

function showTime() {
  let rows = Object.entries(stages).map(([key, title]) => {
    const own = buildings.map((b) => b.timings[key] ?? 0), slowest = own.indexOf(Math.max(...own));
    return { title, total: sum(own), middle: median(own), slowest: own[slowest] > 0 ? `${seconds(own[slowest])} (${buildings[slowest].name})` : none };
  });
  rows.push({ title: 'Co-analysis', total: report.coanalysis.seconds ?? 0, slowest: none });
  rows = rows.filter((r) => r.total > 0);
  const total = sum(rows.map((r) => r.total)), most = Math.max(...rows.map((r) => r.total), 1e-9), t = report.totals;
  const line = (r) => make('tr', {}, make('th', { scope: 'row' }, r.title), make('td', {}, seconds(r.total)), make('td', {}, percent(total ? r.total / total : undefined, 1)),
    make('td', { class: 'long' }, make('span', { class: 'bar', style: { width: `${(100 * r.total) / most}%` } })), make('td', {}, r.middle === undefined ? none : seconds(r.middle)), make('td', {}, r.slowest));
  section('time').append(make('p', {}, `The run took ${seconds(t.seconds)} and ${bytes(t.peak_memory_bytes)} of memory at most.`,
    t.rays > 0 && ` ${large(t.rays)} visibility rays${t.rays_per_second > 0 ? `, ${large(t.rays_per_second)} a second` : ''}.`),
    make('div', { class: 'wide' }, make('table', {}, make('thead', {}, make('tr', {}, ...['Stage', 'All buildings', 'Share', '', 'Median building', 'Slowest building'].map((h) => make('th', { scope: 'col' }, h)))), make('tbody', {}, ...rows.map(line)))),
    make('p', { class: 'note' }, 'Wall clock of each building, added up: with several threads buildings overlap, so this is more than the run took. Stages that ran before, into a scene file, are not here.'));
}

const units = { 'alcove-area': ' m²', distance: ' m', angle: '°' };

function showParameters() {
  section('parameters').append(make('dl', { class: 'facts' }, ...Object.entries(report.parameters).flatMap(([name, value]) => [make('dt', {}, name), make('dd', {}, `${value}${units[name] ?? ''}`)])));
  document.querySelector('footer').append(`colod ${report.colod}. The figures are those of report.json beside this page, rounded. Lengths in metres, areas in square metres; layer 0 is the coarsest.`);
}
