// SPDX-License-Identifier: BSD-3-Clause
#include "export/gis.hpp"

#include <cpl_conv.h>
#include <cpl_error.h>
#include <ogrsf_frmts.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <memory>
#include <stdexcept>

#include "core/text_file.hpp"
#include "exports/parts.hpp"

namespace planemap {

namespace {

constexpr const char* kPlanes = "planes";
constexpr const char* kLines = "lines";

/// While it lives, GDAL keeps what it has to say to itself, and gives files the map's date and not today's.
class Quiet {
  public:
    explicit Quiet(std::int64_t utime) {
        GDALAllRegister();
        CPLPushErrorHandler(CPLQuietErrorHandler);
        CPLErrorReset();
        const std::time_t seconds = utime / 1000000;
        std::tm utc{};
        char date[64];
        gmtime_r(&seconds, &utc);
        std::strftime(date, sizeof date, "%Y-%m-%dT%H:%M:%S.000Z", &utc);
        CPLSetThreadLocalConfigOption("OGR_CURRENT_DATE", date);
    }
    ~Quiet() {
        CPLSetThreadLocalConfigOption("OGR_CURRENT_DATE", nullptr);
        CPLPopErrorHandler();
    }
    Quiet(const Quiet&) = delete;
    Quiet& operator=(const Quiet&) = delete;
};

/// What a user may see of a connection: no password.
std::string shown_name(const std::string& database) {
    constexpr std::size_t kLongest = 200;
    const std::size_t at = database.find("password");
    return shown_text(at == std::string::npos ? database : database.substr(0, at) + "password=...", kLongest);
}

/// GDAL's last reason as one line, without what is secret.
std::string reason(const std::string& database) {
    constexpr std::size_t kLongest = 300;
    std::string text = CPLGetLastErrorMsg();
    if (const std::size_t at = text.find(database); !database.empty() && at != std::string::npos)
        text.replace(at, database.size(), shown_name(database));
    while (!text.empty() && text.back() == '\n') text.pop_back();
    std::replace(text.begin(), text.end(), '\n', ' ');
    return shown_text(text, kLongest);
}

/// Throws what GDAL says of a file or database that it could not do something with.
[[noreturn]] void fail(const std::string& what, const std::string& database = {}) {
    const std::string why = reason(database);
    throw std::runtime_error(why.empty() ? what : what + ": " + why);
}

void require(bool ok, const std::string& what) {
    if (!ok) fail(what);
}

struct CloseDataset {
    void operator()(GDALDataset* dataset) const { GDALClose(dataset); }
};
using Dataset = std::unique_ptr<GDALDataset, CloseDataset>;
struct DestroyFeature {
    void operator()(OGRFeature* feature) const { OGRFeature::DestroyFeature(feature); }
};
using Feature = std::unique_ptr<OGRFeature, DestroyFeature>;

/// Writes the layers of one map into a data set.
class Layers {
  public:
    Layers(GDALDataset& dataset, std::string name, const PlaneMap& map, const Trajectory& trajectory)
        : dataset_(dataset),
          name_(std::move(name)),
          map_(map),
          frame_(exports::upright_frame(map, trajectory)) {
        // What GeoPackage has for a plane in metres that is no place on Earth; databases have none of their
        // own.
        local_.SetLocalCS("Undefined Cartesian SRS");
        local_.SetLinearUnits("metre", 1);
    }

    void write(bool replace) {
        add_planes(replace);
        add_lines(replace);
    }

  private:
    OGRLayer& layer(const char* name, OGRwkbGeometryType type, const char* what, bool replace) {
        require(dataset_.TestCapability(ODsCCreateLayer) != 0, name_ + ": no layers can be made in it");
        std::string description = what;
        for (const std::string& note : frame_.notes(frame_.level_from_world, 'z')) description += "; " + note;
        CPLStringList options;
        options.SetNameValue("DESCRIPTION", description.c_str());
        options.SetNameValue("GEOMETRY_NAME", "geom");
        options.SetNameValue("OVERWRITE", replace ? "YES" : "NO");
        const bool is_geopackage = EQUAL(dataset_.GetDriverName(), "GPKG");
        OGRLayer* layer = dataset_.CreateLayer(name, is_geopackage ? &local_ : nullptr, type, options.List());
        require(layer != nullptr, name_ + ": layer " + name);
        return *layer;
    }

    void add_field(OGRLayer& layer, const char* name, OGRFieldType type) {
        OGRFieldDefn field(name, type);
        require(layer.CreateField(&field) == OGRERR_NONE, name_ + ": field " + name);
    }

    OGRPoint point(const Eigen::Vector3d& p_world) const {
        const Eigen::Vector3d p = frame_.level_from_world * p_world;
        return {p.x(), p.y(), p.z()};
    }

    OGRMultiPolygon shape(const MapPlane& plane) const {
        const Pose world_from_plane = plane.world_from_plane();
        OGRMultiPolygon shape;
        for (const exports::Part& part : exports::parts_of(plane.outline.rings().rings)) {
            OGRPolygon polygon;
            for (const Ring& ring : part) {
                OGRLinearRing closed;
                for (const Eigen::Vector2d& v : ring) {
                    const OGRPoint p = point(world_from_plane * Eigen::Vector3d(v.x(), v.y(), 0));
                    closed.addPoint(&p);
                }
                closed.closeRings();
                polygon.addRing(&closed);
            }
            shape.addGeometry(&polygon);
        }
        return shape;
    }

