// SPDX-License-Identifier: BSD-3-Clause
// Charts as SVG: lines over a quantity, bars beside names. Every series differs by more than its colour.
import { responsive, s } from './dom.js'

const DASHES = [null, '7 4', '2 3', '9 3 2 3', '1 4', '12 4']
const MARKS = ['circle', 'square', 'diamond', 'triangle', 'cross', 'ring']

function mark(kind, x, y, stroke) {
  const r = 4
  const shape = { square: `M${x - r} ${y - r}h${2 * r}v${2 * r}h${-2 * r}z`, diamond: `M${x} ${y - r - 1}l${r + 1} ${r + 1}l${-r - 1} ${r + 1}l${-r - 1} ${-r - 1}z`,
    triangle: `M${x} ${y - r - 1}l${r + 1} ${2 * r}h${-2 * r - 2}z`, cross: `M${x - r} ${y - r}l${2 * r} ${2 * r}m0 ${-2 * r}l${-2 * r} ${2 * r}` }[kind]
  return shape ? s('path', { d: shape, fill: kind === 'cross' ? 'none' : stroke, stroke }) : s('circle', { cx: x, cy: y, r, fill: kind === 'ring' ? 'var(--sheet)' : stroke, stroke, 'stroke-width': 1.5 })
}

/// About `most` round numbers from low to high.
function ticks(low, high, most) {
  const rough = (high - low) / most, power = 10 ** Math.floor(Math.log10(rough)), step = [1, 2, 5, 10].find((f) => f * power >= rough) * power
  const out = []
  for (let v = Math.ceil(low / step) * step; v <= high + step * 1e-6; v += step) out.push(+v.toPrecision(12))
  return out
}

function logTicks(low, high, most) {
  const all = []
  for (let e = Math.floor(Math.log10(low)); e <= Math.ceil(Math.log10(high)); ++e) all.push(10 ** e)
  const fitting = all.filter((v) => v >= low * 0.999 && v <= high * 1.001)
  return fitting.length >= 2 ? fitting.slice(0, most) : ticks(low, high, 4).filter((v) => v > 0)
}

function axis(values, log, fromZero) {
  let low = Math.min(...values), high = Math.max(...values)
  if (log) return { low: low / 1.35, high: high * 1.5, at: (v, l, h) => Math.log(v / l) / Math.log(h / l) }
  if (fromZero) low = Math.min(0, low)
  if (high === low) high = low + 1
  return { low, high: high + 0.06 * (high - low), at: (v, l, h) => (v - l) / (h - l) }
}

/// chart: {alt, height, x: {name, format, log, ticks, reversed}, y: {format, log}, series: [{name, points: [[x, y]], ours, level}],
/// markers: [{x, text}]}. A series of one level is a line across.
export function lineChart(chart) {
  return responsive((width) => {
    const height = chart.height ?? 260, left = 58, right = chart.right ?? 16, top = 12, bottom = 42
    const all = chart.series.flatMap((series) => series.points ?? [])
    const ys = [...all.map((p) => p[1]), ...chart.series.filter((series) => series.level).map((series) => series.level)]
    const xAxis = axis(all.map((p) => p[0]), chart.x.log, false), yAxis = axis(ys, chart.y.log, true)
    if (!chart.x.log) { xAxis.low = Math.min(...all.map((p) => p[0])); xAxis.high = Math.max(...all.map((p) => p[0]), xAxis.low + 1e-9) }
    const across = (v) => { const f = xAxis.at(v, xAxis.low, xAxis.high); return left + (chart.x.reversed ? 1 - f : f) * (width - left - right) }
    const up = (v) => height - bottom - yAxis.at(v, yAxis.low, yAxis.high) * (height - top - bottom)
    const parts = []
    for (const v of chart.y.log ? logTicks(yAxis.low, yAxis.high, 7) : ticks(yAxis.low, yAxis.high, 4))
      parts.push(s('line', { x1: left, x2: width - right, y1: up(v), y2: up(v), stroke: 'var(--line)' }), s('text', { x: left - 7, y: up(v) + 4, 'text-anchor': 'end', 'font-size': 11.5, class: 'muted' }, chart.y.format(v)))
    for (const v of chart.x.ticks ?? ticks(xAxis.low, xAxis.high, Math.max(2, Math.floor(width / 110))))
      parts.push(s('text', { x: across(v), y: height - bottom + 17, 'text-anchor': 'middle', 'font-size': 11.5, class: 'muted' }, chart.x.format(v)))
    parts.push(s('text', { x: left + (width - left - right) / 2, y: height - 7, 'text-anchor': 'middle', 'font-size': 11.5, class: 'muted' }, chart.x.name))
    for (const { x, text } of chart.markers ?? [])
      parts.push(s('line', { x1: across(x), x2: across(x), y1: top, y2: height - bottom, stroke: 'var(--muted)', 'stroke-dasharray': '2 3' }),
        s('text', { x: across(x) + (across(x) > width * 0.6 ? -6 : 6), y: top + 8, 'font-size': 11.5, 'text-anchor': across(x) > width * 0.6 ? 'end' : 'start', class: 'halo muted' }, text))
    chart.series.forEach((series, i) => {
      const stroke = series.ours ? 'var(--accent)' : series.lost ? 'var(--lost)' : 'var(--muted)', wide = series.ours ? 2.6 : 1.6
      if (series.level) parts.push(s('line', { x1: left, x2: width - right, y1: up(series.level), y2: up(series.level), stroke, 'stroke-width': wide }, s('title', {}, series.name)))
      if (!series.points) return
      const line = series.points.map((p, k) => `${k ? 'L' : 'M'}${across(p[0]).toFixed(1)} ${up(p[1]).toFixed(1)}`).join('')
      parts.push(s('path', { d: line, fill: 'none', stroke, 'stroke-width': wide, 'stroke-dasharray': series.ours ? null : DASHES[i % DASHES.length], 'stroke-linejoin': 'round' }, s('title', {}, series.name)))
      if (series.points.length <= 8) for (const p of series.points) parts.push(mark(MARKS[i % MARKS.length], across(p[0]), up(p[1]), stroke))
    })
    return [s('svg', { viewBox: `0 0 ${width} ${height}`, width, height, role: 'img', 'aria-label': chart.alt }, parts), key(chart.series)]
  }, { class: 'chart' })
}

