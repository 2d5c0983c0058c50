// Elements with text. Nothing here takes markup, so that file names and messages stay text.

function make(node, attributes, children) {
  for (const [name, value] of Object.entries(attributes)) {
    if (name.startsWith('on')) node.addEventListener(name.slice(2), value);
    else if (value === true) node.setAttribute(name, '');
    else if (value !== false && value !== null && value !== undefined) node.setAttribute(name, value);
  }
  node.append(...children.flat(Infinity).filter((child) => child !== null && child !== undefined));
  return node;
}

/** An HTML element. Attributes "onclick" and the like are listeners; children are nodes or text. */
export const el = (tag, attributes = {}, ...children) =>
  make(document.createElement(tag), attributes, children);

/** An SVG element. */
export const svg = (tag, attributes = {}, ...children) =>
  make(document.createElementNS('http://www.w3.org/2000/svg', tag), attributes, children);

/** A section with a heading; null where it would be empty. */
export function section(id, heading, ...content) {
  const kept = content.flat(Infinity).filter((child) => child !== null && child !== undefined);
  if (kept.length === 0) return null;
  return el('section', { id, 'aria-labelledby': `${id}-heading` },
    el('h2', { id: `${id}-heading` }, heading), kept);
}

/**
 * A table whose heading cells are `heads`: { text, number } with number for columns of figures.
 * A row is a list of cells, texts or nodes. The box around the table scrolls where it is too wide.
 */
export function table(caption, heads, rows) {
  const cell = (tag, content, head, extra = {}) =>
    el(tag, { class: head.number ? 'number' : null, ...extra }, content);
  return el('div', { class: 'scroll', tabindex: '0', role: 'region', 'aria-label': caption },
    el('table', {},
      el('caption', { class: 'hidden' }, caption),
      el('thead', {}, el('tr', {}, heads.map((head) => cell('th', head.text, head, { scope: 'col' })))),
      el('tbody', {}, rows.map((row) => el('tr', {}, row.map((content, i) => cell('td', content, heads[i])))))));
}

/** A table of names and texts. */
export function pairs(caption, rows) {
  return el('table', { class: 'pairs' },
    el('caption', { class: 'hidden' }, caption),
    el('tbody', {}, rows.map(([name, text]) =>
      el('tr', {}, el('th', { scope: 'row' }, name), el('td', {}, text)))));
}
