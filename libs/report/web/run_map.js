// The map panel of a run: layers to switch, what is under the pointer, and highlights asked for by other panels.

class RunMap {
  constructor(data) {
    this.data = data;
    this.panel = addPanel('map', 'Map', this.howToRead(), true);
    this.controls = element('div', { class: 'controls' });
    this.panel.append(this.controls);
    this.view = new MapView(this.panel);
    this.readout = element('p', { class: 'readout', 'aria-live': 'polite' }, this.hint());
    this.panel.append(this.readout);
    this.highlights = L.layerGroup().addTo(this.view.map);
    this.onConstraint = () => {};
    this.addLayers();
    this.view.include(data.submaps);
    this.view.include(data.landmarks || []);
    this.view.fit();
    this.followPointer();
  }

  howToRead() {
    const shown = this.data.form === 'grid' ? 'Lines are walls, the plain areas between them are free, and nobody saw what is left as background'
      : 'Green dots are landmarks';
    return `${shown}; drag to move, turn the wheel or pinch to zoom, point at anything to see what it is.`;
  }

  hint() { return 'Point at the path, or tap it, to see where the robot was when.'; }

  addLayers() {
    const { data } = this;
    if (data.map) this.switchable('map', this.view.addPicture(data.map), true);
    if (data.landmarks) this.switchable('landmarks', landmarkLayer(data.landmarks), true, swatch(kAccepted, 'dot'));
    if (data.form === 'grid') this.switchable('outlines', outlineLayer(data.submaps), false, swatch(kFrame));
    this.addConstraintLayers();
    this.addTrajectory();
    this.switchable('frames', frameLayer(data.submaps), true, swatch(kFrame, 'dot'));
    this.addEllipses();
  }

  switchable(label, layer, visible, mark) {
    this.view.show(layer, visible);
    this.controls.append(checkbox(label, visible, (on) => this.view.show(layer, on), mark));
  }

  addConstraintLayers() {
    const { constraints, submaps } = this.data;
    if (!constraints) return;
    for (const [kind, label, visible] of [['chain', 'chain', false], ['rejected', 'rejected loops', false], ['accepted', 'accepted loops', true]]) {
      const layer = constraintLayer(constraints, submaps, kind, (c, clicked) => this.onConstraint(c, clicked));
      this.switchable(label, layer, visible, swatch(kConstraintStyles[kind].color, kind === 'rejected' ? 'dashed' : 'line'));
    }
  }

  addTrajectory() {
    const colorings = trajectoryColorings(this.data.trajectory);
    const bar = element('span', { class: 'bar' }), low = element('span'), high = element('span');
    let layer, visible = true;
    const color = (name) => {
      if (layer) layer.remove();
      layer = trajectoryLayer(this.data.trajectory, colorings[name]);
      this.view.show(layer, visible);
      bar.style.background = gradient(colorings[name].scale);
      low.textContent = colorings[name].low;
      high.textContent = colorings[name].high;
    };
    color('time');
    this.controls.append(
      checkbox('path', true, (on) => { visible = on; this.view.show(layer, on); }),
      choice('coloured by', [['time', 'time'], ['uncertainty', 'uncertainty']], 'time', color),
      element('span', { class: 'legend' }, low, bar, high));
  }

  addEllipses() {
    const places = [...this.data.submaps, ...(this.data.landmarks || [])];
    let layer;
    const draw = (times) => {
      if (layer) layer.remove();
      layer = ellipseLayer(places, Number(times), kRejected);
      this.view.show(layer, Number(times) > 0);
    };
    draw(1);
    this.controls.append(choice('3σ ellipses', [['0', 'off'], ['1', 'true size'], ['10', '10 × larger'], ['50', '50 × larger']], '1', draw));
  }

  followPointer() {
    const { trajectory } = this.data, { map } = this.view;
    const mark = L.circleMarker([0, 0], { radius: 6, color: kHighlight, weight: 3, fill: false, interactive: false });
    const say = (event) => {
      const i = nearestPoint(map, event.latlng, trajectory.x, trajectory.y, 14);
      mark.remove();
      if (i >= 0) mark.setLatLng([trajectory.y[i], trajectory.x[i]]).addTo(map);
      this.readout.textContent = i < 0 ? `x ${event.latlng.lng.toFixed(2)} m, y ${event.latlng.lat.toFixed(2)} m` : this.poseText(i);
    };
    map.on('mousemove', say).on('click', say);
    map.on('mouseout', () => { mark.remove(); this.readout.textContent = this.hint(); });
  }

  poseText(i) {
    const { trajectory: path, submaps } = this.data;
    const when = path.start === 0 ? '' : `${path.t[i].toFixed(2)} s after the start, `;
    return `${when}submap ${submaps[path.submap[i]].id}: x ${path.x[i].toFixed(2)} m, y ${path.y[i].toFixed(2)} m, σ ${metres(path.sigma[i])}`;
  }

  /** Draws submaps and, if there are two, the line between them; `travel` moves the view there. */
  highlight(indices, travel) {
    this.highlights.clearLayers();
    const chosen = indices.map((k) => this.data.submaps[k]).filter(Boolean);
    const bounds = L.latLngBounds([]);
    for (const submap of chosen) {
      bounds.extend(at(submap));
      L.circleMarker(at(submap), { radius: 9, color: kHighlight, weight: 3, fill: false, interactive: false }).addTo(this.highlights);
      if (!submap.outline || submap.outline.length < 3) continue;
      const corners = submap.outline.map(([x, y]) => [y, x]);
      L.polygon(corners, { color: kHighlight, weight: 2, fillOpacity: 0.12, interactive: false }).addTo(this.highlights);
      bounds.extend(corners);
    }
    if (chosen.length === 2) L.polyline(chosen.map(at), { color: kHighlight, weight: 4, interactive: false }).addTo(this.highlights);
    if (travel && bounds.isValid()) {
      this.view.map.fitBounds(bounds, { padding: [30, 30], maxZoom: 6 });
      this.panel.scrollIntoView({ behavior: 'smooth', block: 'nearest' });
    }
  }
}
