// Overview, problems, the sortable table and the pictures.

function showOverview() {
  const failed = buildings.filter((b) => b.isFailed || b.lost).length + report.failures.length;
  const total = buildings.length + report.failures.length;
  const made = buildings.flatMap((b) => b.own.filter((l) => l && !l.failure));
  const closed = made.filter((l) => l.watertight).length;
  const finest = buildings.map((b) => b.own[layerCount - 1]).filter((l) => l && !l.failure);
  const source = sum(buildings.map((b) => b.size)), fine = sum(finest.map((l) => l.faces));
  const coarse = sum(buildings.map((b) => b.own[0]?.faces));
  const errors = finest.map((l) => l.hausdorff), near = finest.map((l) => l.distance.p95);
  const figure = (label, value, note, state) => make('div', { class: 'figure' }, make('span', { class: 'label' }, label),
    make('b', { class: state }, value), make('small', {}, note));
  const units = new Set(buildings.map((b) => b.unit));
  section('overview').append(
    figure('Buildings', whole(total), failed ? `${whole(failed)} failed or lost a part` : 'all complete', failed ? 'bad' : undefined),
    figure(units.size > 1 ? 'Source faces or points' : `Source ${[...units][0] ?? 'faces'}`, large(source),
      `${whole(report.coanalysis.segments)} segments of ${whole(sum(buildings.map((b) => b.planes)))} planes`),
    figure('Faces of the finest layer', large(fine), `${percent(source ? fine / source : undefined, 1)} of the source; coarsest ${large(coarse)}`),
    figure('Watertight layers', `${whole(closed)} / ${whole(made.length)}`, `${count(layerCount, 'layer')} a building`, closed < made.length ? 'bad' : 'good'),
    figure('Error, finest layer', `${metres(median(near))} m`, `95 % of the source is nearer, median; farthest ${metres(errors.length ? Math.max(...errors) : undefined)} m`),
    figure('Run', seconds(report.totals.seconds), `${bytes(report.totals.peak_memory_bytes)} of memory at most`));
}

/** The largest share of a building's area or volume that is left out for one reason. */
const weightOf = (b) => Math.max(0, ...b.left_out.map((l) => Math.max(l.share, l.volume_share ?? 0)));

function showProblems() {
  const failures = [
    ...report.failures.map((f) => [f.source, f.message]),
    ...buildings.filter((b) => b.failure).map((b) => [b.name, b.failure]),
    ...buildings.flatMap((b) => b.own.filter((l) => l?.failure).map((l) => [`${b.name}, layer ${l.layer}`, l.failure]))];
  const losses = buildings.flatMap((b) => b.warnings.slice(0, b.heavy_warnings).map((w) => [b, w]))
    .sort(([a], [b]) => weightOf(b) - weightOf(a)).map(([b, w]) => [b.name, w]);
  const standIns = buildings.flatMap((b) => b.own.filter((l) => l?.stand_in?.failure).map((l) => [`${b.name}, layer ${l.layer}`, l.stand_in.message]));
  const warnings = [...report.coanalysis.warnings.map((w) => ['Co-analysis', w]),
    ...report.switching.warnings.map((w) => ['Switching', w]),
    ...buildings.flatMap((b) => b.warnings.slice(b.heavy_warnings).map((w) => [b.name, w]))];
  const list = (items) => make('ul', {}, ...items.map(([name, text]) =>
    make('li', {}, make('b', {}, name), text.startsWith(`${name}: `) ? text.slice(name.length) : `: ${text}`)));
  const box = section('problems');
  const openly = (items, title) => {
    if (!items.length) return;
    box.classList.add('has-failures');
    box.append(make('h2', { class: 'bad' }, title), list(items.slice(0, 200)));
    if (items.length > 200) box.append(make('p', {}, `and ${items.length - 200} more: see report.json`));
  };
  openly(failures, count(failures.length, 'failure'));
  openly([...losses, ...standIns], `${count(losses.length + standIns.length, 'loss', 'losses')}: what is left out or stands for another layer`);
  if (warnings.length) box.append(make('details', {}, make('summary', {}, count(warnings.length, 'warning')), list(warnings.slice(0, 500))));
}

