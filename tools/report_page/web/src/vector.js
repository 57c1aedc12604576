// SPDX-License-Identifier: BSD-3-Clause
export const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
export const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
export const minus = (a, b) => [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
export const plus = (a, b, factor = 1) => [a[0] + factor * b[0], a[1] + factor * b[1], a[2] + factor * b[2]]
export const norm = (a) => Math.hypot(a[0], a[1], a[2])
export const unit = (a) => { const n = norm(a); return n > 0 ? a.map((x) => x / n) : [0, 0, 1] }
/// Rows times a vector.
export const turn = (rows, p) => rows.map((row) => dot(row, p))

/// Whether x, y lies inside the rings (arrays of [x, y]) under the even-odd rule.
export function inside(rings, x, y) {
  let odd = false
  for (const ring of rings)
    for (let i = 0, j = ring.length - 1; i < ring.length; j = i++) {
      const [xi, yi] = ring[i], [xj, yj] = ring[j]
      if (yi > y !== yj > y && x < ((xj - xi) * (y - yi)) / (yj - yi) + xi) odd = !odd
    }
  return odd
}