/// Names of the series with the line that each is drawn by.
function key(list) {
  const items = list.map((series, i) => {
    const stroke = series.ours ? 'var(--accent)' : series.lost ? 'var(--lost)' : 'var(--muted)'
    const sample = s('svg', { width: 30, height: 11, 'aria-hidden': 'true' }, s('line', { x1: 0, x2: 30, y1: 5.5, y2: 5.5, stroke, 'stroke-width': series.ours ? 2.6 : 1.6, 'stroke-dasharray': series.ours ? null : DASHES[i % DASHES.length] }),
      series.points && series.points.length <= 8 ? mark(MARKS[i % MARKS.length], 15, 5.5, stroke) : [])
    const item = document.createElement('li')
    item.append(sample, ' ', series.name)
    return item
  })
  const all = document.createElement('ul')
  all.className = 'key'
  all.append(...items)
  return all
}

/// rows: [{name, value, text, kind: 'ours'|'lost'|'aside'}]; names over their bars where it is narrow.
export function barChart({ rows, alt, most }) {
  const highest = most ?? Math.max(...rows.map((row) => row.value), 1e-12)
  return responsive((width) => {
    const above = width < 460, longest = Math.max(...rows.map((row) => row.name.length)), nameWidth = above ? 0 : Math.min(14 + 7.4 * longest, width * 0.5), textWidth = 92, step = above ? 40 : 26
    const height = step * rows.length + 2, parts = []
    rows.forEach((row, i) => {
      const y = i * step + (above ? 20 : 4), wide = Math.max(row.value > 0 ? 1.5 : 0, (row.value / highest) * (width - nameWidth - textWidth))
      const fill = { ours: 'var(--accent)', lost: 'var(--lost)', aside: 'var(--line)' }[row.kind] ?? 'var(--other)'
      parts.push(s('text', above ? { x: 0, y: y - 6, 'font-size': 12.5 } : { x: nameWidth - 12, y: y + 12.5, 'text-anchor': 'end', 'font-size': 13 }, row.name),
        s('rect', { x: nameWidth, y: y, width: wide, height: 15, rx: 2, fill, stroke: row.kind === 'aside' ? 'var(--other)' : null, 'stroke-dasharray': row.kind === 'aside' ? '3 2' : null }),
        s('text', { x: nameWidth + wide + 7, y: y + 12.5, 'font-size': 12.5, class: row.kind === 'ours' ? null : 'muted' }, row.text))
    })
    return s('svg', { viewBox: `0 0 ${width} ${height}`, width, height, role: 'img', 'aria-label': alt }, parts)
  }, { class: 'chart' })
}

/// One bar of two parts that make a whole: kept and lost.
export function shareBar(kept, alt) {
  return responsive((width) => s('svg', { viewBox: `0 0 ${width} 16`, width, height: 16, role: 'img', 'aria-label': alt },
    s('rect', { x: 0, y: 0, width: Math.max(0, kept * width - 1), height: 16, rx: 2, fill: 'var(--accent)' }),
    s('rect', { x: kept * width + 1, y: 0, width: Math.max(0, (1 - kept) * width - 1), height: 16, rx: 2, fill: 'var(--lost)' })))
}
