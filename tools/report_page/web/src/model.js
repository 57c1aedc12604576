// SPDX-License-Identifier: BSD-3-Clause
// The page's data as the pictures need them: everything turned to a level frame, z up, x along most walls; metres.
import { cross, dot, minus, norm, plus, turn, unit } from './vector.js'

function decode(text, Type) {
  const binary = atob(text)
  const bytes = new Uint8Array(binary.length)
  for (let i = 0; i < binary.length; ++i) bytes[i] = binary.charCodeAt(i)
  return new Type(bytes.buffer)  // little-endian, as all that browsers run on
}

/// Of [angle, weight]: the mean of those that agree with the one that most agree with. Walls at right angles say the same once
/// their angles are taken four times.
function mainAngle(angles) {
  const agreeing = (main) => angles.filter(([angle]) => Math.cos(angle - main) > Math.cos((20 * Math.PI) / 180))
  const weight = (list) => list.reduce((sum, [, w]) => sum + w, 0)
  let best = []
  for (const [angle] of angles) if (weight(agreeing(angle)) > weight(best)) best = agreeing(angle)
  return Math.atan2(best.reduce((sum, [a, w]) => sum + w * Math.sin(a), 0), best.reduce((sum, [a, w]) => sum + w * Math.cos(a), 0))
}

/// Rows of the rotation: z is up, x runs along most walls.
function levelFrom(up, planes) {
  const z = unit(up)
  const x0 = unit(cross(Math.abs(z[0]) < 0.9 ? [1, 0, 0] : [0, 1, 0], z)), y0 = cross(z, x0)
  const angle = mainAngle(planes.filter((plane) => plane.label === 'wall').map((plane) => [4 * Math.atan2(dot(plane.normal, y0), dot(plane.normal, x0)), plane.area])) / 4
  const x = plus(x0.map((v) => v * Math.cos(angle)), y0, Math.sin(angle))
  return [x, cross(z, x), z]
}

function planeOf(plane, rows) {
  const ring = (points) => points.map((p) => turn(rows, p))
  return {
    id: plane.id, label: plane.label, area: plane.area, rms: plane.rms, inliers: plane.inliers, keyframes: plane.keyframe_count,
    normal: turn(rows, plane.normal), d: plane.d, center: turn(rows, plane.center),
    rings: plane.outline.map(ring), inferred: (plane.inferred_rings ?? []).map(ring),
  }
}

/// u is level, v upwards where the plane is upright; rings in u, v.
export function inPlane(plane) {
  const upright = Math.abs(plane.normal[2]) < 0.9
  const u = unit(upright ? cross([0, 0, 1], plane.normal) : cross([0, 1, 0], plane.normal)), v = cross(plane.normal, u)
  const flat = (p) => { const q = minus(p, plane.center); return [dot(q, u), dot(q, v)] }
  return { u, v, flat, rings: plane.rings.map((ring) => ring.map(flat)) }
}

function pointsOf(points, rows) {
  const steps = decode(points.positions, Uint16Array), n = points.shown
  const positions = new Float32Array(3 * n), { origin, step } = points
  for (let i = 0; i < n; ++i) {
    const p = turn(rows, [0, 1, 2].map((k) => origin[k] + step[k] * steps[3 * i + k]))
    positions.set(p, 3 * i)
  }
  return { n, total: points.total, positions, colors: decode(points.colors, Uint8Array), planes: decode(points.planes, Int16Array) }
}

function trajectoryOf(positions, rows) {
  const flat = decode(positions, Float32Array), line = []
  for (let i = 0; i + 2 < flat.length; i += 3) line.push(turn(rows, [flat[i], flat[i + 1], flat[i + 2]]))
  return line
}

/// Where all but the outermost 1 % of the points lie along an axis: a few wild readings must not make the room small.
function mostOf(points, axis) {
  const values = Float32Array.from({ length: points.n }, (_, i) => points.positions[3 * i + axis]).sort()
  return [values[Math.floor(0.005 * values.length)], values[Math.ceil(0.995 * values.length) - 1]]
}

/// Lowest and highest corner of planes, way and points; null without any.
function boundsOf(planes, trajectory, points) {
  const low = [Infinity, Infinity, Infinity], high = [-Infinity, -Infinity, -Infinity]
  const add = (p) => p.forEach((value, k) => { low[k] = Math.min(low[k], value); high[k] = Math.max(high[k], value) })
  for (const plane of planes) plane.rings.flat().forEach(add)
  trajectory.forEach(add)
  if (points && points.n > 0) {
    const most = [0, 1, 2].map((axis) => mostOf(points, axis))
    for (const end of [0, 1]) add(most.map((range) => range[end]))
  }
  return low[0] <= high[0] ? { low, high } : null
}

/// Whether a plane can be drawn: all that is used of it is there and finite.
function isWhole(plane) {
  const vector = (v) => Array.isArray(v) && v.length === 3 && v.every(Number.isFinite)
  return plane && [plane.d, plane.area].every(Number.isFinite) && vector(plane.normal) && norm(plane.normal) > 0.5 && vector(plane.center) &&
    typeof plane.label === 'string' && Array.isArray(plane.outline) && plane.outline.length > 0 &&
    [...plane.outline, ...(plane.inferred_rings ?? [])].every((ring) => Array.isArray(ring) && ring.length > 2 && ring.every(vector))
}

export function modelOf(data) {
  const stored = data.planes?.planes ?? []
  const drawable = stored.map((plane) => (isWhole(plane) ? plane : null))
  const rows = levelFrom(data.up, drawable.filter(Boolean))
  const byIndex = drawable.map((plane) => plane && planeOf(plane, rows))
  const planes = byIndex.filter(Boolean)
  const points = data.points ? pointsOf(data.points, rows) : null
  const trajectory = data.trajectory ? trajectoryOf(data.trajectory.positions, rows) : []
  const ceiling = Math.min(...planes.filter((plane) => plane.label === 'ceiling').map((plane) => plane.center[2]))
  const finiteLine = (line) => [...line.from, ...line.to].every(Number.isFinite)
  const lines = (data.planes?.lines ?? []).filter(finiteLine).map((line) => [turn(rows, line.from), turn(rows, line.to)])
  return { planes, byIndex, points, trajectory, lines, ceiling, upKnown: data.up_known, bounds: boundsOf(planes, trajectory, points) }
}
