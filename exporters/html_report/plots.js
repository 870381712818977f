// Plots over the buildings, in the table's order: faces, error and segments of each layer. What all plots share.

/** Ticks of a linear axis from 0 on. */
function linearTicks(max, wanted = 5) {
  const raw = max / wanted, power = 10 ** Math.floor(Math.log10(raw));
  const step = Math.max(1, [1, 2, 5, 10].find((f) => f * power >= raw) * power);
  return Array.from({ length: Math.floor(max / step) + 1 }, (_, i) => i * step);
}

function linearScale(values, write = whole) {
  const max = Math.max(1, ...values) * 1.05;
  return { at: (v) => v / max, ticks: linearTicks(max), write };
}

/** Decades around the values, which are no less than `least`. */
function logScale(values, least, write) {
  const positive = values.filter((v) => v > 0).map((v) => Math.max(v, least));
  const low = Math.floor(Math.log10(Math.min(...positive, 1e9))), high = Math.ceil(Math.log10(Math.max(...positive, least * 10)));
  const from = positive.length ? Math.min(low, high - 1) : 0, to = positive.length ? Math.max(high, from + 1) : 1;
  const ticks = Array.from({ length: to - from + 1 }, (_, i) => 10 ** (from + i));
  const minor = ticks.slice(0, -1).flatMap((t) => [2, 3, 4, 5, 6, 7, 8, 9].map((f) => f * t));
  return { at: (v) => (Math.log10(Math.max(v, least, 10 ** from)) - from) / (to - from), from: (part) => 10 ** (from + part * (to - from)), ticks, minor, write };
}

const margin = { left: 82, right: 14, top: 12 };
const text = (content, attributes) => make('svg:text', attributes, content);

/** Lines and figures of the vertical axis of `plot`, and both axes from `top` to `base` and to `right`. */
function axes(plot, y, top, base, right) {
  const lines = plot.scale.ticks.flatMap((t) => [make('svg:path', { class: 'grid', d: `M${margin.left} ${y(t)}H${right}` }),
    text(plot.scale.write(t), { x: margin.left - 8, y: y(t) + 4, 'text-anchor': 'end' })]);
  const small = (plot.scale.minor ?? []).map((t) => `M${margin.left - 3} ${y(t)}h3`).join('');
  return [...lines, make('svg:path', { class: 'axis', d: `M${margin.left} ${top}V${base}H${right}${small}` }),
    text(plot.yTitle, { transform: `translate(14 ${(base + top) / 2}) rotate(-90)`, 'text-anchor': 'middle' })];
}

/** A tip that follows the pointer: `tell(x)` gives where its line stands, a title and lines of text, or nothing. */
function tipOf(svg, top, base, tell) {
  const pointer = make('svg:path', { class: 'at' }), tip = make('div', { class: 'tip', hidden: true });
  svg.append(pointer);
  svg.addEventListener('pointermove', (event) => {
    const area = svg.getBoundingClientRect(), at = event.clientX - area.left, told = tell(at);
    tip.hidden = !told;
    pointer.setAttribute('d', told ? `M${told.x} ${top}V${base}` : '');
    if (!told) return;
    tip.replaceChildren(make('b', {}, told.title), ...told.lines.map((line) => make('div', {}, line)));
    tip.style.left = at < area.width / 2 ? `${at + 14}px` : 'auto';
    tip.style.right = at < area.width / 2 ? 'auto' : `${area.width - at + 14}px`;
  });
  svg.addEventListener('pointerleave', () => { tip.hidden = true; pointer.setAttribute('d', ''); });
  return tip;
}

/** Draws `frames` with `draw(width)` now and whenever their width changes; returns a function that draws again. */
function drawInto(frames, draw) {
  let width = 0;
  const again = () => { width = frames[0].clientWidth; draw(Math.max(280, width)); };
  new ResizeObserver(() => { if (frames[0].clientWidth !== width) again(); }).observe(frames[0]);
  return again;
}

/** Axes with what `plot` says: title, yTitle, scale, `draw(x, y, step)` for the marks, `tell(building)` for the pointer. */
function drawPlot(box, width, list, plot) {
  const isNamed = list.length <= 40 && width / Math.max(1, list.length) >= 16;
  const shorten = (name) => (name.length > 16 ? `${name.slice(0, 15)}…` : name);
  const longest = Math.max(0, ...list.map((b) => shorten(b.name).length));
  const bottom = isNamed ? 36 + 4.6 * longest : 40, height = 230 + bottom;
  const right = width - margin.right, base = height - bottom, step = (right - margin.left) / Math.max(1, list.length);
  const x = (i) => margin.left + (i + 0.5) * step, y = (v) => base - plot.scale.at(v) * (base - margin.top);
  const svg = make('svg:svg', { viewBox: `0 0 ${width} ${height}`, height, role: 'img', 'aria-label': `${plot.title}, ${plot.yTitle}` });
  svg.append(...axes(plot, y, margin.top, base, right));
  const [every] = [1, 2, 5, 10, 20, 50, 100, 200, 500, 1000, 2000, 5000, 1e4].filter((n) => list.length / n <= width / 60);
  list.forEach((b, i) => {
    if (isNamed) {
      svg.append(text(shorten(b.name), { transform: `translate(${x(i) + 4} ${base + 12}) rotate(-40)`, 'text-anchor': 'end' }));
    } else if ((i + 1) % every === 0 || (i === 0 && every > 1)) {
      svg.append(make('svg:path', { class: 'axis', d: `M${x(i)} ${base}v4` }), text(String(i + 1), { x: x(i), y: base + 17, 'text-anchor': 'middle' }));
    }
  });
  svg.append(text(isNamed ? 'Building' : "Building, by its place in the table's order", { x: (margin.left + right) / 2, y: height - 4, 'text-anchor': 'middle' }));
  svg.append(...plot.draw(x, y, step));
  const tip = tipOf(svg, margin.top, base, (at) => {
    const i = Math.floor((at - margin.left) / step), b = list[i];
    return b && { x: x(i), title: b.name, lines: plot.tell(b) };
  });
  box.replaceChildren(make('h3', {}, plot.title), svg, tip);
}

