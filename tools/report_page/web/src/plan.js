// SPDX-License-Identifier: BSD-3-Clause
// The map from above: planes, distances, the way of the camera, and points under them.
import { color, responsive, s } from './dom.js'
import { metres } from './text.js'
import { cross, dot } from './vector.js'

let tips = 0  // each drawing has an arrow tip of its own
const MARGIN_PX = 26
const STEP_M = 0.05

/// Pieces of an upright plane seen from above: [[from, to], ...]; openings that reach from bottom to top are left out.
export function footprint(plane, rings = plane.rings) {
  const along = cross([0, 0, 1], plane.normal), n = Math.hypot(along[0], along[1])
  const axis = along.map((value) => value / n)
  const edges = rings.flatMap((ring) => ring.map((p, i) => [dot(p, axis), dot(ring[(i + 1) % ring.length], axis)]))
  const ends = edges.flat(), low = Math.min(...ends), high = Math.max(...ends)
  const steps = Math.max(1, Math.ceil((high - low) / STEP_M)), pieces = []
  const foot = (t) => {
    const c = plane.center, move = t - dot(c, axis)
    return [c[0] + move * axis[0], c[1] + move * axis[1]]
  }
  let start = null
  for (let i = 0; i <= steps; ++i) {
    const middle = low + ((i + 0.5) / steps) * (high - low)
    const covered = i < steps && edges.some(([a, b]) => (a <= middle) !== (b <= middle))
    const t = low + (i / steps) * (high - low)
    if (covered && start === null) start = t
    if (!covered && start !== null) { pieces.push([foot(start), foot(t)]); start = null }
  }
  return pieces
}

const isUpright = (plane) => plane.label === 'wall' || plane.label === 'vertical' || (Math.abs(plane.normal[2]) < 0.3 && plane.label !== 'other')
const isLevel = (plane) => Math.abs(plane.normal[2]) > 0.9

/// Metres to pixels: x to the right, y up the page; the longer side of the room lies along the page.
export function projection(bounds, width, tallest) {
  const sides = [bounds.high[0] - bounds.low[0], bounds.high[1] - bounds.low[1]].map((side) => Math.max(side, 0.5))
  const turned = sides[1] > 1.15 * sides[0] && width > 500
  const [wide, high] = turned ? [sides[1], sides[0]] : sides
  const scale = Math.min((width - 2 * MARGIN_PX) / wide, (tallest - 2 * MARGIN_PX) / high)
  const height = Math.round(high * scale + 2 * MARGIN_PX), left = (width - wide * scale) / 2
  const to = turned
    ? (p) => [left + (bounds.high[1] - p[1]) * scale, height - MARGIN_PX - (p[0] - bounds.low[0]) * scale]
    : (p) => [left + (p[0] - bounds.low[0]) * scale, height - MARGIN_PX - (p[1] - bounds.low[1]) * scale]
  return { to, scale, width, height }
}

const path = (points, to, close) => points.map((p, i) => `${i ? 'L' : 'M'}${to(p).map((v) => v.toFixed(1)).join(' ')}`).join('') + (close ? 'Z' : '')
const rings = (list, to) => list.map((ring) => path(ring, to, true)).join('')
const nameOf = (plane) => `plane ${plane.id}, ${plane.label}, ${plane.area.toFixed(2)} m²`

