// What the map of a run consists of. Each function returns a Leaflet layer.

const kColorSteps = 48;  // shades along a trajectory

/** How the trajectory can be coloured: values, scale, and texts for the least and the greatest. */
function trajectoryColorings(trajectory) {
  const last = trajectory.t.length - 1, greatest = trajectory.sigma.reduce((a, b) => Math.max(a, b), 0);
  const sequence = trajectory.start === 0;  // submaps without stamps
  return {
    time: { values: trajectory.t, max: Math.max(trajectory.t[last] || 0, 1e-9), scale: kTimeScale,
      low: 'start', high: sequence ? `submap ${last}` : seconds(trajectory.t[last]) },
    uncertainty: { values: trajectory.sigma, max: Math.max(greatest, 1e-9), scale: kSigmaScale,
      low: 'σ = 0', high: metres(greatest) },
  };
}

function trajectoryLayer(trajectory, coloring) {
  const shades = coloring.values.map((value) => Math.round(kColorSteps * value / coloring.max));
  return coloredPath(trajectory.x, trajectory.y, shades, (shade) => scaleColor(coloring.scale, shade / kColorSteps));
}

function outlineLayer(submaps) {
  const group = L.layerGroup();
  for (const submap of submaps) {
    if (!submap.outline || submap.outline.length < 3) continue;
    L.polygon(submap.outline.map(([x, y]) => [y, x]), { color: kFrame, weight: 1, opacity: 0.55, fill: false })
      .bindTooltip(`Outline of submap ${submap.id}`, { sticky: true }).addTo(group);
  }
  return group;
}

function frameText(submap) {
  const lines = [`Submap ${submap.id}`, `x ${submap.x.toFixed(2)} m, y ${submap.y.toFixed(2)} m, φ ${(submap.phi * 180 / Math.PI).toFixed(1)}°`,
    `σ ${metres(submap.sigma_major)} × ${metres(submap.sigma_minor)}, ${(submap.sigma_phi * 180 / Math.PI).toFixed(2)}°`];
  if (submap.scans) lines.push(`${submap.scans} scans, match score ${fixed(submap.score[0], 3)}`);
  if (submap.features) lines.push(`${submap.features} features`);
  return element('span', {}, ...lines.flatMap((line, i) => (i ? [element('br'), line] : [line])));
}

/** A dot where a submap begins, and its x axis. */
function frameLayer(submaps) {
  const group = L.layerGroup(), axis_m = 0.6;
  for (const submap of submaps) {
    const tip = [submap.y + axis_m * Math.sin(submap.phi), submap.x + axis_m * Math.cos(submap.phi)];
    L.polyline([at(submap), tip], { color: kFrame, weight: 2, interactive: false }).addTo(group);
    L.circleMarker(at(submap), { radius: 4, weight: 1.5, color: '#ffffff', fillColor: kFrame, fillOpacity: 1 })
      .bindTooltip(() => frameText(submap), { sticky: true }).addTo(group);
  }
  return group;
}

/** 3-sigma ellipses, drawn `magnified` times as large. */
function ellipseLayer(places, magnified, color) {
  const group = L.layerGroup();
  for (const place of places)
    L.polygon(ellipseCorners(place, 3 * magnified), { color, weight: 1.2, fillOpacity: 0.12, interactive: false, smoothFactor: 0.2 }).addTo(group);
  return group;
}

function landmarkLayer(landmarks) {
  const group = L.layerGroup();
  for (const landmark of landmarks)
    L.circleMarker(at(landmark), { radius: 3, weight: 0, fillColor: kAccepted, fillOpacity: 1 })
      .bindTooltip(() => `Landmark ${landmark.id}: ${landmark.hits} observations, σ ${metres(landmark.sigma_major)} × ${metres(landmark.sigma_minor)}`, { sticky: true })
      .addTo(group);
  return group;
}

function constraintKind(c) {
  if (!c.loop && !c.by_hand) return 'chain';
  return c.accepted ? 'accepted' : 'rejected';
}

const kConstraintStyles = {
  accepted: { color: kAccepted, weight: 1.3, opacity: 0.55 },
  rejected: { color: kRejected, weight: 1.3, opacity: 0.6, dashArray: '5 4' },
  chain: { color: kChain, weight: 1.5, opacity: 0.9 },
};

function constraintText(c, submaps) {
  return `${submaps[c.from].id} → ${submaps[c.to].id}, ${constraintKind(c)}${c.by_hand ? ' by hand' : ''}: ${c.reason}`;
}

/** @param onChoose called with the constraint, and whether it was clicked */
function constraintLayer(constraints, submaps, kind, onChoose) {
  const group = L.layerGroup();
  for (const c of constraints.filter((one) => constraintKind(one) === kind))
    L.polyline([at(submaps[c.from]), at(submaps[c.to])], kConstraintStyles[kind])
      .bindTooltip(() => constraintText(c, submaps), { sticky: true })
      .on('mouseover', () => onChoose(c, false)).on('click', () => onChoose(c, true)).addTo(group);
  return group;
}
