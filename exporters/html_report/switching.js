// When layers switch: g of the scene, what it means for its buildings, and what is drawn at a distance.

const switching = report.switching;
const distanceOf = (gsd) => gsd * switching.viewport_height / (2 * Math.tan(switching.fov_y_deg * Math.PI / 360));
const rounded = (x) => x.toLocaleString('en', { maximumSignificantDigits: 3 });

/** The finest layer that layer k is alike in every building. */
const switchesAs = (k) => (k + 1 < layerCount && switching.layers[k].buildings === 0 ? switchesAs(k + 1) : k);

function aboutSwitching() {
  const { measure, scope, visual_error, pixel_error, share, from_prior } = switching;
  const n = rounded(visual_error);
  const visual = `its picture differs from the finest layer's in pieces of at most ${n} × ${n} pixels and in outlines by at most ${rounded(visual_error / 2)}`;
  const strict = `it is at most ${rounded(pixel_error)} pixels off the finest layer`;
  const origin = from_prior ? 'g comes from the prior that was given.' : `It is at least what ${percent(share)} of the buildings need by themselves.`;
  return [`A layer may be shown where one pixel covers at least g metres: from there on ${measure === 'visual' ? visual : strict}.`,
    scope === 'scene' ? `All buildings share one g a layer. ${origin}` : 'Each building switches by its own g; the table says what one g for all would be.'].join(' ');
}

function showSwitchTable() {
  const off = (share, factor) => (share > 0 ? `${percent(share, share < 0.1 ? 1 : 0)}, up to ${rounded(factor)} ×` : '0 %');
  const rows = switching.layers.toReversed().map((l) => {
    const alike = switchesAs(l.layer);
    if (alike !== l.layer) return [layerCell(l.layer), `as layer ${alike}`, `as layer ${alike}`, none, none, none];
    if (l.gsd === 0) return [layerCell(l.layer), '0', 'near', none, none, none];
    return [layerCell(l.layer), metres(l.gsd), `from ${rounded(l.switch_distance)} m`, whole(l.buildings),
      off(l.too_coarse, l.too_coarse_factor), off(l.too_fine, l.too_fine_factor)];
  });
  return [make('div', { class: 'wide fit' }, table(['Layer', 'g, m/px', 'Shown', 'Buildings', 'Too coarse', 'Too fine'], rows)),
    make('p', { class: 'note' }, `Distances hold at ${whole(switching.viewport_height)} lines and ${rounded(switching.fov_y_deg)}°. Buildings: those whose layer differs from the next finer one. Too coarse: share of them whose own g is larger, and by what factor at most; too fine: smaller.`)];
}

/**
 * What is drawn from each g on, were all buildings equally far: each shows the coarsest layer whose g is no larger. `counts`: buildings
 * on each layer. `bytes` is NaN where no GLB was written.
 */
function drawnSteps() {
  const changes = buildings.flatMap((b) => {
    const shown = [];  // coarsest first
    for (const l of b.own) if (l && !l.failure && l.gsd < (shown.at(-1)?.gsd ?? Infinity)) shown.push(l);
    return shown.map((to, i) => ({ to, from: shown[i + 1] }));
  }).sort((a, b) => a.to.gsd - b.to.gsd);
  const steps = [];
  let step = { triangles: 0, bytes: 0, counts: layers.map(() => 0) };
  for (const { from, to } of changes) {
    if (step.gsd !== to.gsd) steps.push(step = { ...step, gsd: to.gsd, counts: [...step.counts] });
    step.triangles += to.faces - (from?.faces ?? 0);
    step.bytes += to.bytes - (from?.bytes ?? 0);
    ++step.counts[to.layer];
    if (from) --step.counts[from.layer];
  }
  return steps;
}

const kilobytes = (x) => (x >= 1e6 ? `${rounded(x / 1e6)} MB` : `${rounded(x / 1e3)} kB`);

const plotTop = { strip: 18, curves: 32 };

/** A strip above the plot: the layer that is shown at each distance, and lines where they switch. */
function layerStrip(x, base, right) {
  const marks = [];
  let end = right;
  for (const { layer, gsd } of switching.layers) {
    const from = x(distanceOf(gsd));
    if (from >= end) continue;
    marks.push(make('svg:path', { class: 'series bars', d: `M${from} ${plotTop.strip}H${end}v6H${from}z`, style: { '--c': colorOf(switchesAs(layer)) } }));
    if (end - from > 60) marks.push(text(`layer ${switchesAs(layer)}`, { x: (from + end) / 2, y: plotTop.strip - 5, 'text-anchor': 'middle' }));
    if (gsd > 0) marks.push(make('svg:path', { class: 'switch', d: `M${from} ${plotTop.strip}V${base}` }));
    end = from;
  }
  return marks;
}

