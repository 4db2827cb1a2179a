// report.html: one run.

function runTiles(data) {
  const m = data.metrics, tiles = [['Submaps', anyValue(m.submaps)]];
  if (m.frames !== undefined) tiles.push(['Scans with a pose', anyValue(m.frames)]);
  if (m.landmarks !== undefined) tiles.push(['Landmarks', anyValue(m.landmarks), `from ${anyValue(m.features)} features`]);
  if (m.constraints_accepted !== undefined)
    tiles.push(['Loop closures', anyValue(m.constraints_accepted), `of ${m.constraints_accepted + m.constraints_rejected} tried`]);
  if (m.match_score_mean !== undefined) tiles.push(['Match score', percent(m.match_score_mean), 'mean']);
  tiles.push(['Joining', anyValue(m.join_status)]);
  tiles.push(['Time', seconds(m.wall_s), `${seconds(m.cpu_s)} CPU`], ['Memory', `${fixed(m.peak_memory_mb, 0)} MB`, 'at most']);
  return tiles;
}

function addWarnings(warnings) {
  if (!warnings || warnings.length === 0) return;
  const panel = addPanel('warnings', 'Warnings', 'What the run found wrong or doubtful; the map may be affected.', true);
  panel.classList.add('warnings');
  panel.append(element('ul', {}, ...warnings.map((text) => element('li', {}, text))));
}

function constraintColumns(submaps) {
  const id = (k) => submaps[k].id;
  return [
    { title: 'from', key: 'from', show: (c) => id(c.from) },
    { title: 'to', key: 'to', show: (c) => id(c.to) },
    { title: 'kind', kind: 'short', by: constraintKind, show: (c) => element('span', { class: { accepted: 'good', rejected: 'bad' }[constraintKind(c)] || 'muted' },
      constraintKind(c) + (c.by_hand ? ' (by hand)' : '')) },
    { title: 'left over', key: 'left_m', hint: 'Distance between what the constraint says and the joined frames', show: (c) => metres(c.left_m) },
    { title: 'angle', key: 'left_deg', show: (c) => `${fixed(c.left_deg, 2)}°` },
    { title: 'in σ', key: 'left_sigma', hint: 'The same in standard deviations of the constraint', show: (c) => fixed(c.left_sigma, c.left_sigma < 100 ? 1 : 0) },
    { title: 'reason', key: 'reason', kind: 'text' },
  ];
}

function addConstraints(data, map) {
  if (!data.constraints) return;
  const panel = addPanel('constraints', 'Constraints',
    'What links submaps, and what is left of each link after joining: rejected loops with a small rest were refused too carefully, accepted ones with a large rest may be wrong.', true);
  const count = (kind) => data.constraints.filter((c) => constraintKind(c) === kind).length;
  const loops = data.constraints.some((c) => constraintKind(c) !== 'chain');
  const kinds = { accepted: true, rejected: true, chain: !loops };
  const table = new DataTable(constraintColumns(data.submaps), data.constraints, {
    narrow: '2.7rem 2.2rem 4.7rem 1fr 1fr 3rem',
    onRow: (c, clicked) => { map.highlight([c.from, c.to], clicked); table.choose(c, false); },
  });
  const refresh = () => table.filter((c) => kinds[constraintKind(c)]);
  panel.append(element('div', { class: 'controls' }, ...Object.keys(kinds).map((kind) =>
    checkbox(`${kind} (${count(kind)})`, kinds[kind], (on) => { kinds[kind] = on; refresh(); }))), table.node);
  refresh();
  map.onConstraint = (c, clicked) => {
    map.highlight([c.from, c.to], false);
    table.choose(c, true);
    if (clicked) panel.scrollIntoView({ behavior: 'smooth', block: 'nearest' });
  };
  if (data.constraints.length === 0) panel.append(element('p', { class: 'note' }, 'There is one submap only, so nothing links.'));
}