function planeShapes(model, { to }) {
  const shapes = []
  const level = model.planes.filter((plane) => !isUpright(plane) && plane.label !== 'ceiling')
  const rank = (plane) => (plane.label === 'floor' ? 0 : 1)
  for (const plane of level.sort((a, b) => rank(a) - rank(b) || a.center[2] - b.center[2])) {
    const floor = plane.label === 'floor', oblique = !isLevel(plane)
    shapes.push(s('path', {
      d: rings(plane.rings, to), 'fill-rule': 'evenodd', fill: floor ? 'var(--floor)' : oblique ? 'none' : 'var(--furniture)',
      stroke: 'var(--other)', 'stroke-width': floor ? 0 : 1,
    }, s('title', {}, nameOf(plane))))
  }
  for (const plane of model.planes.filter((plane) => plane.label !== 'ceiling'))
    if (plane.inferred.length > 0 && !isUpright(plane))
      shapes.push(s('path', { d: rings(plane.inferred, to), fill: 'none', stroke: 'var(--other)', 'stroke-dasharray': '3 3' }))
  for (const plane of model.planes.filter(isUpright).sort((a, b) => (a.label === 'wall') - (b.label === 'wall'))) {
    const wall = plane.label === 'wall'
    if (plane.inferred.length > 0)
      shapes.push(s('path', { d: footprint(plane, plane.inferred).map((piece) => path(piece, to)).join(''), stroke: 'var(--muted)', 'stroke-width': 1.5, 'stroke-dasharray': '3 3' }))
    shapes.push(s('path', { d: footprint(plane).map((piece) => path(piece, to)).join(''), stroke: wall ? 'var(--ink)' : 'var(--muted)', 'stroke-width': wall ? 3.5 : 1.8, 'stroke-linecap': 'round', fill: 'none' },
      s('title', {}, nameOf(plane))))
  }
  return shapes
}

/// Keeps texts from lying on one another.
class Places {
  taken = []
  constructor(width, height) { this.width = width; this.height = height }
  free(x, y, text, size) {
    const w = 0.58 * size * text.length, box = [x - w / 2 - 2, y - size * 0.75, x + w / 2 + 2, y + size * 0.75]
    if (box[0] < 0 || box[1] < 0 || box[2] > this.width || box[3] > this.height) return false
    return this.taken.every((other) => box[2] < other[0] || other[2] < box[0] || box[3] < other[1] || other[3] < box[1]) && !!this.taken.push(box)
  }
}

function dimensions(rooms, { to }, places, tip) {
  const shapes = []
  for (const pair of rooms.slice(0, 10)) {
    const text = metres(pair.distance)
    for (const share of [0.5, 0.3, 0.7, 0.15, 0.85, 0.4, 0.6]) {
      const { from, to: end } = pair.at(share), [x1, y1] = to(from), [x2, y2] = to(end)
      const x = (x1 + x2) / 2, y = (y1 + y2) / 2
      if (Math.hypot(x2 - x1, y2 - y1) < 34 || !places.free(x, y, text, 13)) continue
      shapes.push(
        s('line', { x1, y1, x2, y2, stroke: 'var(--accent)', 'stroke-width': 1, 'marker-start': `url(#${tip})`, 'marker-end': `url(#${tip})` }),
        s('text', { x, y: y + 4.5, 'text-anchor': 'middle', 'font-size': 13, 'font-weight': 600, class: 'halo', style: 'fill:var(--accent)' }, text))
      break
    }
  }
  return shapes
}

const LABEL_WORDS = { floor: 'floor', wall: 'wall', horizontal: 'level', vertical: 'upright', other: 'oblique', unknown: '' }

function labels(model, { to }, places) {
  const shapes = []
  for (const plane of [...model.planes].filter((plane) => plane.label !== 'ceiling').sort((a, b) => b.area - a.area).slice(0, 40)) {
    const text = `${LABEL_WORDS[plane.label] ?? plane.label} ${plane.id}`.trim()
    let [x, y] = to(plane.center)
    if (isUpright(plane)) {  // on the side that was not seen: outside of the room
      const [fx, fy] = to([plane.center[0] - plane.normal[0], plane.center[1] - plane.normal[1]]), n = Math.hypot(fx - x, fy - y) || 1
      const off = Math.abs(fx - x) > Math.abs(fy - y) ? 8 + 3.2 * text.length : 12
      x += (off * (fx - x)) / n
      y += (off * (fy - y)) / n
    }
    if (places.free(x, y, text, 11)) shapes.push(s('text', { x, y: y + 4, 'text-anchor': 'middle', 'font-size': 11, class: 'halo muted' }, text))
  }
  return shapes
}