function distanceAxis(scale, x, base, right) {
  const isWide = (right - margin.left) / (scale.ticks.length - 1) > 160;
  const ticks = scale.ticks.flatMap((t) => (isWide ? [t, 2 * t, 5 * t] : [t])).filter((t) => t <= scale.ticks.at(-1));
  return [...ticks.flatMap((t) => [make('svg:path', { class: 'axis', d: `M${x(t)} ${base}v4` }), text(rounded(t), { x: x(t), y: base + 17, 'text-anchor': 'middle' })]),
    text('distance, m (log scale)', { x: (margin.left + right) / 2, y: base + 36, 'text-anchor': 'middle' })];
}

function bytesAxis(scale, y, base, right) {
  return [...scale.ticks.map((t) => text(scale.write(t), { x: right + 8, y: y(t) + 4 })),
    text('bytes', { transform: `translate(${right + 76} ${(base + plotTop.curves) / 2}) rotate(-90)`, 'text-anchor': 'middle' })];
}

function tellStep(step, finest, distance) {
  return { title: `${rounded(distance)} m, ${rounded(distance / distanceOf(1))} m/px`,
    lines: [`${whole(step.triangles)} triangles (${percent(step.triangles / finest.triangles)})`,
      ...(isNumber(step.bytes) ? [`${kilobytes(step.bytes)} (${percent(step.bytes / finest.bytes)})`] : []),
      ...layers.filter((k) => step.counts[k]).map((k) => `layer ${k}: ${count(step.counts[k], 'building')}`)] };
}

function drawDistances(box, width, steps) {
  const hasBytes = isNumber(steps[0].bytes), height = 270, base = height - 40, right = width - (hasBytes ? margin.left : margin.right);
  const switches = steps.slice(1).map((s) => distanceOf(s.gsd));
  const distances = logScale([switches[0] / 2, switches.at(-1) * 2], 0.01);
  const x = (d) => margin.left + distances.at(d) * (right - margin.left);
  const yOf = (scale) => (v) => base - scale.at(v) * (base - plotTop.curves);
  const curve = (name, y) => make('svg:path', { class: `drawn ${name}`, d: steps.map((s, i) => `${i ? `H${x(distanceOf(s.gsd)).toFixed(1)}V` : `M${margin.left} `}${y(s[name]).toFixed(1)}`).join('') + `H${right}` });
  const triangles = linearScale(steps.map((s) => s.triangles)), y = yOf(triangles);
  const svg = make('svg:svg', { viewBox: `0 0 ${width} ${height}`, height, role: 'img', 'aria-label': 'Triangles and bytes drawn against distance' });
  svg.append(...axes({ scale: triangles, yTitle: 'triangles' }, y, plotTop.curves, base, right), ...distanceAxis(distances, x, base, right), ...layerStrip(x, base, right));
  if (hasBytes) {
    const scale = linearScale(steps.map((s) => s.bytes), kilobytes);
    svg.append(...bytesAxis(scale, yOf(scale), base, right), curve('bytes', yOf(scale)));
  }
  svg.append(curve('triangles', y));
  const tip = tipOf(svg, plotTop.strip, base, (at) => {
    const part = (at - margin.left) / (right - margin.left), distance = distances.from(part);
    return part >= 0 && part <= 1 && { x: at, ...tellStep(steps.findLast((s) => distanceOf(s.gsd) <= distance), steps[0], distance) };
  });
  box.replaceChildren(svg, tip);
}

function showSwitching() {
  const box = section('switching'), steps = drawnSteps();
  box.append(make('p', {}, aboutSwitching()), ...switching.warnings.map((w) => make('p', { class: 'warn' }, w)), ...showSwitchTable());
  if (steps.length < 2) return;
  const frame = make('div', { class: 'plot' });
  box.append(make('h3', {}, 'Drawn against distance'),
    make('p', { class: 'note' }, 'Triangles, and bytes of their meshes, if all buildings stood equally far. A tileset has simpler stand-ins for far away.'),
    make('div', { class: 'legend' }, make('span', { class: 'drawn triangles' }, 'triangles'), isNumber(steps[0].bytes) && make('span', { class: 'drawn bytes' }, 'bytes')), frame);
  drawInto([frame], (width) => drawDistances(frame, width, steps))();
}
