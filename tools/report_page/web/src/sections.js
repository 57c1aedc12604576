// SPDX-License-Identifier: BSD-3-Clause
// The sections between the top and the tables at the end, each from the report and the model, each saying what is not known.
import { barChart, lineChart } from './charts.js'
import { details, figure, h, table, unknown } from './dom.js'
import { get } from './figures.js'
import { measure } from './measure.js'
import { plan } from './plan.js'
import { bytes, centimetres, count, isNumber, metres, milliseconds, percent, plural, seconds } from './text.js'
import { view3d } from './view3d.js'
import { wall } from './wall.js'

const section = (id, title, lead, ...content) => h('section', { id }, h('h2', {}, title), lead ? h('p', { class: 'lead' }, lead) : null, ...content.filter(Boolean))
const nameOf = (plane) => `${plane.label} ${plane.id}`

function distancesTable({ rooms, partitions, heights }) {
  const rows = [...heights.map((pair) => ['floor to ceiling', pair]), ...rooms.map((pair) => ['wall to wall', pair]), ...partitions.map((pair) => ['through a partition', pair])]
  if (rows.length === 0) return unknown('No two walls that face each other, and no ceiling over a floor: there are no distances to give.')
  const columns = [{ name: 'distance' }, { name: 'between' }, { name: 'and' }, { name: 'metres', number: true }]
  return details('All distances as a table', table('In the middle of where both planes are', columns, rows.map(([kind, pair]) => [kind, nameOf(pair.a), nameOf(pair.b), pair.distance.toFixed(3)])))
}

export function fromAbove(model) {
  if (!model.bounds) return section('plan', 'From above', null, unknown('There are no planes to draw.'))
  const measured = measure(model.planes), height = measured.heights[0]
  const widths = measured.rooms.slice(0, 10).map((pair) => `${nameOf(pair.a)} to ${nameOf(pair.b)} ${metres(pair.distance)}`)
  const alt = `Plan from above: ${plural(model.planes.length, 'plane')}. ` + (widths.length ? `Distances: ${widths.join(', ')}.` : 'No walls that face each other.')
  const caption = ['Walls thick, upright faces of furniture thin, level surfaces filled, the way of the camera from dot to ring. Numbers are the planes’ ids; blue figures are distances between walls that face each other. Dashed parts are inferred, nobody saw them.',
    height ? ` Floor to ceiling: ${metres(height.distance)}.` : '', model.upKnown ? '' : ' Which way is up is not known: how the camera was held stands for it.']
  return section('plan', 'From above', null, figure(plan(model, { planes: true, distances: measured.rooms, way: true, alt }), caption), distancesTable(measured))
}

export function inThree(model) {
  if (!model.bounds) return null
  return section('view', 'In three dimensions', null, view3d(model))
}

function rangeChart(ranges) {
  const known = ranges.filter((range) => isNumber(range.within_band))
  if (known.length === 0) return null
  const rows = known.map((range) => ({ name: `${range.from_m} to ${range.to_m} m`, value: 1 - range.within_band, text: `${percent(1 - range.within_band)} of ${count(range.readings)}`, kind: 'lost' }))
  return figure(barChart({ rows, most: Math.max(...rows.map((row) => row.value)) * 1.25, alt: 'Readings on no plane by range: ' + rows.map((row) => `${row.name} ${row.text}`).join(', ') }), 'Readings on no plane, by how far from the camera they were')
}

function coverageTable(report) {
  const coverage = get(report, 'coverage') ?? {}
  const rows = [
    ['readings within 2 cm of a plane', coverage.within_2cm], ['readings within 1.5 cm or three standard deviations', coverage.within_band ?? get(report, 'explained_points')],
    ['readings within 5 cm', coverage.within_5cm ?? get(report, 'explained_points_5cm')], ['OctoMap leaves within one leaf of a plane', coverage.leaves_explained], ['OctoMap leaves within half a leaf', coverage.leaves_explained_half],
    ['planes’ area that readings were seen on', coverage.outline_seen_within_band], ['planes’ area with occupied leaves at it', coverage.area_supported],
    ['planes’ area that another plane says again', get(report, 'doubled_area')], ['planes’ area that the camera looked through', get(report, 'floating_area')]]
  const known = rows.filter(([, value]) => isNumber(value))
  if (known.length === 0) return unknown('How much of the scene lies on planes was not measured.')
  return table('What the planes hold, and how sound they are', [{ name: 'share', wrap: true }, { name: '', number: true }], known.map(([name, value]) => [name, percent(value)]))
}

