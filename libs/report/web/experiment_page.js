// experiment.html: data sets × settings × seeds, as tables and plots.

/** Mean ± standard deviation over the seeds. */
function statisticsText(s, column, worst) {
  if (!s) return kMissing;
  const mean = fixed(s.mean, column.decimals);
  if (s.count === 1) return mean;
  return `${mean} ± ${fixed(s.std, column.decimals)}${worst ? `, ≤ ${fixed(s.max, column.decimals)}` : ''}`;
}

function experimentTiles(data) {
  const failed = data.cells.filter((cell) => cell.error).length;
  return [['Cells', String(data.cells.length), failed > 0 ? `${data.cells.length - failed} complete` : 'all complete'],
    ['Data', String(new Set(data.rows.map((row) => row.data)).size)],
    ['Settings', String(new Set(data.rows.map((row) => row.setting)).size)],
    ['Seeds', String(data.seeds.length), data.seeds.length > 6 ? undefined : data.seeds.join(', ')],
    ['Program', data.version]];
}

function addFailures(cells) {
  const failed = cells.filter((cell) => cell.error);
  if (failed.length === 0) return;
  const panel = addPanel('failed', 'Cells without a result', 'They are missing in means and plots; the same command runs them again.', true);
  panel.classList.add('warnings');
  panel.append(element('ul', {}, ...failed.map((cell) => element('li', {}, `${cell.data}, ${cell.setting}, seed ${cell.seed}: ${cell.error}`))));
}

function nameColumns() {
  return [{ title: 'data', key: 'data', kind: 'short' }, { title: 'setting', key: 'setting', kind: 'short' }];
}

function addResultTable(data) {
  const panel = addPanel('table', 'Results',
    `Mean ± standard deviation${data.worst ? ' and greatest value' : ''} over the seeds, as in table.md; a heading sorts.`, true);
  const columns = data.columns.map((column, i) => ({ title: column.label, hint: column.key,
    by: (row) => (row.values[i] ? row.values[i].mean : null), show: (row) => statisticsText(row.values[i], column, data.worst) }));
  const runs = { title: 'runs', key: 'runs', show: (row) => element('span', { class: row.runs < data.seeds.length ? 'bad' : undefined }, String(row.runs)) };
  panel.append(new DataTable([...nameColumns(), runs, ...columns], data.rows).node);
}

function addCells(data) {
  const panel = addPanel('cells', 'Cells', 'Each data set, setting and seed by itself; cells/DATA/SETTING/SEED/ has all that the run wrote.', true);
  const figure = (column, i) => ({ title: column.label, hint: column.key, by: (cell) => cell.values[i], show: (cell) => fixed(cell.values[i], column.decimals) });
  const table = new DataTable([...nameColumns(), { title: 'seed', key: 'seed', by: (cell) => Number(cell.seed) },
    ...data.columns.map(figure), { title: 'error', key: 'error', kind: 'text', show: (cell) => element('span', { class: 'bad' }, cell.error) }], data.cells);
  panel.append(table.node);
}

function addRecordOf(data) {
  const panel = addPanel('made', 'How it was made', 'With this description, saved as a file, the program of this version makes the same tables and plots again, times apart. If it names recordings, --data says where they are.', true);
  const all = (key) => [...new Set(data.cells.map((cell) => cell[key]).filter((text) => text))].join(', ');
  const facts = [['submap-slam', data.version], ['build', all('build')], ['MRPT', all('mrpt')], ['seeds', data.seeds.join(', ')]];
  panel.append(new DataTable([{ title: 'what', key: 'what', kind: 'text' }, { title: 'value', key: 'value', kind: 'text', show: (fact) => anyValue(fact.value) }],
    facts.map(([what, value]) => ({ what, value }))).node, element('pre', {}, data.description));
}

function showExperiment(data) {
  addHead(data.title || 'Experiment', 'Every data set with every setting and every seed.', experimentTiles(data));
  addFailures(data.cells);
  addResultTable(data);
  data.plots.forEach(addPlot);
  addCells(data);
  addRecordOf(data);
}