    /// Nothing where the value is not known.
    static void set(OGRFeature& feature, const char* field, double value) {
        if (std::isfinite(value))
            feature.SetField(field, value);
        else
            feature.SetFieldNull(feature.GetFieldIndex(field));
    }

    void add(OGRLayer& layer, OGRFeature& feature, OGRGeometry& geometry) {
        require(feature.SetGeometry(&geometry) == OGRERR_NONE && layer.CreateFeature(&feature) == OGRERR_NONE,
                name_ + ": layer " + layer.GetName());
    }

    void add_planes(bool replace) {
        OGRLayer& layer = this->layer(kPlanes, wkbMultiPolygon25D, "Planes of a planemap", replace);
        for (const char* name : {"id", "keyframes"}) add_field(layer, name, OFTInteger);
        add_field(layer, "label", OFTString);
        for (const char* name : {"area", "inferred_area", "rms", "inliers"}) add_field(layer, name, OFTReal);
        for (const MapPlane* plane : exports::drawable_planes(map_)) {
            const Feature feature(OGRFeature::CreateFeature(layer.GetLayerDefn()));
            feature->SetField("id", plane->id);
            feature->SetField("keyframes", static_cast<int>(plane->keyframes));
            feature->SetField("label", label_name(plane->label));
            set(*feature, "area", plane->area);
            set(*feature, "inferred_area", exports::inferred_area(map_, plane->id));
            set(*feature, "rms", plane->rms);
            set(*feature, "inliers", plane->inliers);
            OGRMultiPolygon polygons = shape(*plane);
            add(layer, *feature, polygons);
        }
    }

    void add_lines(bool replace) {
        OGRLayer& layer =
            this->layer(kLines, wkbLineString25D, "Where two planes of a planemap meet", replace);
        for (const char* name : {"plane_a", "plane_b"}) add_field(layer, name, OFTInteger);
        add_field(layer, "length", OFTReal);
        for (const IntersectionLine& line : map_.lines) {
            if (!line.from.allFinite() || !line.to.allFinite()) continue;
            const Feature feature(OGRFeature::CreateFeature(layer.GetLayerDefn()));
            feature->SetField("plane_a", line.plane_a);
            feature->SetField("plane_b", line.plane_b);
            feature->SetField("length", static_cast<double>((line.to - line.from).norm()));
            OGRLineString ends;
            const OGRPoint from = point(line.from.cast<double>()), to = point(line.to.cast<double>());
            ends.addPoint(&from);
            ends.addPoint(&to);
            add(layer, *feature, ends);
        }
    }

    GDALDataset& dataset_;
    std::string name_;  ///< for messages
    const PlaneMap& map_;
    exports::UprightFrame frame_;
    OGRSpatialReference local_;
};

/// Throws for an active_schema that PostgreSQL does not have: tables would go to another one.
void require_schema(GDALDataset& dataset, const std::string& database, const std::string& name) {
    const std::string key = "active_schema=";
    const std::size_t at = database.find(key);
    if (at == std::string::npos || !EQUAL(dataset.GetDriverName(), "PostgreSQL")) return;
    const std::size_t begin = at + key.size();
    const std::string schema = database.substr(begin, database.find(' ', begin) - begin);
    std::string active;
    OGRLayer* answer = dataset.ExecuteSQL("SELECT current_schema()", nullptr, nullptr);
    if (answer != nullptr) {
        if (const Feature row{answer->GetNextFeature()}) active = row->GetFieldAsString(0);
        dataset.ReleaseResultSet(answer);
    }
    if (active != schema) throw std::runtime_error(name + ": has no schema " + shown_text(schema));
}

}  // namespace

void require_gis() {}

void write_geopackage(const std::filesystem::path& file, const PlaneMap& map, const Trajectory& trajectory) {
    const Quiet quiet(map.utime);
    GDALDriver* driver = GetGDALDriverManager()->GetDriverByName("GPKG");
    require(driver != nullptr, file.string() + ": this GDAL writes no GeoPackages");
    std::error_code ignored;
    std::filesystem::remove(file, ignored);
    Dataset dataset(driver->Create(file.c_str(), 0, 0, 0, GDT_Unknown, nullptr));
    require(dataset != nullptr, file.string());
    Layers(*dataset, file.string(), map, trajectory).write(false);
    CPLErrorReset();
    dataset.reset();  // what is written last says on a full disk that it could not be
    require(CPLGetLastErrorType() < CE_Failure, file.string());
}

void write_to_database(const std::string& database, const PlaneMap& map, const Trajectory& trajectory,
                       bool replace) {
    const Quiet quiet(map.utime);
    const std::string name = shown_name(database);
    Dataset dataset(
        GDALDataset::Open(database.c_str(), GDAL_OF_VECTOR | GDAL_OF_UPDATE | GDAL_OF_VERBOSE_ERROR));
    if (dataset == nullptr) fail(name, database);
    require_schema(*dataset, database, name);
    for (const char* layer : {kPlanes, kLines}) {
        if (!replace && dataset->GetLayerByName(layer) != nullptr)
            throw std::runtime_error(name + ": has a table " + layer +
                                     " already: give --replace, or another schema");
    }
    CPLErrorReset();
    const bool all_or_nothing = dataset->TestCapability(ODsCTransactions) != 0;
    if (all_or_nothing) require(dataset->StartTransaction() == OGRERR_NONE, name);
    try {
        Layers(*dataset, name, map, trajectory).write(replace);
        if (all_or_nothing) require(dataset->CommitTransaction() == OGRERR_NONE, name);
    } catch (const std::exception&) {
        if (all_or_nothing) dataset->RollbackTransaction();
        throw;
    }
}

}  // namespace planemap