const columnsOfLayer = 6;

/** What stands for g, or another measure of the difference to the finest layer, of a building's layer. */
const gsdText = (g, l) => (l.like_finer ? `as ${l.layer + 1}` : g > 0 ? metres(g) : '0');

const faultNames = { flap: 'flaps', unsupported: 'surface that no source supports', leaning: 'leaning walls', narrow: 'slivers', edges: 'edges askew', eaves: 'eaves not level', triangles: 'more triangles than the source' };
/** The verdict on a layer's looks: its points and what they are for. */
const verdictText = (l) => (l.looks.faults.length ? `${l.looks.points.toFixed(0)}: ${l.looks.faults.map((f) => faultNames[f]).join(', ')}` : 'no fault seen');

const shareText = (x) => percent(x, x < 0.001 ? 2 : 1);

/** Columns of the table: a title, a key to sort by (undefined goes last), and what stands in the cell. */
function columns() {
  const own = [
    { title: 'Building', key: (b) => b.name, cell: (b) => make('a', { href: `#b${b.index}`, title: b.source }, b.name) },
    { title: 'Source faces', key: (b) => b.size, cell: (b) => `${whole(b.size)}${b.faces ? '' : ' pts'}` },
    { title: 'Planes', key: (b) => b.planes, cell: (b) => whole(b.planes) },
    { title: 'Seg\u00adments', key: (b) => b.segments, cell: (b) => whole(b.segments) },
    { title: 'Left out', help: 'share of the source that is ground, afloat, inside or lost', key: (b) => sum(b.left_out.map((l) => l.share)),
      cell: (b) => (b.left_out.length ? shareText(sum(b.left_out.map((l) => l.share))) : none) },
    { title: 'Looks', help: 'points for what a person would not have drawn, of the worst layer; 0: nothing is seen', key: (b) => b.points,
      cell: (b) => (isNumber(b.points) ? make('span', { class: b.points >= 10 ? 'warn' : undefined }, b.points.toFixed(0)) : none) },
    { title: 'Warn\u00adings', key: (b) => b.warnings.length, cell: (b) => (b.warnings.length ? make('span', { class: 'warn' }, whole(b.warnings.length)) : '0') }];
  const ofLayer = (title, value, write, help) => (k) => ({ title, help, layer: k,
    key: (b) => (b.own[k] && !b.own[k].failure ? value(b.own[k]) : undefined),
    cell: (b) => (b.own[k] && !b.own[k].failure ? write(value(b.own[k]), b.own[k]) : none) });
  const state = (isClosed, l) => make('span', isClosed ? { class: 'good' } : { class: 'bad' },
    isClosed ? 'yes' : 'NO', l.self_intersections ? ` (${l.self_intersections} ×)` : '');
  const each = [ofLayer('Faces', (l) => l.faces, whole, 'triangles'), ofLayer('Poly\u00adgons', (l) => l.polygons, whole, 'planar facets'),
    ofLayer('Own g', (l) => l.own_gsd, gsdText, 'metres that one pixel covers, from where on the layer would do for this building'),
    ofLayer('95 % m', (l) => l.distance.p95, metres, '95 % of what was taken of the source is no farther from the layer, metres'),
    ofLayer('Error m', (l) => l.hausdorff, metres, 'largest distance from the source to the layer, metres'),
    ofLayer('Closed', (l) => Number(l.watertight), state, 'watertight; in brackets, intersecting pairs of faces')];
  return [...own, ...layers.flatMap((k) => each.map((column) => column(k)))];
}

const names = new Intl.Collator('en', { numeric: true });
function compareKeys(a, b, direction) {
  if (a === undefined || b === undefined) return (a === undefined) - (b === undefined);
  return direction * (typeof a === 'string' ? names.compare(a, b) : a - b);
}

