// SPDX-License-Identifier: BSD-3-Clause
// The map for geographic information systems, through GDAL's library, where it was there when planemap was
// built.
#pragma once

#include <filesystem>
#include <string>

#include "core/plane_map.hpp"
#include "core/trajectory.hpp"

namespace planemap {

/// Throws std::runtime_error, one line that says what to do, if this program was built without GDAL.
void require_gis();

/// Two layers: `planes`, a MultiPolygon Z a plane with id, label, area, inferred_area, rms, inliers and
/// keyframes (null where a value is not known), and `lines`, a LineString Z where two planes meet, with
/// plane_a, plane_b and length. They stand as planes.ply does: z up, x along most walls, metres; the layers'
/// descriptions say by which rotation. The coordinate system is a local one, no place on Earth. Planes that
/// are not finite or have no outline are left out. The same map gives the same bytes. Throws
/// std::runtime_error with one line that names the file and GDAL's reason.
void write_geopackage(const std::filesystem::path& file, const PlaneMap& map, const Trajectory& trajectory);

/// The same two layers as tables of a database, or of any vector data set, that GDAL opens for writing:
/// "PG:dbname=maps active_schema=office", or an existing .gpkg. All or nothing, where the database knows
/// transactions. With `replace`, tables of these names are replaced. Throws std::runtime_error with one line
/// that names the database and the reason, also for tables that are there without `replace`.
void write_to_database(const std::string& database, const PlaneMap& map, const Trajectory& trajectory,
                       bool replace);

}  // namespace planemap
