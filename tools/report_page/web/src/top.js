// SPDX-License-Identifier: BSD-3-Clause
// What one sees first: what is saved, what is lost, how accurate what is kept is, and what to be warned of.
import { barChart, shareBar } from './charts.js'
import { h } from './dom.js'
import { get, headlineOf, numberOf } from './figures.js'
import { bytes, centimetres, count, edge, isNumber, percent, plural, round } from './text.js'

function sentenceOf(head) {
  const part = head.explainedOf === 'readings' ? `${percent(head.explained, 0)} of what the camera measured lies on its planes`
    : head.explainedOf === 'leaves' ? `${percent(head.explained, 0)} of the OctoMap’s occupied leaves lie on its planes` : 'how much of the scene it holds is not known'
  if (!isNumber(head.ratio)) return `A map of ${bytes(head.planes)}, with nothing to compare it with; ${part}.`
  const how = head.ratio >= 1 ? `${round(head.ratio)} times smaller than` : `${round(1 / head.ratio)} times larger than`
  return `The plane map is ${how} ${head.opponent.name}${isNumber(head.opponent.resolution_m) ? ` at ${edge(head.opponent.resolution_m)}` : ''}, and ${part}.`
}

function savedCard(head) {
  const known = isNumber(head.ratio), smaller = known && head.ratio >= 1
  const words = known
    ? [smaller ? 'smaller' : 'larger: nothing is saved', ` than ${head.opponent.name}${isNumber(head.opponent.resolution_m) ? ` at ${edge(head.opponent.resolution_m)}` : ''}`, head.equal ? ', about where it is as accurate.' : '.', ' Both compressed (zstd).', head.equal ? '' : ' At which resolution voxels are as accurate is not known.']
    : ['No map of the same recording to compare with.']
  const rows = [{ name: 'the plane map', value: head.planes, text: bytes(head.planes), kind: 'ours' }]
  if (head.opponent) rows.push({ name: head.opponent.name, value: head.opponent.bytes, text: bytes(head.opponent.bytes) })
  return h('div', { class: 'card saved' }, h('p', { class: 'kind' }, 'Saved'),
    h('p', { class: 'figure' }, known ? [round(smaller ? head.ratio : 1 / head.ratio), h('small', {}, ' ×')] : isNumber(head.planes) ? bytes(head.planes) : 'not known'),
    h('p', {}, words), isNumber(head.planes) ? barChart({ rows, alt: rows.map((row) => `${row.name} ${row.text}`).join(', ') }) : null)
}

function lostCard(head) {
  const known = isNumber(head.explained)
  const of = head.explainedOf === 'leaves' ? 'of the OctoMap’s occupied leaves lie on no plane.' : 'of what the camera measured lies on no plane.'
  return h('div', { class: 'card lost' }, h('p', { class: 'kind' }, 'Lost'),
    h('p', { class: 'figure' }, known ? [(100 * (1 - head.explained)).toFixed(1), h('small', {}, ' %')] : 'not known'),
    h('p', {}, known ? `${of} What is not flat is not in this map, nor is free space.` : 'This folder does not tell how much of the scene lies on planes. Free space is not in this map.'),
    known ? [shareBar(head.explained, `${percent(head.explained)} on planes, ${percent(1 - head.explained)} on none`), h('p', { class: 'small' }, `${percent(head.explained)} kept, ${percent(1 - head.explained)} lost`)] : null)
}

function keptCard(report) {
  const rms = numberOf(get(report, 'accuracy_beside_size', 'planes', 'rms_m'), get(report, 'point_to_plane_rms_m'))
  const ate = numberOf(get(report, 'accuracy', 'ate_rmse_m')), facts = []
  if (isNumber(report?.planes)) facts.push(plural(report.planes, 'plane'))
  if (isNumber(report?.frames)) facts.push(`${count(report.tracked)} of ${count(report.frames)} frames tracked`)
  else if (isNumber(report?.tracked)) facts.push(plural(report.tracked, 'pose'))
  return h('div', { class: 'card kept' }, h('p', { class: 'kind' }, 'How accurate'),
    h('p', { class: 'figure' }, isNumber(rms) ? [round(100 * rms), h('small', {}, ' cm')] : 'not known'),
    h('p', {}, isNumber(rms) ? 'from the readings that lie on planes to those planes (RMS).' : 'This folder does not tell how far readings lie from their planes.'),
    isNumber(ate) ? h('p', {}, `Trajectory beside the truth: ${centimetres(ate)} (ATE, RMSE).`) : null,
    h('p', { class: 'small' }, facts.join(' · ')))
}

function remarks(report, notes) {
  const warnings = (get(report, 'warnings') ?? []).map(String), complaints = (get(report, 'complaints') ?? []).map(String), boxes = []
  if (get(report, 'interrupted') === true) warnings.unshift('the run ended before the end of its input')
  const list = (title, lines, kind) => h('div', { class: kind }, h('p', {}, title), h('ul', {}, lines.map((line) => h('li', {}, line))))
  if (warnings.length) boxes.push(list('Be warned', warnings, 'notes'))
  if (complaints.length) boxes.push(list('What was wrong with the input', complaints, 'notes plain'))
  if (notes.length) boxes.push(list('What this page could not read', notes, 'notes plain'))
  return boxes
}

export function top(report, data) {
  const head = headlineOf(report), origin = []
  if (report?.version) origin.push(`planemap ${report.version}`)
  if (report?.date) origin.push(String(report.date).replace('T', ' ').replace('Z', ' UTC'))
  if (report?.exported) origin.push('made of a stored map: the run that made it is not known')
  return h('header', {}, h('p', { class: 'over' }, ['planemap comparison report', report?.input, ...origin].filter(Boolean).join(' · ')),
    h('h1', {}, sentenceOf(head)), h('div', { class: 'cards' }, savedCard(head), lostCard(head), keptCard(report)), remarks(report, data.notes ?? []))
}
