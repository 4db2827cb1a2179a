// Charts by uPlot, as wide as their panel, in the colours of the page.

const kChartHeight = 230;

function axis(label, extra) {
  const color = themeColor('muted'), grid = { stroke: themeColor('line'), width: 1 };
  return { label, stroke: color, grid, ticks: grid, font: '12px system-ui, sans-serif', labelFont: '12px system-ui, sans-serif', labelSize: 20, ...extra };
}

/** The axis of places that have names, which are tilted where they would not fit. */
function placesAxis(places) {
  const longest = Math.max(...places.map((name) => name.length)), kCharacter = 7, kMostTilted = 130;
  const tilted = (plot) => places.length * (longest + 2) * kCharacter > plot.width - 70;
  return {
    splits: (_, axis, low, high) => places.map((_, i) => i).filter((i) => i >= low && i <= high), values: (_, ticks) => ticks.map((i) => places[i]),
    rotate: (plot) => (tilted(plot) ? 40 : 0),
    size: (plot) => (tilted(plot) ? Math.min(kMostTilted, 24 + 0.65 * kCharacter * longest) : 36),
  };
}

/** Bars of a line, beside those of the other lines, around whole numbers. */
function barPaths(k, count) {
  const width = 0.8 / count;
  return uPlot.paths.bars({ disp: {
    x0: { unit: 1, values: (plot) => plot.data[0].map((x) => x + barCentre(k, count) - width / 2) },
    size: { unit: 1, values: () => [0.92 * width] } } });
}

function barCentre(k, count) { return 0.8 * ((k + 0.5) / count - 0.5); }

/** A line from value − spread to value + spread. */
function drawSpreads(plot, spec) {
  const { ctx, bbox } = plot;
  ctx.save();
  ctx.beginPath();
  ctx.rect(bbox.left, bbox.top, bbox.width, bbox.height);
  ctx.clip();
  ctx.strokeStyle = themeColor('text');
  ctx.lineWidth = devicePixelRatio;
  spec.lines.forEach((line, k) => line.values.forEach((value, i) => {
    if (value === null || !(line.spread[i] > 0) || !plot.series[k + 1].show) return;
    const x = plot.valToPos(i + (spec.bars ? barCentre(k, spec.lines.length) : 0), 'x', true), cap = 3 * devicePixelRatio;
    const [top, bottom] = [value + line.spread[i], value - line.spread[i]].map((v) => plot.valToPos(v, 'y', true));
    ctx.beginPath();
    for (const [x1, y1, x2, y2] of [[x, top, x, bottom], [x - cap, top, x + cap, top], [x - cap, bottom, x + cap, bottom]]) {
      ctx.moveTo(x1, y1);
      ctx.lineTo(x2, y2);
    }
    ctx.stroke();
  }));
  ctx.restore();
}

function seriesOf(line, k, spec) {
  return {
    label: line.label, stroke: line.color, width: line.width || 1.5, dash: line.dash, scale: 'y',
    fill: spec.bars ? `${line.color}b0` : undefined, paths: spec.bars ? barPaths(k, spec.lines.length) : undefined,
    points: { show: line.points, size: 5, fill: line.color },
    value: (_, value) => (value === null || value === undefined ? kMissing : (line.show || number)(value)),
  };
}

function chartOptions(spec, width) {
  const log = spec.log ? { distr: 3 } : { range: spec.range };
  const { places } = spec;
  const x = places ? { range: (_, low, high) => [Math.round(low) - 0.5, Math.round(high) + 0.5] } : {};
  const showX = places ? (v) => places[v] : (v) => number(v, 6);
  return {
    width, height: spec.height || kChartHeight,
    scales: { x: { time: false, ...x }, y: log },
    axes: [axis(spec.xLabel, places ? placesAxis(places) : { values: spec.xInteger ? wholeNumbers : undefined }),
      axis(spec.yLabel, { size: 62, values: (_, ticks) => ticks.map((t) => (t === null ? '' : number(t, 3))) })],
    series: [{ label: spec.xLabel, value: (_, value) => (value === null || value === undefined ? kMissing : showX(value)) },
      ...spec.lines.map((line, k) => seriesOf(line, k, spec))],
    bands: spec.bands,
    legend: { live: true },
    cursor: { drag: { x: true, y: false }, points: { show: !spec.bars }, ...(spec.nearest ? { dataIdx: nearestValue } : {}) },
    hooks: {
      setCursor: spec.onIndex ? [(plot) => spec.onIndex(plot.cursor.idx)] : [],
      draw: spec.lines.some((line) => line.spread) ? [(plot) => drawSpreads(plot, spec)] : [],
    },
  };
}

/** Index nearest to that under the cursor at which the line has a value. */
function nearestValue(plot, line, index) {
  const values = plot.data[line], has = (i) => values[i] !== null && values[i] !== undefined;
  for (let step = 0; step < values.length; ++step)
    for (const i of [index - step, index + step]) if (i >= 0 && i < values.length && has(i)) return i;
  return index;
}

function wholeNumbers(_, ticks) { return ticks.map((t) => (Number.isInteger(t) ? String(t) : '')); }

/** What is smaller is rounding; charts show it as zero, or leave it out where the scale is logarithmic. */
const kRounding = 1e-12;

/** Columns of values of a chart, and whether its scale can be logarithmic. */
function plottedValues(spec) {
  const log = Boolean(spec.log) && spec.lines.some((line) => line.values.some((v) => v > kRounding));
  const plotted = (v) => {
    if (v === null || v === undefined || Math.abs(v) > kRounding) return v;
    return log ? null : 0;
  };
  return { log, columns: spec.lines.map((line) => line.values.map(plotted)) };
}

/** Adds a chart to a panel.
 * @param spec x: values; lines: [{label, color, values, spread, …}]; xLabel, yLabel; log: logarithmic y;
 *             places: names of the whole numbers x; bars: the lines as bars beside each other;
 *             nearest: lines have values at x of their own, the legend shows the nearest ones */
function addChart(panel, spec) {
  const box = element('div', { class: 'chart', role: 'figure', 'aria-label': `${spec.yLabel} over ${spec.xLabel}: ${spec.lines.map((line) => line.label).join(', ')}` });
  panel.append(box);
  let plot;
  const { log, columns } = plottedValues(spec);
  followScheme(() => {
    if (plot) plot.destroy();
    plot = new uPlot(chartOptions({ ...spec, log }, box.clientWidth), [spec.x, ...columns], box);
  });
  new ResizeObserver(() => {
    if (box.clientWidth > 0 && box.clientWidth !== plot.width)
      plot.setSize({ width: box.clientWidth, height: spec.height || kChartHeight });
  }).observe(box);
}
