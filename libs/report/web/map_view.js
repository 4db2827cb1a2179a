// A map in metres to pan and zoom, by Leaflet. x points right, y up; Leaflet's "latitude" is y, its "longitude" x.

function at(point) { return [point.y, point.x]; }

/** Corners of a polygon that stands for the ellipse of `times` standard deviations. */
function ellipseCorners(p, times) {
  const corners = [], c = Math.cos(p.sigma_angle), s = Math.sin(p.sigma_angle);
  for (let i = 0; i < 32; ++i) {
    const u = times * p.sigma_major * Math.cos(Math.PI * i / 16), v = times * p.sigma_minor * Math.sin(Math.PI * i / 16);
    corners.push([p.y + s * u + c * v, p.x + c * u - s * v]);
  }
  return corners;
}

class MapView {
  constructor(panel) {
    this.box = element('div', { class: 'map', role: 'application', 'aria-label': 'Map: drag to move, wheel or + and − to zoom' });
    panel.append(this.box);
    this.map = L.map(this.box, {
      crs: L.CRS.Simple, minZoom: -6, maxZoom: 10, zoomSnap: 0.25, wheelPxPerZoomLevel: 90,
      attributionControl: false, renderer: L.canvas({ tolerance: 5, padding: 0.3 }),
    });
    L.control.scale({ imperial: false }).addTo(this.map);
    this.bounds = L.latLngBounds([]);
    this.map.on('zoomend', () => this.smoothImages());
  }

  include(points) { for (const p of points) this.bounds.extend(at(p)); }

  /** Shows everything that was included. */
  fit() {
    if (!this.bounds.isValid()) this.bounds.extend([-1, -1]).extend([1, 1]);
    this.map.fitBounds(this.bounds, { padding: [12, 12] });
    this.map.setMinZoom(this.map.getZoom() - 3);
  }

  /** @param picture png, x_min, x_max, y_min, y_max */
  addPicture(picture, pane) {
    const bounds = [[picture.y_min, picture.x_min], [picture.y_max, picture.x_max]];
    this.bounds.extend(bounds);
    const image = L.imageOverlay(picture.png, bounds, { pane: pane || 'tilePane', alt: 'occupancy map' }).addTo(this.map);
    image.on('load', () => this.smoothImages());
    return image;
  }

  /** Pixels stay sharp when they are larger than those of the screen, and are averaged when they are smaller. */
  smoothImages() {
    for (const image of this.box.querySelectorAll('.leaflet-image-layer'))
      image.classList.toggle('magnified', image.clientWidth > image.naturalWidth);
  }

  show(layer, visible) {
    if (visible) layer.addTo(this.map);
    else layer.remove();
  }
}

/** Lines through points, one for each run of points of the same shade.
 * @param shades one for each point: that of the way to it
 * @param colorOf colour of a shade */
function coloredPath(x, y, shades, colorOf) {
  const group = L.layerGroup();
  for (let i = 1, first = 0; i < x.length; ++i) {
    if (i + 1 < x.length && shades[i + 1] === shades[first + 1]) continue;
    const points = [];
    for (let k = first; k <= i; ++k) points.push([y[k], x[k]]);
    L.polyline(points, { color: colorOf(shades[i]), weight: 2.5, interactive: false, smoothFactor: 0.5 }).addTo(group);
    first = i;
  }
  return group;
}

/** Index of the point nearest to a place on the map within `reach` pixels, or -1. */
function nearestPoint(map, latlng, x, y, reach) {
  let best = -1, least = (reach / map.getZoomScale(map.getZoom(), 0)) ** 2;
  for (let i = 0; i < x.length; ++i) {
    const d = (x[i] - latlng.lng) ** 2 + (y[i] - latlng.lat) ** 2;
    if (d < least) { least = d; best = i; }
  }
  return best;
}