export function missed(report, model) {
  const points = model.points
  const onNone = points ? points.planes.reduce((sum, plane) => sum + (plane === -1), 0) : 0
  const picture = points && model.bounds
    ? figure(plan(model, { points: 'missed', planes: false, way: false, alt: `From above, ${count(onNone)} of ${count(points.n)} points lie on no plane and are red; the others are grey.` }),
      `A sample of ${count(points.total)} depth readings${points.n < points.total ? `, of which ${count(points.n)} are drawn` : ''}; red: on no plane (${percent(onNone / points.n)} of them). The ceiling is left out.`)
    : unknown('Where the missed readings are is not known: there is no points.ply in this folder.')
  const ranges = get(report, 'coverage', 'by_range')
  return section('missed', 'What the planes miss', 'Plants, people, clutter, curtains, what is too small or too far: it was measured, and no plane says so.',
    h('div', { class: 'two' }, picture, h('div', {}, coverageTable(report), Array.isArray(ranges) ? h('div', { style: 'margin-top:1.5rem' }, rangeChart(ranges)) : null)))
}

export function paper(model) {
  if (!model.points || !model.bounds || model.planes.length === 0) return section('paper', 'Points and planes', null, unknown('There is no points.ply in this folder, so points cannot be shown beside planes.'))
  const text = (kind) => `Overhead view as ${kind}${model.trajectory.length ? ' with the way of the camera' : ''}.`
  return section('paper', 'Points and planes', 'The same scene both ways, as Figures 4 and 5 of the paper show it; Figure 3 is the view in three dimensions with “points by plane”.',
    h('div', { class: 'two' },
      figure(plan(model, { points: 'photo', way: true, alt: text('points') }), `As points, with the way of the camera (Fig. 4 right): a sample of ${count(model.points.n)} depth readings.`),
      figure(plan(model, { planes: true, labels: false, way: true, alt: text('planes') }), `As planes (Fig. 4 left): ${plural(model.planes.length, 'plane')}.`)),
    wall(model))
}

export function growth(report) {
  const data = get(report, 'growth'), time = data?.time_s
  if (!Array.isArray(time) || time.length < 2) return section('growth', 'Growth', null, unknown('How the maps grew over time was not recorded.'))
  const start = time[0]
  const points = (values) => (Array.isArray(values) ? time.map((t, i) => [t - start, values[i]]).filter(([, v]) => isNumber(v)) : [])
  const chart = (title, format, list, log) => {
    const series = list.map(([name, values, ours]) => ({ name, ours, points: points(values).filter(([, v]) => !log || v > 0) })).filter((one) => one.points.length > 1)
    if (series.length === 0) return null
    const ends = series.map((one) => `${one.name} ends at ${format(one.points.at(-1)[1])}`).join(', ')
    return h('div', {}, h('h3', {}, title), lineChart({ height: 210, series, x: { name: 'seconds', format: (v) => String(v) }, y: { format, log }, alt: `${title} over time: ${ends}.` }))
  }
  const ms = (v) => `${milliseconds(v)} ms`
  return section('growth', 'Growth', 'How both maps grew while the camera moved.', h('div', { class: 'small-charts' }, [
    chart('Size', bytes, [['plane map', data.map_bytes, true], ['OctoMap', data.octomap_bytes]], true),
    chart('Time a frame', ms, [['plane map', data.planes_ms_per_frame, true], ['OctoMap', data.octomap_ms_per_frame]], false),
    chart('Planes', count, [['planes', data.planes, true]], false), chart('OctoMap nodes', count, [['nodes', data.octomap_nodes]], false)].filter(Boolean)))
}

const STAGES = { decode: 'decoding images', segmentation: 'segmentation', odometry: 'odometry', graph: 'graph', map: 'map', octomap: 'OctoMap, to compare with', report: 'this report' }

function inputName(report) {
  const input = String(report.input ?? '')
  if (input.startsWith('sim:')) return 'the simulator'
  return input === 'openni2' || input === 'freenect' ? 'waiting for the camera' : 'reading the files'
}

