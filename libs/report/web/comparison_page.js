// compare.html: runs side by side.

const kTableHints = {
  Figures: 'What metrics.json says of each run; in brackets how much it differs from the first run.',
  'Time and memory': 'What each run took; runs on a busy machine take more wall time, and a little more CPU time.',
  'Trajectories, differences from the first run': 'How far the poses at the same times are apart when both runs begin at the same place, and what is left if they are laid on one another as well as possible.',
  'Settings that differ': 'Keys of config.ini whose values are not the same in all runs.',
};

/** The value, and for numbers how much it differs from that of the first run. */
function comparedCell(value, first) {
  const text = typeof value === 'string' && value.length > 0 ? value : anyValue(value);
  if (typeof value !== 'number' || typeof first !== 'number' || first === 0 || value === first) return text;
  const change = 100 * (value - first) / Math.abs(first);
  return element('span', {}, `${text} `, element('span', { class: 'muted' }, `(${change > 0 ? '+' : '−'}${Math.abs(change) < 0.05 ? '<0.1' : Math.abs(change).toFixed(1)} %)`));
}

function addComparisonTable(table, names, id) {
  const panel = addPanel(id, table.title.split(',')[0], kTableHints[table.title] || '', true);
  if (table.rows.length === 0) {
    panel.append(element('p', { class: 'note' }, 'None.'));
    return;
  }
  const columns = names.map((name, k) => ({ title: name, kind: 'value',
    by: (row) => row.values[k], show: (row) => comparedCell(row.values[k], k > 0 ? row.values[0] : null) }));
  panel.append(new DataTable([{ title: 'name', key: 'name', kind: 'text', show: (row) => element('span', { class: 'key' }, row.name) }, ...columns], table.rows).node);
}

/** All times of all differences, and each run's values at them. */
function onCommonTimes(runs, key) {
  const times = [...new Set(runs.flatMap((run) => run.differences.t))].sort((a, b) => a - b);
  const columns = runs.map((run) => {
    const at = new Map(run.differences.t.map((t, i) => [t, run.differences[key][i]]));
    return times.map((t) => at.get(t));
  });
  return { times, columns };
}

function addDifferences(runs) {
  const panel = addPanel('differences', 'Apart from the first run',
    'Distance and turn between the pose of each run and that of the first run at the same time: a step shows where they began to differ.', true);
  const others = runs.slice(1).filter((run) => run.differences.t.length > 0);
  if (others.length === 0) {
    panel.append(element('p', { class: 'note' }, 'No run has a time in common with the first one, so maps are laid on one another by their own frames.'));
    return;
  }
  for (const [key, label] of [['apart_m', 'distance, m'], ['turned_deg', 'turn, °']]) {
    const { times, columns } = onCommonTimes(others, key);
    addChart(panel, { x: times, xLabel: 'time since the first pose, s', yLabel: label, lines: others.map((run, k) => ({
      label: run.name, color: kRunColors[runs.indexOf(run) % kRunColors.length], values: columns[k], points: false })) });
  }
}

function showComparison(data) {
  const names = data.runs.map((run) => run.name);
  addHead(names.join(' · '), `${names.length} runs side by side; ${names[0]} is what the others are compared with.`, []);
  const map = new ComparisonMap(data.runs);
  addDifferences(data.runs);
  data.tables.forEach((table, i) => addComparisonTable(table, names, `table-${i + 1}`));
  return map;
}