/** Iterations one after the other, a line for each level of a coarse-to-fine joiner. */
function addObjective(data) {
  const panel = addPanel('objective', 'Objective and steps',
    'The sum of squares that joining makes small, and how far frames still moved, by iteration: both should fall and level out; levels have different scales.');
  const iterations = data.iterations;
  if (iterations.length === 0) {
    panel.append(element('p', { class: 'note' }, 'The joiner reports no iterations.'));
    return;
  }
  const x = iterations.map((_, i) => i + 1), levels = [...new Set(iterations.map((i) => i.level))];
  const lines = levels.map((level, k) => ({ label: levels.length > 1 ? `level ${level}` : 'objective',
    color: runColor(k), points: true,
    values: iterations.map((i) => (i.level === level ? i.cost : null)) }));
  addChart(panel, { x, lines, xLabel: 'iteration', yLabel: 'objective', xInteger: true, log: true });
  addChart(panel, { x, xLabel: 'iteration', yLabel: 'largest step', xInteger: true, log: true, lines: [
    { label: 'm', color: kRunColors[0], points: true, values: iterations.map((i) => i.step_m) },
    { label: 'rad', color: kRunColors[1], points: true, values: iterations.map((i) => i.step_rad) }] });
}

function addScores(data, map) {
  if (data.form !== 'grid') return;
  const panel = addPanel('scores', 'Match scores',
    'Share of the beams of each scan that its submap explains; submaps with a low mean hold people, glass or wrong matches. Point at one to see it on the map.');
  const x = data.submaps.map((s) => s.id), score = (i) => data.submaps.map((s) => s.score[i]);
  addChart(panel, { x, xLabel: 'submap', yLabel: 'score', xInteger: true, range: (_, low, high) => [Math.min(low, 0.8), Math.max(high, 1)],
    onIndex: (i) => { if (i !== null && i !== undefined) map.highlight([i], false); },
    lines: [
      { label: 'greatest', color: kRunColors[5], values: score(2), width: 1, show: (v) => fixed(v, 3) },
      { label: 'mean', color: kRunColors[0], values: score(0), width: 2, show: (v) => fixed(v, 3) },
      { label: 'least', color: kRunColors[1], values: score(1), width: 1, show: (v) => fixed(v, 3) }] });
}

function addGrowth(data) {
  if (data.form !== 'grid') return;
  const panel = addPanel('growth', 'Growth of the map',
    'How much of the area of the map, and of the scans, each submap and those before it have: where the first curve is flat, the robot was in known places.');
  const x = data.submaps.map((s) => s.id);
  addChart(panel, { x, xLabel: 'submap', yLabel: 'share', xInteger: true, range: [0, 1.02], lines: [
    { label: 'of the map', color: kRunColors[0], values: data.submaps.map((s) => s.map_share), width: 2, show: percent },
    { label: 'of the scans', color: kRunColors[1], values: data.submaps.map((s) => s.scan_share), show: percent }] });
}

function addAssociations(data) {
  if (!data.associations) return;
  const panel = addPanel('associations', 'Association', 'What became of the features of the submaps: which of them are the same landmark.');
  panel.append(new DataTable([{ title: 'features', key: 'kind', kind: 'text' }, { title: 'count', key: 'count' }],
    Object.entries(data.associations).map(([kind, count]) => ({ kind, count }))).node);
}

function addUncertainty(data) {
  const panel = addPanel('uncertainty', 'Uncertainty of the frames',
    'Standard deviations of the joined submap frames against the first one: they grow with the distance from it and fall where loops close.');
  const x = data.submaps.map((s) => s.id);
  addChart(panel, { x, xLabel: 'submap', yLabel: 'σ of the position, m', xInteger: true, lines: [
    { label: 'largest', color: kRunColors[0], values: data.submaps.map((s) => s.sigma_major), width: 2, show: metres },
    { label: 'smallest', color: kRunColors[2], values: data.submaps.map((s) => s.sigma_minor), show: metres }] });
  addChart(panel, { x, xLabel: 'submap', yLabel: 'σ of the heading, °', xInteger: true, lines: [
    { label: 'heading', color: kRunColors[3], values: data.submaps.map((s) => s.sigma_phi * 180 / Math.PI), width: 2, show: (v) => `${number(v, 3)}°` }] });
}

