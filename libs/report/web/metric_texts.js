// What the figures of metrics.json mean.

const kMetricTexts = {
  scans: 'Scans in the log',
  frames: 'Instants of the log that got a pose',
  odometry_path_m: 'Path by odometry (m)',
  key_nodes: 'Scans that were inserted into the evidence of a submap',
  submaps: 'Submaps',
  features: 'Features of all submaps',
  landmarks: 'Landmarks of the joined map',
  objective: 'Sum of squares that the last joiner made small',
  join_status: 'How the last joiner ended',
  join_reason: 'Why it ended so',
  join_iterations: 'Its iterations',
  constraints_accepted: 'Loop closures that are used',
  constraints_rejected: 'Loop closures that were tried and refused',
  match_score_mean: 'Share of the beams that the submap explains, mean over all scans',
  match_score_min: 'The least share of all scans',
  match_score_max: 'The greatest share of all scans',
  nodes_per_submap: 'Key scans of a submap, mean',
  stage_1: 'Share of the map after a fifth of the submaps',
  stage_2: 'Share of the map after two fifths',
  stage_3: 'Share of the map after three fifths',
  stage_4: 'Share of the map after four fifths',
  stage_5: 'Share of the map after all submaps',
  association: 'Whether ids said which features are the same landmark',
  association_wrong: 'Features matched with another landmark than their id says',
  association_missed: 'Landmarks that are there twice',
  features_dropped: 'Features left out as ambiguous',
  wall_s: 'Time of the run (s)',
  cpu_s: 'CPU time of the run, all threads (s)',
  peak_memory_mb: 'Most memory at any time (MB)',
  seed: 'Seed of the random streams',
  version: 'Version of the program',
};

/** Time, CPU time and memory have panels of their own. */
function isFigure(key, value) {
  return key !== 'warnings' && key !== 'stages' && !/_(wall|cpu)_s$/.test(key) && (value === null || typeof value !== 'object');
}
