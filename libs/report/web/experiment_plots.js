// The plots of experiment.html: over places with names, over time, errors with their bounds, paths.

const kSpreadText = 'with a line of one standard deviation to both sides';

function plotLine(series, k, column) {
  return {
    label: series.label, color: runColor(k), show: (v) => fixed(v, column.decimals),
    values: series.points.map((p) => (p ? p.mean : null)), spread: series.points.map((p) => (p ? p.std : 0)),
  };
}

/** Room for all values with their spreads, and for the zero that bars stand on. */
function plotRange(lines, bars) {
  const ends = lines.flatMap((line) => line.values.flatMap((v, i) => (v === null ? [] : [v - line.spread[i], v + line.spread[i]])));
  if (bars) ends.push(0);
  const low = Math.min(...ends), high = Math.max(...ends);
  return low === high ? [low - 1, high + 1] : uPlot.rangeNum(low, high, 0.1, bars);
}

function noteMissing(panel) { panel.append(element('p', { class: 'note' }, 'No cell has this figure.')); }

function addPlacesPlot(plot) {
  const over = plot.x === 'seed' ? 'Each seed' : `Mean over the seeds, ${kSpreadText}, of each ${plot.x === 'data' ? 'data set' : 'setting'}`;
  const panel = addPanel(`plot-${plot.name}`, plot.title, `${over}. What is missing failed or has no such figure.`, plot.places.length * plot.series.length > 12);
  const bars = plot.kind === 'bars', lines = plot.series.map((series, k) => ({ ...plotLine(series, k, plot.y), points: !bars }));
  if (lines.every((line) => line.values.every((v) => v === null))) {
    noteMissing(panel);
    return;
  }
  const range = plotRange(lines, bars);
  addChart(panel, { x: plot.places.map((_, i) => i), places: plot.places, xLabel: plot.x, yLabel: plot.y.label, lines, bars, height: 300, range: () => range });
}

const kTimeLabel = 'time, s';

/** Few values are easily overlooked without dots. */
function needsPoints(values) { return values.length < 3; }

/** Whether values of curves differ by powers of ten. */
function spanDecades(curves) {
  const values = curves.flatMap((curve) => curve.values.filter((v) => v > 0));
  return values.reduce((a, b) => Math.max(a, b), 0) > 100 * values.reduce((a, b) => Math.min(a, b), Infinity);
}

function addTimePlot(plot) {
  const curves = plot.curves.filter((curve) => curve.t.length > 0), log = spanDecades(curves);
  const panel = addPanel(`plot-${plot.name}`, plot.title,
    `Each pose where a submap ends, mean over the seeds; ${plot.expected.text} (dashed).${log ? ' The scale is logarithmic.' : ''}`, true);
  if (curves.length === 0) {
    noteMissing(panel);
    return;
  }
  const ends = [0, Math.max(...curves.map((curve) => curve.t[curve.t.length - 1]))];
  const [x, ...columns] = uPlot.join([...curves.map((curve) => [curve.t, curve.values]), [ends, ends.map(() => plot.expected.value)]]);
  const lines = curves.map((curve, k) => ({ label: curve.label, color: runColor(k), values: columns[k], points: needsPoints(curve.t) }));
  lines.push({ label: String(plot.expected.value), color: kChain, dash: [6, 4], values: columns[curves.length] });
  addChart(panel, { x, xLabel: kTimeLabel, yLabel: plot.y.label, lines, log, nearest: true, height: 320 });
}

function addErrorChart(panel, curve, axis, label) {
  const { error, sigma } = curve[axis], points = needsPoints(error);
  const bound = (sign, text) => ({ label: text, color: kChain, dash: [6, 4], values: sigma.map((s) => 3 * sign * s), points });
  addChart(panel, { x: curve.t, xLabel: kTimeLabel, yLabel: label, height: 220,
    lines: [{ label: 'error', color: runColor(0), values: error, points }, bound(1, '+3σ'), bound(-1, '−3σ')] });
}

/** A panel of three charts for each data set and setting. */
function addErrorPlots(plot) {
  plot.curves.forEach((curve, k) => {
    const panel = addPanel(`plot-${plot.name}-${k}`, `${plot.title}: ${curve.label}`,
      `Estimate − truth of the poses where submaps end, and three standard deviations to both sides (dashed), seed ${plot.seed}.`);
    if (curve.t.length === 0) {
      noteMissing(panel);
      return;
    }
    for (const [axis, label] of [['x', 'error of x, m'], ['y', 'error of y, m'], ['phi', 'error of heading, deg']])
      addErrorChart(panel, curve, axis, label);
  });
}

function pathLayer(path, style) {
  return L.polyline(path.x.map((x, i) => [path.y[i], x]), { weight: 2, interactive: false, smoothFactor: 0.5, ...style });
}

function dotsLayer(points, color) {
  const group = L.layerGroup();
  points.x.forEach((x, i) => L.circleMarker([points.y[i], x], { radius: 2, weight: 0, fillColor: color, fillOpacity: 0.7, interactive: false }).addTo(group));
  return group;
}

/** A map for each data set. */
function addPathPlots(plot) {
  plot.curves.forEach((set, k) => {
    const fixes = set.fixes.x.length > 0;
    const panel = addPanel(`plot-${plot.name}-${k}`, `${plot.title}: ${set.label}`,
      `${fixes ? 'Paths of the GPS antenna, each laid on the fixes' : 'Paths of the robot, laid on the truth where there is one'}, seed ${plot.seed}; drag to move, turn the wheel or pinch to zoom.`, true);
    const controls = element('div', { class: 'controls' });
    panel.append(controls);
    const view = new MapView(panel);
    const add = (label, points, layer, color, form) => {
      view.show(layer, true);
      view.bounds.extend(points.x.map((x, i) => [points.y[i], x]));
      controls.append(checkbox(label, true, (on) => view.show(layer, on), swatch(color, form)));
    };
    if (fixes) add('GPS', set.fixes, dotsLayer(set.fixes, kHighlight), kHighlight, 'dot');
    if (set.truth.x.length > 0) add('truth', set.truth, pathLayer(set.truth, { color: kChain, dashArray: '6 4' }), kChain, 'dashed');
    set.paths.forEach((path, i) => add(path.label, path, pathLayer(path, { color: runColor(i) }), runColor(i)));
    view.fit();
  });
}

function addPlot(plot) {
  if (plot.kind === 'errors') addErrorPlots(plot);
  else if (plot.kind === 'path') addPathPlots(plot);
  else if (plot.x === 'time') addTimePlot(plot);
  else addPlacesPlot(plot);
}
