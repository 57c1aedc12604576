// SPDX-License-Identifier: BSD-3-Clause
// What each map takes, over resolutions and as a table that says what each size holds.
import { barChart, lineChart } from './charts.js'
import { details, figure, h, table, unknown } from './dom.js'
import { get, headlineOf, MAP_NAMES, sizeRows } from './figures.js'
import { bytes, edge, isNumber, round, times, yesNo } from './text.js'

const compressed = (row) => row.zstd_bytes ?? row.bytes
const nameOf = (row) => [MAP_NAMES[row.map] ?? row.map, row.form].filter(Boolean).join(', ')
const GOES_ON = { no: 'no', 'fixed poses': 'with fixed poses', corrections: 'and follows corrections' }

/// Files of occupied space alone, by map and form, over at least two resolutions.
function seriesOf(rows) {
  const byName = new Map()
  for (const row of rows) {
    if (row.map === 'planes' || row.place !== 'file' || row.goes_on !== 'no' || row.explained_only || !isNumber(row.resolution_m) || !(compressed(row) > 0)) continue
    const name = nameOf(row) + (row.free_space ? ' (with free space)' : '') + (isNumber(row.zstd_bytes) ? ', zstd' : '')
    if (!byName.has(name)) byName.set(name, { name, free: row.free_space, points: [] })
    byName.get(name).points.push([row.resolution_m, compressed(row)])
  }
  const series = [...byName.values()].filter((one) => one.points.length > 1)
  series.forEach((one) => one.points.sort((a, b) => a[0] - b[0]))
  return series.sort((a, b) => a.free - b.free || a.points[0][1] - b.points[0][1]).slice(0, 6)
}

function overResolutions(report, rows) {
  const series = seriesOf(rows), planes = headlineOf(report).planes
  if (series.length === 0 || !isNumber(planes)) return null
  const equal = get(report, 'accuracy_beside_size', 'equal_resolution_m') ?? {}, markers = []
  const stated = get(report, 'headline', 'resolution_m')
  if (isNumber(stated)) markers.push({ x: stated, text: `as accurate at ${edge(stated)}` })
  const ticks = [...new Set(series.flatMap((one) => one.points.map((p) => p[0])))]
  const all = [{ name: `plane map, message, zstd: ${bytes(planes)}, whatever the resolution`, level: planes, ours: true }, ...series]
  const inside = (m) => m.x >= Math.min(...ticks) && m.x <= Math.max(...ticks)
  const chart = lineChart({ height: 340, series: all, markers: markers.filter(inside),
    x: { name: 'edge of a voxel, finer to the right', format: edge, log: true, reversed: true, ticks }, y: { format: bytes, log: true },
    alt: `Size over resolution. The plane map takes ${bytes(planes)}. ` + series.map((one) => `${one.name}: ` + one.points.map(([r, b]) => `${bytes(b)} at ${edge(r)}`).join(', ')).join('; ') + '.' })
  const words = [equal.by_rms, equal.by_median].every(isNumber) ? ` By RMS, voxels of ${edge(equal.by_rms)} are as accurate as the planes; by the median, of ${edge(equal.by_median)}.` : ''
  return figure(chart, 'Files over the resolution, both axes logarithmic. Planes have no resolution: their line is flat.' + words)
}

function bars(report, rows) {
  const files = rows.filter((row) => row.place === 'file' && row.goes_on === 'no' && !row.explained_only && compressed(row) > 0)
  if (files.length < 2) return null
  const few = files.filter((row) => row.map !== 'cloud')
  const list = few.sort((a, b) => compressed(a) - compressed(b)).slice(0, 12).map((row) => ({
    name: nameOf(row) + (isNumber(row.resolution_m) ? `, ${edge(row.resolution_m)}` : ''), value: compressed(row), text: bytes(compressed(row)), kind: row.map === 'planes' ? 'ours' : row.free_space ? 'aside' : null }))
  return figure(barChart({ rows: list, alt: 'Sizes of files: ' + list.map((row) => `${row.name} ${row.text}`).join(', ') }), 'Files, compressed where that is known. Dashed: with free space, which planes do not hold.')
}

function accuracy(report) {
  const beside = get(report, 'accuracy_beside_size')
  if (!beside?.planes) return unknown('How accurate voxels of each size would be beside the planes was not measured.')
  const cm = (value) => (isNumber(value) ? round(100 * value) : null)
  const rows = [{ kind: 'ours', cells: ['planes', cm(beside.planes.rms_m), cm(beside.planes.median_m)] },
    ...(beside.leaves ?? []).map((leaf) => [`leaves of ${edge(leaf.resolution_m)}`, cm(leaf.rms_m), cm(leaf.median_m)])]
  return table('From depth readings to what stands for them, in cm, along the normal', [{ name: '' }, { name: 'RMS', number: true }, { name: 'median', number: true }], rows)
}

export function sizes(report) {
  const rows = sizeRows(report), planes = headlineOf(report).planes
  const section = h('section', { id: 'sizes' }, h('h2', {}, 'What each map takes'),
    h('p', { class: 'lead' }, 'The same recording as planes and as voxels and points, like with like: what holds free space, what can go on mapping, and what is compressed is said of every row.'))
  if (rows.length === 0) return section.append(unknown('No sizes are known of this folder.')), section
  const list = rows.map((row) => ({ kind: row.map === 'planes' ? 'ours' : null, cells: [
    (MAP_NAMES[row.map] ?? row.map) + (row.explained_only ? ' (what planes explain)' : ''), row.form, isNumber(row.resolution_m) ? edge(row.resolution_m) : null, bytes(row.bytes),
    isNumber(row.zstd_bytes) ? bytes(row.zstd_bytes) : null, isNumber(planes) && planes > 0 ? times((row.zstd_bytes ?? row.bytes) / planes) : null, row.place ?? null, yesNo(row.free_space), GOES_ON[row.goes_on] ?? row.goes_on] }))
  const columns = [{ name: 'map' }, { name: 'form', wrap: true }, { name: 'voxel', number: true }, { name: 'size', number: true }, { name: 'zstd', number: true }, { name: '× planes', number: true }, { name: 'where' }, { name: 'free space' }, { name: 'can go on' }]
  section.append(...[overResolutions(report, rows) ?? bars(report, rows)].filter(Boolean),
    details(`All ${rows.length} sizes as a table`, table(`“× planes”: compressed where that is known, beside the plane map’s message compressed (${bytes(planes)})`, columns, list)),
    h('h3', { style: 'margin-top:1.8rem' }, 'Accuracy beside size'), accuracy(report))
  return section
}

