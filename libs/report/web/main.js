// Shows what the data block holds.

const data = JSON.parse(document.getElementById('data').textContent);
document.getElementById('made-by').textContent = 'Made by submap-slam. This page is complete in itself and fetches nothing. In charts, drag to zoom and double-click to go back.';
({ run: showRun, comparison: showComparison, experiment: showExperiment })[data.kind](data);
