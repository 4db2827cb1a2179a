// The map panel of a comparison: two runs on one another, divided by a line that a slider moves, or faded.

class ComparisonMap {
  constructor(runs) {
    this.runs = runs;
    this.sides = { left: 0, right: 1 };
    this.share = 0.5;
    this.fades = false;
    this.panel = addPanel('map', 'Maps',
      'Two runs in the frame of the first one, laid so that both begin at the same place: move the slider to see one or the other; drag to move, turn the wheel or pinch to zoom.', true);
    this.addControls();
    this.view = new MapView(this.panel);
    this.addSlider();
    this.panes = {};
    for (const [side, order] of [['left', 410], ['right', 420]]) {
      const pane = this.view.map.createPane(side);
      pane.style.zIndex = order;
      this.panes[side] = { pane, renderer: L.canvas({ pane: side, padding: 0.3 }), layers: L.layerGroup().addTo(this.view.map) };
    }
    for (const side of ['left', 'right']) this.draw(side);
    this.view.fit();
    this.view.map.on('move zoom zoomend resize', () => this.divide());
    this.divide();
  }

  addControls() {
    const names = this.runs.map((run, k) => [String(k), run.name]);
    const chooser = (side, label) => choice(label, names, String(this.sides[side]), (k) => {
      this.sides[side] = Number(k);
      this.draw(side);
      this.divide();
    });
    this.panel.append(element('div', { class: 'controls' }, chooser('left', 'left'), chooser('right', 'right'),
      choice('slider', [['divide', 'divides'], ['fade', 'fades']], 'divide', (mode) => { this.fades = mode === 'fade'; this.divide(); })));
  }

  addSlider() {
    const slider = element('input', { class: 'split', type: 'range', min: 0, max: 1000, value: 500, 'aria-label': 'how much of the left run shows',
      oninput: () => { this.share = slider.value / 1000; this.divide(); } });
    this.names = { left: element('span'), right: element('span') };
    this.panel.append(slider, element('div', { class: 'sides' }, this.names.left, this.names.right));
  }

  draw(side) {
    const run = this.runs[this.sides[side]], color = runColor(this.sides[side]);
    const { renderer, layers } = this.panes[side];
    layers.clearLayers();
    if (run.map) this.view.addPicture(run.map, side).addTo(layers);
    for (const p of run.landmarks) L.circleMarker(at(p), { renderer, radius: 3, weight: 0, fillColor: color, fillOpacity: 1, interactive: false }).addTo(layers);
    const points = run.path.x.map((x, i) => [run.path.y[i], x]);
    L.polyline(points, { renderer, color, weight: 2, interactive: false, smoothFactor: 0.5 }).addTo(layers);
    this.view.bounds.extend(points);
    this.names[side].replaceChildren(swatch(color), ` ${run.name}`);
  }

  /** Shows the left run left of the line and the right run right of it, or both as strong as the slider says. */
  divide() {
    const { map } = this.view, size = map.getSize();
    const low = map.containerPointToLayerPoint([0, 0]), high = map.containerPointToLayerPoint(size);
    const line = this.fades ? null : low.x + size.x * this.share;
    const clip = (from, to) => (line === null ? 'auto' : `rect(${low.y}px, ${to}px, ${high.y}px, ${from}px)`);
    this.panes.left.pane.style.clip = clip(low.x, line);
    this.panes.right.pane.style.clip = clip(line, high.x);
    this.panes.left.pane.style.opacity = 1;
    this.panes.right.pane.style.opacity = this.fades ? 1 - this.share : 1;
    this.view.box.style.setProperty('--split', this.fades ? '-10px' : `${100 * this.share}%`);
  }
}
