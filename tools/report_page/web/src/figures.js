// SPDX-License-Identifier: BSD-3-Clause
// The few figures that say it all, from reports of any age: what an older one lacks is taken from what it has, or null.
import { isNumber } from './text.js'

const get = (object, ...keys) => keys.reduce((value, key) => value?.[key], object) ?? null
const numberOf = (...candidates) => candidates.find(isNumber) ?? null

/// {planes, opponent: {name, resolution_m, bytes}, ratio, equal (known to be as accurate), explained, explainedOf}.
export function headlineOf(report) {
  const sizes = get(report, 'sizes_bytes') ?? {}, given = get(report, 'headline')
  const planes = numberOf(get(given, 'planes_zstd_bytes'), sizes.plane_map_zstd)
  const stated = get(given, 'opponent')
  const opponent = stated
    ? { name: `${ARTICLES[stated.map] ?? ''}${MAP_NAMES[stated.map] ?? stated.map}${stated.form ? ` (${stated.form})` : ''}`, resolution_m: numberOf(stated.resolution_m), bytes: numberOf(stated.zstd_bytes) }
    : { name: 'an OctoMap of the occupied space alone', resolution_m: numberOf(get(report, 'octomap', 'resolution_m')), bytes: numberOf(sizes.octomap_bt_occupied_zstd) }
  const ratio = numberOf(get(given, 'ratio'), planes > 0 && isNumber(opponent.bytes) ? opponent.bytes / planes : null)
  const readings = numberOf(get(given, 'explained_points'), get(report, 'explained_points'), get(report, 'coverage', 'within_band'))
  const leaves = numberOf(get(report, 'coverage', 'leaves_explained'))
  return {
    planes, opponent: isNumber(opponent.bytes) ? opponent : null, ratio, equal: isNumber(get(given, 'resolution_m')),
    explained: readings ?? leaves, explainedOf: readings !== null ? 'readings' : leaves !== null ? 'leaves' : null,
  }
}

const ARTICLES = { octomap: 'an ', openvdb: 'an ', octree: 'a ' }
export const MAP_NAMES = { planes: 'plane map', octomap: 'OctoMap', openvdb: 'OpenVDB', octree: 'plain octree', cloud: 'point cloud' }

const FORMER = [
  ['plane_map_message', 'planes', 'message', 'file', false, 'no'], ['plane_map_memory', 'planes', 'loaded', 'memory', false, 'no'],
  ['plane_map_working', 'planes', 'with keyframes and rasters', 'memory', false, 'corrections'],
  ['octomap_bt_occupied', 'octomap', '.bt, occupied space alone', 'file', false, 'no'], ['octomap_bt', 'octomap', '.bt', 'file', true, 'no'],
  ['octomap_bt_memory', 'octomap', '.bt loaded', 'memory', true, 'no'], ['octomap_ot', 'octomap', '.ot', 'file', true, 'fixed poses'],
  ['octomap_memory', 'octomap', 'working tree', 'memory', true, 'fixed poses'], ['octomap_working', 'octomap', 'tree and kept depth', 'memory', true, 'corrections'],
  ['voxel_cloud_1cm', 'cloud', '1 cm voxels', 'file', false, 'no'], ['raw_cloud', 'cloud', 'every pixel of all frames', 'file', false, 'no']]
const FORMER_ZSTD = { plane_map_message: 'plane_map_zstd', octomap_bt: 'octomap_bt_zstd', octomap_bt_occupied: 'octomap_bt_occupied_zstd' }

/// The rows of "sizes"; of a report from before there were rows, made of "sizes_bytes".
export function sizeRows(report) {
  if (Array.isArray(get(report, 'sizes'))) return report.sizes.filter((row) => row && typeof row === 'object')
  const sizes = get(report, 'sizes_bytes') ?? {}, resolution = get(report, 'octomap', 'resolution_m')
  return FORMER.filter(([key]) => isNumber(sizes[key])).map(([key, map, form, place, free_space, goes_on]) => ({
    map, form, place, free_space, goes_on, bytes: sizes[key], zstd_bytes: sizes[FORMER_ZSTD[key]] ?? null, explained_only: false,
    resolution_m: map === 'octomap' ? resolution : key === 'voxel_cloud_1cm' ? 0.01 : null }))
}

export { get, numberOf }
