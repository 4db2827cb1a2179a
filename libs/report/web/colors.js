// Colours that charts and maps share; they follow the scheme of the page.

const kTimeScale = ['#2743b8', '#7b2fbf', '#c2338f', '#e8604c', '#f0961e'];
const kSigmaScale = ['#1a8f78', '#7ba428', '#e0a100', '#e0651c', '#c41f3a'];
const kAccepted = '#1f9d4c', kRejected = '#d83a30', kChain = '#7d8794', kFrame = '#1668c7', kHighlight = '#ff9d00';
const kRunColors = ['#2a78d0', '#d9542b', '#1f9d4c', '#8b4fc8', '#b8860b', '#c2338f', '#0f9aa8', '#6b7280'];

function runColor(k) { return kRunColors[k % kRunColors.length]; }

function themeColor(name) { return getComputedStyle(document.documentElement).getPropertyValue(`--${name}`).trim(); }

function channels(hex) { return [1, 3, 5].map((i) => parseInt(hex.slice(i, i + 2), 16)); }

/** Colour of a scale at `share` in [0, 1]. */
function scaleColor(scale, share) {
  const at = Math.min(Math.max(share, 0), 1) * (scale.length - 1), low = Math.min(Math.floor(at), scale.length - 2);
  const a = channels(scale[low]), b = channels(scale[low + 1]);
  return `rgb(${a.map((c, i) => Math.round(c + (at - low) * (b[i] - c))).join(' ')})`;
}

function gradient(scale) { return `linear-gradient(to right, ${scale.join(', ')})`; }

/** Calls `redraw` now and whenever the scheme of the page changes. */
function followScheme(redraw) {
  redraw();
  window.matchMedia('(prefers-color-scheme: dark)').addEventListener('change', redraw);
}