export function time(report) {
  const stages = get(report, 'stages_ms')
  if (!stages || typeof stages !== 'object') return section('time', 'Time', null, unknown('The times of the run that made this map are not known.'))
  const rows = Object.entries(stages).filter(([, stage]) => stage && stage.count > 0 && !stage.part_of).map(([name, stage]) => ({
    name: name === 'input' ? inputName(report) : STAGES[name] ?? name, stage, kind: ['input', 'octomap', 'report'].includes(name) ? 'aside' : 'ours', value: isNumber(stage.total_s) ? stage.total_s : (stage.median * stage.count) / 1000 }))
  const list = rows.map((row) => ({ ...row, text: seconds(row.value) }))
  const figures = rows.map((row) => ({ kind: row.kind === 'aside' ? 'aside' : null, cells: [row.name, milliseconds(row.stage.median), milliseconds(row.stage.p95), count(row.stage.count), row.value.toFixed(2)] }))
  const facts = [['by the clock', seconds(report.wall_s)], ['of processors', seconds(report.cpu_s)], ['most memory', isNumber(report.peak_rss_mb) ? `${count(report.peak_rss_mb)} MB` : null],
    ['without the OctoMap', isNumber(report.frames_per_s_without_octomap) ? `${report.frames_per_s_without_octomap.toFixed(0)} frames a second` : null]].filter(([, value]) => value && value !== '–')
  return section('time', 'Time', 'Where the time of the run went. Dashed: not planemap’s own work.',
    figure(barChart({ rows: list, alt: 'Time by stage: ' + list.map((row) => `${row.name} ${row.text}`).join(', ') })),
    details('Milliseconds a frame as a table', table('Milliseconds a time', [{ name: 'stage' }, { name: 'median', number: true }, { name: '95 %', number: true }, { name: 'times', number: true }, { name: 'seconds in all', number: true }], figures)),
    h('p', { class: 'lead', style: 'margin-top:1rem' }, facts.map(([name, value]) => `${value} ${name}`).join(' · ')))
}

export function planesTable(model) {
  if (model.planes.length === 0) return null
  const rows = [...model.planes].sort((a, b) => b.area - a.area).map((plane) => [String(plane.id), plane.label, isNumber(plane.area) ? plane.area.toFixed(2) : null,
    count(plane.rings.reduce((sum, ring) => sum + ring.length, 0)), isNumber(plane.rms) ? (1000 * plane.rms).toFixed(1) : null, count(plane.keyframes)])
  return section('planes', `The ${plural(model.planes.length, 'plane')}`, null, details('All planes as a table, the largest first',
    table('Area as seen; RMS of the readings to the plane', [{ name: 'id' }, { name: 'label' }, { name: 'm²', number: true }, { name: 'corners', number: true }, { name: 'RMS mm', number: true }, { name: 'keyframes', number: true }], rows)))
}

export function run(report) {
  if (!report) return null
  const facts = [['input', report.input], ['planemap', report.version], ['date', report.date], ['host', report.host], ['CPU', report.cpu], ['seed', isNumber(report.seed) ? String(report.seed) : null],
    ['keyframes', isNumber(report.keyframes) ? count(report.keyframes) : null], ['loop closures', isNumber(report.loop_closures) ? count(report.loop_closures) : null],
    ['up', report.up?.why ? (report.up.direction ? 'known ' : 'not known: ') + report.up.why : null],
    ['depth', report.depth_off && isNumber(report.depth_off.off_m) ? `off by ${centimetres(report.depth_off.off_m)} at ${report.depth_off.range_m} m` : null],
    ['components', Array.isArray(report.components) && report.components.length > 1 ? `${report.components.length} that do not hang together; this page is of the largest` : null]]
    .filter(([, value]) => value !== null && value !== undefined)
  const options = report.options && typeof report.options === 'object' ? Object.entries(report.options).filter(([, value]) => value !== null) : []
  return section('run', 'The run', null, h('dl', { class: 'facts' }, facts.map(([name, value]) => [h('dt', {}, name), h('dd', {}, typeof value === 'object' ? JSON.stringify(value) : String(value))])),
    options.length ? details(`All ${options.length} options`, table('Options by their flags', [{ name: 'flag' }, { name: 'value', wrap: true }], options.map(([name, value]) => ['--' + name, typeof value === 'string' ? value : JSON.stringify(value)]))) : null)
}