const filters = { all: () => true, failed: (b) => b.isFailed || b.lost, warned: (b) => b.warnings.length > 0, open: (b) => b.isOpen };
const mostRows = 1000;

/** Calls `follow` with the buildings that pass the filter, in the table's order, and with how many of them are shown. */
function showTable(follow) {
  const all = columns(), body = make('tbody');
  const heads = all.map((column, i) => make('th', { scope: 'col', title: column.help,
    class: column.layer !== undefined && column.title === 'Faces' ? 'first' : undefined, onclick: () => sort(i) }, make('button', { type: 'button' }, column.title)));
  const groups = make('tr', {}, make('th', { colspan: all.length - columnsOfLayer * layerCount }),
    ...layers.map((k) => make('th', { colspan: columnsOfLayer, class: 'group', scope: 'colgroup' }, make('span', { class: 'swatch', style: { '--c': colorOf(k) } }), layerName(k))));
  const rows = [];
  let sorted = all.findIndex((column) => column.title === 'Looks'), direction = -1, limit = mostRows;
  const search = make('input', { type: 'search', placeholder: 'Filter by name', 'aria-label': 'Filter by name', oninput: () => update() });
  const filter = make('select', { 'aria-label': 'Which buildings', onchange: () => update() },
    ...[['all', 'All buildings'], ['failed', 'Failed or lost'], ['warned', 'With warnings'], ['open', 'Not watertight']]
      .map(([value, text]) => make('option', { value }, `${text} (${whole(buildings.filter(filters[value]).length)})`)));
  const more = make('button', { type: 'button', class: 'plain', hidden: true, onclick: () => { limit = Infinity; update(); } }, 'Show all');
  const shown = make('span', { class: 'soft' });

  function sort(i) {
    direction = i === sorted ? -direction : all[i].title === 'Building' ? 1 : -1;
    sorted = i;
    update();
  }
  function update() {
    heads.forEach((head, i) => (i === sorted ? head.setAttribute('aria-sort', direction > 0 ? 'ascending' : 'descending') : head.removeAttribute('aria-sort')));
    const text = search.value.toLowerCase();
    const list = buildings.filter((b) => filters[filter.value](b) && b.name.toLowerCase().includes(text));
    const { key } = all[sorted];
    list.sort((a, b) => compareKeys(key(a), key(b), direction) || a.index - b.index);
    body.replaceChildren(...list.slice(0, limit).map((b) => (rows[b.index] ??= rowOf(b, all))));
    more.hidden = list.length <= limit;
    shown.textContent = list.length < buildings.length || list.length > limit ? `${whole(Math.min(list.length, limit))} of ${whole(buildings.length)} shown` : '';
    follow(list, limit);
  }
  section('buildings').append(make('div', { class: 'tools' }, search, filter, shown, more),
    make('div', { class: 'wide', tabindex: 0 }, make('table', { id: 'table' }, make('thead', {}, groups, make('tr', {}, ...heads)), body)),
    make('p', { class: 'note' }, 'Worst looks first; click a heading to sort otherwise, plots and pictures follow. Looks: points for flaps, unsupported surface, leaning walls, slivers, edges askew, eaves that are not level, more triangles than the source. Own g: metres that one pixel covers, from where on the layer would do for this building. 95 % and error (the largest): distances in metres from the source to the layer. Layer 0 is the coarsest.'));
  update();
}

const badgeOf = (b) => (b.isFailed || b.lost ? [' ', make('span', { class: 'badge bad' }, b.isFailed ? 'failed' : b.lost_textures?.length ? 'lost a texture' : 'lost a part')] : []);

