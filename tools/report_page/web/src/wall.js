// SPDX-License-Identifier: BSD-3-Clause
// The paper's Fig. 5: one plane as raw points and as a plane, at the same scale.
import { figure, h, responsive, s } from './dom.js'
import { inPlane } from './model.js'
import { count, plural } from './text.js'

const MARGIN_PX = 16

/// The wall with the most points; without walls any plane.
function chosen(model) {
  const hits = new Map()
  for (const index of model.points.planes) if (index >= 0 && model.byIndex[index]) hits.set(index, (hits.get(index) ?? 0) + 1)
  const all = [...hits].sort((a, b) => b[1] - a[1]), walls = all.filter(([index]) => model.byIndex[index].label === 'wall')
  return (walls[0] ?? all[0] ?? [null])[0]
}

function frameOf(flat, width) {
  const xs = flat.map((p) => p[0]), ys = flat.map((p) => p[1]), low = [Math.min(...xs), Math.min(...ys)], high = [Math.max(...xs), Math.max(...ys)]
  const wide = Math.max(high[0] - low[0], 0.1), tall = Math.max(high[1] - low[1], 0.1)
  const scale = Math.min((width - 2 * MARGIN_PX) / wide, 340 / tall), left = (width - wide * scale) / 2, height = Math.round(tall * scale + 2 * MARGIN_PX)
  return { height, to: ([x, y]) => [left + (x - low[0]) * scale, height - MARGIN_PX - (y - low[1]) * scale] }
}

export function wall(model) {
  const index = chosen(model)
  if (index === null) return null
  const plane = model.byIndex[index], flat = inPlane(plane), outline = flat.rings.flat(), { points } = model
  const own = []
  for (let i = 0; i < points.n; ++i) if (points.planes[i] === index) own.push(i)
  const name = `${plane.label} ${plane.id}`
  const raw = responsive((width) => {
    const { height, to } = frameOf(outline, width), canvas = document.createElement('canvas'), ratio = Math.min(2, devicePixelRatio || 1)
    for (const [key, value] of [['role', 'img'], ['aria-label', `${name} as ${count(own.length)} raw points`]]) canvas.setAttribute(key, value)
    canvas.width = width * ratio
    canvas.height = height * ratio
    canvas.style.cssText = `width:${width}px;height:${height}px`
    const context = canvas.getContext('2d'), size = 1.6 * ratio
    for (const i of own) {
      const [x, y] = to(flat.flat(points.positions.subarray(3 * i, 3 * i + 3)))
      context.fillStyle = `rgb(${points.colors[3 * i]},${points.colors[3 * i + 1]},${points.colors[3 * i + 2]})`
      context.fillRect(x * ratio - size / 2, y * ratio - size / 2, size, size)
    }
    return canvas
  }, { class: 'frame' })
  const drawn = responsive((width) => {
    const { height, to } = frameOf(outline, width)
    const d = flat.rings.map((ring) => ring.map((p, i) => `${i ? 'L' : 'M'}${to(p).map((v) => v.toFixed(1)).join(' ')}`).join('') + 'Z').join('')
    return s('svg', { viewBox: `0 0 ${width} ${height}`, width, height, role: 'img', 'aria-label': `${name} as a plane: an outline of ${outline.length} corners` },
      s('path', { d, 'fill-rule': 'evenodd', fill: 'var(--floor)', stroke: 'var(--accent)', 'stroke-width': 1.8, 'stroke-linejoin': 'round' }),
      outline.length <= 300 ? outline.map((p) => { const [cx, cy] = to(p); return s('circle', { cx, cy, r: 2.2, fill: 'var(--accent)' }) }) : [])
  }, { class: 'frame' })
  const rings = flat.rings.length > 1 ? ` in ${plural(flat.rings.length, 'ring')}` : ''
  return h('div', { class: 'two', style: 'margin-top:2rem' },
    figure(raw, `${name} as points (Fig. 5 top): ${count(own.length)} of this page’s sample lie on it.`),
    figure(drawn, `The same as a plane (Fig. 5 bottom): a normal, a distance and ${plural(outline.length, 'corner')}${rings}, ${plane.area.toFixed(2)} m².`))
}
