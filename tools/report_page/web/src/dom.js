// SPDX-License-Identifier: BSD-3-Clause
// Elements from plain values. Text of the data only ever becomes text nodes and attributes.
const SVG = 'http://www.w3.org/2000/svg'

function fill(node, attributes, children) {
  for (const [name, value] of Object.entries(attributes ?? {})) {
    if (value === null || value === undefined || value === false) continue
    if (name.startsWith('on')) node.addEventListener(name.slice(2), value)
    else node.setAttribute(name, value === true ? '' : String(value))
  }
  node.append(...children.flat(3).filter((child) => child !== null && child !== undefined && child !== false))
  return node
}

export const h = (tag, attributes, ...children) => fill(document.createElement(tag), attributes, children)
export const s = (tag, attributes, ...children) => fill(document.createElementNS(SVG, tag), attributes, children)

/// A picture drawn anew for each width that the page gives it, and when the colours change. `draw(width)` returns nodes.
export function responsive(draw, attributes = {}) {
  const box = h('div', attributes)
  let width = 0
  const again = () => width > 0 && box.replaceChildren(...[draw(width)].flat())
  new ResizeObserver(() => requestAnimationFrame(() => {  // what is drawn changes the box's height, not its width
    const now = Math.floor(box.clientWidth)
    if (now === width || now <= 0) return
    width = now
    again()
  })).observe(box)
  matchMedia('(prefers-color-scheme: dark)').addEventListener('change', again)
  return box
}

export const figure = (picture, caption) => h('figure', {}, picture, caption ? h('figcaption', {}, caption) : null)

/// Columns are {name, number, wrap}; a row is {cells, kind} or an array of cells, the first one its heading.
export function table(caption, columns, rows) {
  const kind = (column, more = '') => [column.number ? 'n' : '', column.wrap ? 'wrap' : '', more].join(' ').trim() || null
  const head = h('tr', {}, columns.map((column) => h('th', { scope: 'col', class: kind(column) }, column.name)))
  const body = rows.map((row) => {
    const cells = row.cells ?? row
    return h('tr', { class: row.kind },
      cells.map((cell, i) => h(i === 0 ? 'th' : 'td', { scope: i === 0 ? 'row' : null, class: kind(columns[i]) }, cell ?? '–')))
  })
  return h('div', { class: 'scroll', tabindex: '0', role: 'region', 'aria-label': caption },
    h('table', {}, h('caption', {}, caption), h('thead', {}, head), h('tbody', {}, body)))
}

export const details = (summary, ...content) => h('details', {}, h('summary', {}, summary), ...content)
export const unknown = (text) => h('p', { class: 'unknown' }, text)
export const color = (name) => getComputedStyle(document.documentElement).getPropertyValue(name).trim()
