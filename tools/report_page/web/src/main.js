// SPDX-License-Identifier: BSD-3-Clause
import './style.css'
import { h, unknown } from './dom.js'
import { modelOf } from './model.js'
import { fromAbove, growth, inThree, missed, paper, planesTable, run, time } from './sections.js'
import { sizes } from './sizes.js'
import { top } from './top.js'

const page = document.getElementById('page')

/// A section that fails says so and leaves the others.
function attempt(make) {
  try {
    return make()
  } catch (error) {
    return unknown(`A part of this page could not be drawn: ${error.message}`)
  }
}

function show(data) {
  const report = data.report
  if (report?.input) document.title = `planemap: ${report.input}`
  const model = modelOf(data)
  const links = [['plan', 'From above'], ['view', 'In 3D'], ['sizes', 'Sizes'], ['missed', 'What is missed'], ['paper', 'Points and planes'], ['growth', 'Growth'], ['time', 'Time'], ['planes', 'Planes'], ['run', 'The run']]
  const parts = [() => fromAbove(model), () => inThree(model), () => sizes(report), () => missed(report, model), () => paper(model), () => growth(report), () => time(report), () => planesTable(model), () => run(report)]
  const made = parts.map(attempt).filter(Boolean), ids = new Set(made.map((part) => part.id))
  page.append(attempt(() => top(report, data)), h('nav', { 'aria-label': 'Sections' }, links.filter(([id]) => ids.has(id)).map(([id, text]) => h('a', { href: '#' + id }, text))), ...made,
    h('footer', {}, 'One file, made by planemap from report.json, planes.json, trajectory.txt and points.ply; it asks the network for nothing. The view in three dimensions is drawn by three.js (MIT licence, inside this file).'))
}

try {
  show(JSON.parse(document.getElementById('planemap-data').textContent))
} catch (error) {
  page.append(unknown(`This page holds no data of a map: ${error.message}`))
}