function addStages(metrics) {
  const panel = addPanel('stages', 'Time and memory', 'What each stage took, and the most memory that the program had had by its end.');
  const stages = metrics.stages || [], most = Math.max(...stages.map((s) => s.cpu_s), 1e-9);
  const bar = (share) => { const mark = element('i'); mark.style.width = `${100 * share}%`; return mark; };
  const rows = stages.map((s) => ({ ...s, bar: s.cpu_s / most }));
  const table = new DataTable([
    { title: 'stage', key: 'name', kind: 'text' }, { title: 'wall, s', key: 'wall_s', show: (s) => fixed(s.wall_s, 2) },
    { title: 'CPU, s', key: 'cpu_s', show: (s) => fixed(s.cpu_s, 2) },
    { title: 'memory, MB', key: 'peak_memory_mb', show: (s) => fixed(s.peak_memory_mb, 0) },
    { title: 'CPU', key: 'bar', kind: 'share', show: (s) => bar(s.bar) }], rows, { narrow: 'minmax(0, 1fr) 3.8rem 3.8rem 5.2rem' });
  panel.append(table.node);
}

function addMetrics(metrics) {
  const panel = addPanel('metrics', 'Metrics', 'The figures of metrics.json.');
  const figures = Object.entries(metrics).filter(([key, value]) => isFigure(key, value));
  panel.append(new DataTable([
    { title: 'figure', key: 'key', kind: 'text', show: (f) => element('span', { class: 'key' }, f.key) },
    { title: 'value', key: 'value', kind: 'value', show: (f) => anyValue(f.value) },
    { title: 'meaning', key: 'meaning', kind: 'text', show: (f) => f.meaning }],
  figures.map(([key, value]) => ({ key, value, meaning: kMetricTexts[key] || '' })), { narrow: '1fr 1fr' }).node);
}

/** Keys of an ini file with the comment above each. */
function iniEntries(text) {
  const entries = [];
  let section = '', comment = [];
  for (const line of text.split('\n')) {
    const heading = line.match(/^\[(.*)\]$/), key = line.match(/^(\w+)\s*=\s*(.*)$/);
    if (heading) section = heading[1];
    if (key) entries.push({ key: `${section}.${key[1]}`, value: key[2], meaning: comment.join(' ') });
    comment = line.startsWith('#') ? [...comment, line.replace(/^#\s*/, '')] : [];
  }
  return entries;
}

function addSettings(ini) {
  const panel = addPanel('settings', 'Settings', 'Every parameter of the run, also in config.ini; type a word to find some.', true);
  const table = new DataTable([{ title: 'key', key: 'key', kind: 'text', show: (e) => element('span', { class: 'key' }, e.key) },
    { title: 'value', key: 'value', kind: 'text', show: (e) => anyValue(e.value) }, { title: 'meaning', key: 'meaning', kind: 'text' }], iniEntries(ini), { narrow: '1fr 1fr' });
  const search = element('input', { type: 'search', placeholder: 'find', 'aria-label': 'find a parameter', oninput: () => {
    const word = search.value.toLowerCase();
    table.filter((e) => `${e.key} ${e.value} ${e.meaning}`.toLowerCase().includes(word));
  } });
  panel.append(element('div', { class: 'controls' }, search), table.node);
}

function addMessages(messages) {
  const panel = addPanel('messages', 'Messages', 'What the run said, as in log.txt.', true);
  panel.append(element('pre', {}, messages.join('\n') || 'nothing'));
}

function showRun(data) {
  const m = data.metrics;
  addHead(data.input, `Map made by submap-slam ${m.version}, seed ${m.seed}. Joined: ${m.join_status}${m.join_reason ? ` (${m.join_reason})` : ''}.`, runTiles(data));
  addWarnings(m.warnings);
  const map = new RunMap(data);
  addConstraints(data, map);
  addObjective(data);
  addUncertainty(data);
  addScores(data, map);
  addGrowth(data);
  addAssociations(data);
  addStages(m);
  addMetrics(m);
  addSettings(data.ini);
  addMessages(data.messages);
}