function rowOf(b, all) {
  const cells = all.slice(1).map((column) => [column, column.cell(b)]);
  const row = make('tr', { class: b.isFailed ? 'failed' : undefined }, make('th', { scope: 'row' }, all[0].cell(b), ...badgeOf(b)));
  if (b.failure) {  // the reason stands where the layers would
    row.append(...cells.filter(([c]) => c.layer === undefined).map(([, content]) => make('td', {}, content)),
      make('td', { class: 'why first', colspan: columnsOfLayer * layerCount }, b.failure));
    return row;
  }
  for (let i = 0; i < cells.length; ++i) {
    const [column, content] = cells[i], isFirst = column.layer !== undefined && column.title === 'Faces';
    const failure = isFirst && b.own[column.layer]?.failure;
    row.append(failure ? make('td', { class: 'why first', colspan: columnsOfLayer }, failure) : make('td', { class: isFirst ? 'first' : undefined }, content));
    if (failure) i += columnsOfLayer - 1;
  }
  return row;
}

/** Width in pixels, from the header of a PNG in a data address. */
function widthOf(picture) {
  const header = atob(picture.slice(picture.indexOf(',') + 1).slice(0, 32));
  return header.charCodeAt(18) * 256 + header.charCodeAt(19);
}

/** Cards are filled when they come near: a page of thousands of pictures opens at once. */
const loader = new IntersectionObserver((entries) => {
  for (const { target, isIntersecting } of entries)
    if (isIntersecting) fillCard(target);
}, { rootMargin: '1000px' });

function cardOf(b) {
  const card = make('article', { class: b.isFailed ? 'card failed' : 'card', id: `b${b.index}` },
    make('h3', {}, b.name, ...badgeOf(b),
      make('span', { class: 'soft' }, `${count(b.planes, 'plane')}, ${count(b.segments, 'segment')}`)));
  loader.observe(card);
  return card;
}

function captionOf(l) {
  const standIn = l.stand_in ? `, mesh of layer ${l.layer + 1}` : '';
  const difference = l.like_finer ? `, as layer ${l.layer + 1}` : l.own_gsd > 0 ? `, own g ${metres(l.own_gsd)} m/px` : '';
  return `${count(l.faces, 'face')}${standIn}${difference}`;
}

const reasons = { ground: 'ground', floater: 'pieces afloat', inside: 'what nobody sees from outside', lost: 'LOST' };
function leftOut(b) {
  const area = (l) => (l.area > 0 ? `${l.area.toFixed(1)} m², ` : '');
  const volume = (l) => (isNumber(l.volume) ? `; ${l.volume.toFixed(1)} m³, ${shareText(l.volume_share)} of the volume` : '');
  return b.left_out.map((l) => `${reasons[l.reason]} (${area(l)}${shareText(l.share)}${volume(l)}), up to ${l.farthest.toFixed(1)} m away`).join('; ');
}

function measuresOf(b) {
  const rows = b.own.filter((l) => l && !l.failure).map((l) => [layerCell(l.layer), gsdText(l.gsd, l), gsdText(l.own_gsd, l), gsdText(l.deviation, l),
    ...['mean', 'p95', 'p99', 'max'].map((key) => metres(l.distance[key]))]);
  return make('details', {}, make('summary', {}, 'Switching and distances'),
    make('div', { class: 'wide fit' }, table(['Layer', 'g m/px', 'own g', 'Deviation m', 'Mean m', '95 % m', '99 % m', 'Largest m'], rows)),
    make('p', { class: 'note' }, 'g: in force; own g: what this building needs by itself. Deviation: largest distance to the finest layer, both ways. The others: from what was taken of the source to the layer.'));
}

function looksOf(b) {
  const rows = b.own.filter((l) => l?.looks).map((l) => [layerCell(l.layer), verdictText(l), percent(l.looks.upright), percent(l.looks.aligned), percent(l.looks.level_eaves),
    whole(l.looks.narrow), l.looks.flaps.toFixed(1), l.looks.unsupported.toFixed(1), percent(l.looks.triangles_ratio)]);
  return make('details', {}, make('summary', {}, 'Looks'),
    make('div', { class: 'wide fit' }, table(['Layer', 'Verdict', 'Walls upright', 'Edges in the plan\u2019s directions', 'Eaves level', 'Slivers', 'Flaps m²', 'Unsupported m²', 'Triangles of the source'], rows)),
    make('p', { class: 'note' }, 'A red ring in the picture is where the heaviest fault is worst. docs/report.md says what each number is.'));
}