/** A dot a building and series, and a line from its least to its greatest. */
function dots(list, series, failed) {
  return (x, y, step) => {
    const size = Math.min(8, Math.max(2.5, step * 0.7)), marks = [];
    const range = list.map((b, i) => {
      const values = series.map((s) => s.value(b)).filter(isNumber);
      return values.length > 1 ? `M${x(i)} ${y(Math.min(...values))}V${y(Math.max(...values))}` : '';
    });
    if (step > 4) marks.push(make('svg:path', { class: 'range', d: range.join('') }));
    const aside = Math.min(size * 0.8, step / (layerCount + 1));  // equal values stay apart
    for (const s of series) {
      const shift = s.layer === undefined ? 0 : (s.layer - (layerCount - 1) / 2) * aside;
      const points = list.map((b, i) => (isNumber(s.value(b)) ? `M${(x(i) + shift).toFixed(1)} ${y(s.value(b)).toFixed(1)}h0` : '')).join('');
      marks.push(make('svg:path', { class: 'series', d: points, 'stroke-width': size, style: { '--c': s.color } }));
    }
    const crosses = list.map((b, i) => (failed(b) ? `M${x(i) - 3} ${margin.top + 1}l6 6m0 -6l-6 6` : '')).join('');
    return [...marks, make('svg:path', { class: 'failure', d: crosses })];
  };
}

/** Bars of segments, the coarsest layer at the bottom. */
function stacks(list) {
  return (x, y, step) => layers.map((k) => {
    const w = Math.max(0.8, Math.min(40, step * 0.8));
    const d = list.map((b) => {
      const members = parts.members?.[b.index] ?? [], low = sum(members.slice(0, k));
      return members[k] ? [low, low + members[k]] : undefined;
    }).map((bar, i) => (bar ? `M${(x(i) - w / 2).toFixed(1)} ${y(bar[0]).toFixed(1)}h${w.toFixed(1)}V${y(bar[1]).toFixed(1)}h${(-w).toFixed(1)}z` : '')).join('');
    return make('svg:path', { class: 'series bars', d, style: { '--c': colorOf(k) } });
  });
}

/** Returns a function that draws the given buildings, in their order. */
function showPlots() {
  const box = section('plots');
  const ofLayer = (pick) => layers.map((k) => ({ layer: k, color: colorOf(k), name: `layer ${k}`,
    value: (b) => (b.own[k] && !b.own[k].failure ? pick(b.own[k]) : undefined) }));
  const source = { color: '#7b8694', name: 'source', value: (b) => b.faces || undefined };
  const faces = [source, ...ofLayer((l) => l.faces)], errors = ofLayer((l) => l.hausdorff), means = ofLayer((l) => l.mean_distance);
  const told = (series, write) => (b) => series.map((s) => `${s.name}: ${write(s.value(b))}`);
  const all = (series) => buildings.flatMap((b) => series.map((s) => s.value(b))).filter(isNumber);
  const inMetres = (v) => (v <= 0.001 ? '≤ 0.001' : String(Number(v.toPrecision(2))));
  const failed = (b) => b.isFailed;
  const plots = [
    { title: 'Faces', yTitle: 'triangles (log scale)', scale: logScale(all(faces), 1, whole), series: faces, tell: told(faces, whole) },
    { title: 'Error', yTitle: 'largest distance, m (log)', scale: logScale(all(errors), 0.001, inMetres), series: errors, tell: told(errors, (v) => `${metres(v)} m`) },
    { title: 'Mean distance', yTitle: 'mean distance, m (log)', scale: logScale(all(means), 0.001, inMetres), series: means, tell: told(means, (v) => `${metres(v)} m`) },
    { title: 'Segments', yTitle: 'segments', scale: linearScale(buildings.map((b) => b.segments)),
      tell: (b) => layers.map((k) => `layer ${k}: ${whole(parts.members?.[b.index]?.[k])}`) }];
  box.append(make('p', { class: 'soft' }, 'Buildings in the order of the table. Error: largest distance from the source to the layer. Red crosses: failed.'),
    make('div', { class: 'legend' }, make('span', { class: 'series', style: { '--c': source.color } }, 'source'),
      ...layers.map((k) => make('span', { class: 'series', style: { '--c': colorOf(k) } }, layerName(k)))));
  const frames = plots.map(() => make('div', { class: 'plot' }));
  box.append(...frames);
  let list = buildings;
  const draw = drawInto(frames, (width) => plots.forEach((plot, i) =>
    drawPlot(frames[i], width, list, { ...plot, draw: plot.series ? dots(list, plot.series, failed) : stacks(list) })));
  return (shown) => { list = shown; draw(); };
}
