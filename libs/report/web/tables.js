// Tables that can be sorted by their headings and shortened.

const kRowsAtFirst = 100;

function cellOf(column, row) {
  const content = column.show ? column.show(row) : row[column.key];
  return element('td', { class: column.kind || 'number' }, content instanceof Node ? content : String(content));
}

/** Column headings sort; a second click turns the order round. */
class DataTable {
  /** @param columns {key, title, kind: 'number' | 'text' | …, show: row → text or node, by: row → what to sort by}
   *  @param options onRow(row, clicked) for rows that are linked with something else;
   *                 narrow: widths of all columns but the last, which gets a line of its own on narrow screens */
  constructor(columns, rows, options = {}) {
    Object.assign(this, { columns, all: rows, shown: rows, options, limit: kRowsAtFirst });
    this.body = element('tbody');
    this.more = element('button', { type: 'button', onclick: () => { this.limit = Infinity; this.fill(); } });
    this.table = element('table', { class: options.narrow ? 'data folds' : 'data' },
      element('thead', {}, element('tr', {}, ...columns.map((c) => this.heading(c)))), this.body);
    if (options.narrow) this.table.style.setProperty('--columns', options.narrow);
    this.node = element('div', {}, element('div', { class: 'scroll', tabindex: 0 }, this.table), this.more);
    this.fill();
  }

  heading(column) {
    const sort = () => {
      this.ascending = this.sortedBy === column ? !this.ascending : column.kind === 'text';
      this.sortedBy = column;
      this.fill();
    };
    return element('th', { class: column.kind || 'number', scope: 'col' },
      element('button', { type: 'button', title: column.hint || 'sort', onclick: sort }, column.title));
  }

  filter(keep) {
    this.shown = this.all.filter(keep);
    this.fill();
  }

  sorted() {
    if (!this.sortedBy) return this.shown;
    const by = this.sortedBy.by || ((row) => row[this.sortedBy.key]);
    const sign = this.ascending ? 1 : -1;
    return [...this.shown].sort((a, b) => {
      const x = by(a), y = by(b);
      if (x === null || y === null) return (x === null) - (y === null);
      return sign * (x < y ? -1 : x > y ? 1 : 0);
    });
  }

  fill() {
    this.rowNodes = new Map();
    this.body.replaceChildren(...this.sorted().slice(0, this.limit).map((row) => this.rowNode(row)));
    const hidden = this.shown.length - this.limit;
    this.more.hidden = !(hidden > 0);
    this.more.textContent = `Show ${hidden} more rows`;
  }

  rowNode(row) {
    const { onRow } = this.options;
    const events = onRow ? {
      class: 'linked', tabindex: 0, onmouseenter: () => onRow(row, false), onfocus: () => onRow(row, false),
      onclick: () => onRow(row, true), onkeydown: (event) => { if (event.key === 'Enter') onRow(row, true); },
    } : {};
    const node = element('tr', events, ...this.columns.map((column) => cellOf(column, row)));
    this.rowNodes.set(row, node);
    return node;
  }

  /** Marks the row, and scrolls the table to it if it is out of sight. */
  choose(row, scroll) {
    for (const node of this.rowNodes.values()) node.classList.remove('chosen');
    const node = this.rowNodes.get(row);
    if (!node) return;
    node.classList.add('chosen');
    const box = node.closest('.scroll');
    if (scroll) box.scrollTop = node.offsetTop - box.clientHeight / 2;
  }
}