function fillCard(card) {
  loader.unobserve(card);
  if (card.childElementCount > 1) return;
  const b = buildings[Number(card.id.slice(1))], own = pictures[b.index] ?? [];
  const picture = (i, title, note, failure) => make('figure', {}, own[i]
    ? make('img', { src: own[i], alt: `${b.name}, ${title}`, loading: 'lazy', decoding: 'async' })
    : make('div', { class: failure ? 'none' : 'none calm' }, failure ? 'no mesh' : 'no picture'), make('figcaption', {}, make('b', {}, title), ' ', note));
  const strip = [picture(0, 'Source', `${whole(b.size)} ${b.unit}`, false),
    ...b.own.map((l, k) => picture(k + 1, `Layer ${k}`, l && !l.failure ? captionOf(l) : 'failed', !l || l.failure))];
  const shapes = 1 + b.layers.length;
  const looks = own.slice(shapes).map((_, k) => picture(shapes + k, k ? `Layer ${k - 1}` : 'Source', 'as it looks', false));
  card.append(...[b.failure, ...b.own.map((l) => l?.failure && `Layer ${l.layer}: ${l.failure}`)].filter(Boolean).map((text) => make('p', { class: 'why' }, text)),
    make('div', { class: 'strip' }, ...strip), ...looks.length ? [make('div', { class: 'strip' }, ...looks)] : []);
  if (b.lost_textures?.length) card.append(make('p', { class: 'why' }, b.lost_textures.join('; ')));
  if (b.left_out.length) card.append(make('p', { class: 'note' }, `Left out of the source: ${leftOut(b)}.`));
  if (b.own.some((l) => l?.looks)) card.append(looksOf(b));
  if (b.own.some((l) => l && !l.failure)) card.append(measuresOf(b));
  if (b.warnings.length) card.append(make('details', { class: 'warn' }, make('summary', {}, count(b.warnings.length, 'warning')), make('ul', {}, ...b.warnings.map((w) => make('li', {}, w)))));
}

/** Returns a function that shows the first `limit` of the given buildings, in their order. */
function showPictures() {
  const box = section('pictures');
  const some = pictures.flat().filter(Boolean);
  if (!some.length) {
    box.remove();
    return () => {};
  }
  const width = Math.min(320, Math.max(...some.filter((p) => p.startsWith('data:image/png')).slice(0, 20).map(widthOf)));
  const card = (layerCount + 1) * (Math.max(width, 96) + 8) + 24, withPictures = pictures.filter((own) => own.length).length;
  const cards = make('div', { class: 'cards', style: { '--columns': layerCount + 1, '--card': `${card}px`, '--tall': `${Math.round(width * 0.75) + 85}px` } });
  const swatch = (color, text) => make('span', {}, make('span', { class: 'swatch', style: { '--c': color } }), text);
  box.append(make('p', { class: 'soft' }, 'Each building through one camera, from where its source shows most. Surfaces have the colour of the layer on which their part appears; dark red: seen from behind; red ring: where the looks are worst.'),
    make('div', { class: 'legend' }, ...layers.map((k) => swatch(colorOf(k), `appears on layer ${k}`)), swatch('#bcbec0', 'of no segment (base, closures)')));
  if (withPictures < buildings.length) box.append(make('p', { class: 'note' }, `${whole(withPictures)} of ${whole(buildings.length)} buildings have pictures.`));
  box.append(cards);
  const all = [];
  addEventListener('beforeprint', () => all.forEach(fillCard));
  return (list, limit) => cards.replaceChildren(...list.slice(0, limit).map((b) => (all[b.index] ??= cardOf(b))));
}
