// SPDX-License-Identifier: BSD-3-Clause
// Distances that a person would measure: between walls that face each other, through partitions, from floor to ceiling.
import { cross, dot, minus, plus, unit } from './vector.js'

const PARALLEL = Math.cos((6 * Math.PI) / 180)
const SHORTEST_OVERLAP_M = 0.3

const extent = (plane, axis) => {
  const values = plane.rings.flat().map((p) => dot(p, axis))
  return [Math.min(...values), Math.max(...values)]
}
const overlap = (a, b) => [Math.max(a[0], b[0]), Math.min(a[1], b[1])]
const length = (range) => range[1] - range[0]

/// Where the line from a point along an axis meets a plane.
const along = (plane, p, axis) => -(dot(plane.normal, p) + plane.d) / dot(plane.normal, axis)

function pairOf(a, b) {
  if (dot(a.normal, b.normal) > -PARALLEL) return null
  const axis = unit(minus(a.normal, b.normal))  // from a towards b, where they face each other
  const side = unit(Math.abs(axis[2]) < 0.5 ? cross([0, 0, 1], axis) : cross([0, 1, 0], axis)), third = cross(axis, side)
  const shared = overlap(extent(a, side), extent(b, side)), other = overlap(extent(a, third), extent(b, third))
  if (length(shared) < SHORTEST_OVERLAP_M || length(other) < SHORTEST_OVERLAP_M) return null
  const at = (share) => {
    const p = plus(plus([0, 0, 0], side, shared[0] + share * length(shared)), third, (other[0] + other[1]) / 2)
    const from = along(a, p, axis), to = along(b, p, axis)
    return { from: plus(p, axis, from), to: plus(p, axis, to), distance: to - from }
  }
  return { a, b, at, distance: at(0.5).distance, overlap: length(shared) }
}

/// {rooms, partitions, heights}: pairs {a, b, distance, at(share) -> {from, to, distance}}, of each plane the nearest.
export function measure(planes) {
  const walls = planes.filter((plane) => plane.label === 'wall')
  const rooms = [], partitions = []
  walls.forEach((a, i) => walls.slice(i + 1).forEach((b) => {
    const pair = pairOf(a, b)
    if (pair === null) return
    if (pair.distance > 0.5) rooms.push(pair)
    else if (pair.distance < 0 && pair.distance > -0.6) partitions.push({ ...pair, distance: -pair.distance })
  }))
  const heights = []
  for (const floor of planes.filter((plane) => plane.label === 'floor'))
    for (const ceiling of planes.filter((plane) => plane.label === 'ceiling')) {
      const pair = pairOf(floor, ceiling)
      if (pair !== null && pair.distance > 0.5) heights.push(pair)
    }
  const nearest = (pairs) => {
    const best = new Map()
    for (const pair of pairs)
      for (const plane of [pair.a, pair.b])
        if (!best.has(plane) || best.get(plane).distance > pair.distance) best.set(plane, pair)
    return [...new Set(best.values())].sort((p, q) => q.overlap - p.overlap)
  }
  return { rooms: nearest(rooms), partitions: nearest(partitions), heights: nearest(heights) }
}
