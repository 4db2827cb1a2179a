// Small helpers that build the page. All text goes in as text, never as markup.

/** An element; `attributes` may hold event listeners as onNAME, children are nodes or text. */
function element(tag, attributes, ...children) {
  const node = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes || {})) {
    if (value === undefined || value === false) continue;
    if (typeof value === 'function') node.addEventListener(name.slice(2), value);
    else node.setAttribute(name, value === true ? '' : value);
  }
  node.append(...children.filter((child) => child !== undefined && child !== null));
  return node;
}

/** A panel at the end of the page: heading and one sentence that says how to read it. Returns the panel. */
function addPanel(id, title, how, wide) {
  const panel = element('section', { id, class: wide ? 'panel wide' : 'panel' },
    element('h2', {}, title), element('p', { class: 'how' }, how));
  document.getElementById('panels').append(panel);
  return panel;
}

function addHead(title, lead, tiles) {
  document.title = `${title} · submap-slam`;
  document.getElementById('head').append(
    element('h1', {}, title), element('p', { class: 'lead' }, lead),
    element('dl', { class: 'tiles' }, ...tiles.map(([name, value, detail]) =>
      element('div', { class: 'tile' }, element('dt', {}, name),
        element('dd', {}, value, detail ? element('small', {}, ` ${detail}`) : null)))));
}

function checkbox(label, checked, onChange, mark) {
  const box = element('input', { type: 'checkbox', checked, onchange: () => onChange(box.checked) });
  return element('label', {}, box, mark, label);
}

/** @param options [value, text] each */
function choice(label, options, chosen, onChange) {
  const select = element('select', { onchange: () => onChange(select.value) },
    ...options.map(([value, text]) => element('option', { value, selected: value === chosen }, text)));
  return element('label', {}, label, select);
}

/** A sample of how something is drawn: 'line', 'dashed' or 'dot'. */
function swatch(color, form = 'line') {
  const mark = element('span', { class: `swatch ${form}` });
  mark.style.color = color;
  return mark;
}
