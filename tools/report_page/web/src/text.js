// SPDX-License-Identifier: BSD-3-Clause
// Numbers as people read them; what is not a number is said to be unknown.
export const isNumber = (value) => typeof value === 'number' && Number.isFinite(value)

export function bytes(value) {
  if (!isNumber(value)) return '–'
  for (const [unit, size] of [['GB', 1e9], ['MB', 1e6], ['kB', 1e3]])
    if (value >= size) return `${round(value / size)} ${unit}`
  return `${Math.round(value)} B`
}

/// Three digits that count.
export function round(value) {
  if (!isNumber(value)) return '–'
  const size = Math.abs(value)
  return value.toFixed(size >= 99.95 ? 0 : size >= 9.995 ? 1 : 2)
}

export const times = (value) => (isNumber(value) ? `${value < 1e4 ? round(value) : count(value)} ×` : '–')
export const percent = (share, digits = 1) => (isNumber(share) ? `${(100 * share).toFixed(digits)} %` : '–')
export const metres = (value) => (isNumber(value) ? `${value.toFixed(2)} m` : '–')
export const count = (value) => (isNumber(value) ? Math.round(value).toLocaleString('en-GB').replaceAll(',', '\u202f') : '–')
export const seconds = (value) => (isNumber(value) ? `${round(value)} s` : '–')
export const milliseconds = (value) => (isNumber(value) ? round(value) : '–')
export const centimetres = (value) => (isNumber(value) ? `${round(100 * value)} cm` : '–')
/// A resolution: 5 cm, 2.5 cm.
export const edge = (value) => (isNumber(value) ? `${+(100 * value).toPrecision(3)} cm` : '–')
export const yesNo = (value) => (value === true ? 'yes' : value === false ? 'no' : '–')
export const plural = (number, one, many = one + 's') => `${count(number)} ${number === 1 ? one : many}`