function way(trajectory, { to }) {
  if (trajectory.length === 0) return []
  const [x, y] = to(trajectory[0]), [ex, ey] = to(trajectory.at(-1))
  return [
    s('path', { d: path(trajectory, to), fill: 'none', stroke: 'var(--accent)', 'stroke-width': 1.6, 'stroke-linejoin': 'round', opacity: 0.9 }),
    s('circle', { cx: x, cy: y, r: 4, fill: 'var(--accent)' }, s('title', {}, 'the way begins here')),
    s('circle', { cx: ex, cy: ey, r: 4, fill: 'var(--sheet)', stroke: 'var(--accent)', 'stroke-width': 2 }, s('title', {}, 'the way ends here'))]
}

function scaleBar({ scale, width, height }) {
  const length_m = [10, 5, 2, 1, 0.5, 0.2].find((length) => length * scale <= width / 4) ?? 0.1
  const x2 = width - 12, x1 = x2 - length_m * scale, y = height - 10
  return [s('path', { d: `M${x1} ${y - 4}V${y}H${x2}V${y - 4}`, fill: 'none', stroke: 'var(--muted)' }),
    s('text', { x: (x1 + x2) / 2, y: y - 6, 'font-size': 11, 'text-anchor': 'middle', class: 'muted halo' }, `${length_m} m`)]
}

/// Which points to see from above: what hangs at the ceiling hides the room.
export const isBelowCeiling = (model, i) => {
  const plane = model.points.planes[i] >= 0 ? model.byIndex[model.points.planes[i]] : null
  return plane?.label !== 'ceiling' && model.points.positions[3 * i + 2] < model.ceiling - 0.15
}

/// kind: 'photo' (as the camera saw them), 'missed' (red those on no plane, the others grey).
export function pointPicture(model, kind, { to, width, height }) {
  const canvas = document.createElement('canvas'), ratio = Math.min(2, devicePixelRatio || 1), { points } = model
  canvas.width = width * ratio
  canvas.height = height * ratio
  canvas.style.cssText = `width:${width}px;height:${height}px`
  const context = canvas.getContext('2d'), size = Math.max(1.2, 1.1 * ratio)
  const draw = (i, style) => {
    const [x, y] = to(points.positions.subarray(3 * i, 3 * i + 2))
    context.fillStyle = style
    context.fillRect(x * ratio - size / 2, y * ratio - size / 2, size, size)
  }
  const shown = Array.from({ length: points.n }, (_, i) => i).filter((i) => isBelowCeiling(model, i))
  if (kind === 'photo') {
    shown.sort((a, b) => points.positions[3 * a + 2] - points.positions[3 * b + 2])
    for (const i of shown) draw(i, `rgb(${points.colors[3 * i]},${points.colors[3 * i + 1]},${points.colors[3 * i + 2]})`)
  } else {
    const grey = color('--cloud'), red = color('--lost')
    for (const i of shown) if (points.planes[i] !== -1) draw(i, grey)
    for (const i of shown) if (points.planes[i] === -1) draw(i, red)
  }
  return canvas
}

/// options: {points, planes, distances, way, alt, tallest}.
export function plan(model, options) {
  return responsive((width) => {
    const view = projection(model.bounds, width, options.tallest ?? Math.max(320, Math.min(620, 0.9 * width)))
    const places = new Places(width, view.height), tip = `tip-${++tips}`
    const distances = options.distances ? dimensions(options.distances, view, places, tip) : []
    const drawing = s('svg', { viewBox: `0 0 ${width} ${view.height}`, width, height: view.height, role: 'img', 'aria-label': options.alt, class: options.points ? 'over-canvas' : null },
      s('defs', {}, s('marker', { id: tip, viewBox: '0 0 6 6', refX: 5.5, refY: 3, markerWidth: 7, markerHeight: 7, orient: 'auto-start-reverse' }, s('path', { d: 'M0 .5L5.5 3L0 5.5', fill: 'none', stroke: 'var(--accent)' }))),
      options.planes ? planeShapes(model, view) : [],
      options.way ? way(model.trajectory, view) : [],
      distances,
      options.planes && options.labels !== false ? labels(model, view, places) : [],
      scaleBar(view))
    return options.points ? [pointPicture(model, options.points, view), drawing] : drawing
  }, { class: 'frame' })
}
