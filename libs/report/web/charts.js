// Charts by uPlot, as wide as their panel, in the colours of the page.

const kChartHeight = 230;

function axis(label, extra) {
  const color = themeColor('muted'), grid = { stroke: themeColor('line'), width: 1 };
  return { label, stroke: color, grid, ticks: grid, font: '12px system-ui, sans-serif', labelFont: '12px system-ui, sans-serif', labelSize: 20, ...extra };
}

function seriesOf(line) {
  return {
    label: line.label, stroke: line.color, width: line.width || 1.5, dash: line.dash, scale: 'y',
    points: { show: line.points, size: 5, fill: line.color },
    value: (_, value) => (value === null || value === undefined ? kMissing : (line.show || number)(value)),
  };
}

function chartOptions(spec, width) {
  const log = spec.log ? { distr: 3 } : { range: spec.range };
  return {
    width, height: spec.height || kChartHeight,
    scales: { x: { time: false }, y: log },
    axes: [axis(spec.xLabel, { values: spec.xInteger ? wholeNumbers : undefined }),
      axis(spec.yLabel, { size: 62, values: (_, ticks) => ticks.map((t) => (t === null ? '' : number(t, 3))) })],
    series: [{ label: spec.xLabel, value: (_, value) => (value === null || value === undefined ? kMissing : number(value, 6)) }, ...spec.lines.map(seriesOf)],
    bands: spec.bands,
    legend: { live: true },
    cursor: { drag: { x: true, y: false } },
    hooks: spec.onIndex ? { setCursor: [(plot) => spec.onIndex(plot.cursor.idx)] } : {},
  };
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
 * @param spec x: values; lines: [{label, color, values, …}]; xLabel, yLabel; log: logarithmic y */
function addChart(panel, spec) {
  const box = element('div', { class: 'chart' });
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
