// SPDX-License-Identifier: BSD-3-Clause
#include "run/size_report.hpp"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>
#include <vector>

#include "pipeline/pipeline.hpp"
#include "run/coverage.hpp"
#include "run/report_text.hpp"
#include "run/size_rows.hpp"

namespace planemap {

namespace {

using Json = nlohmann::ordered_json;

constexpr double kMostTreeBytes = 512e6;  // of an OctoMap that is built to be measured

std::int64_t points_bytes(double points) {
    return static_cast<std::int64_t>(static_cast<double>(kCloudPointBytes) * points);
}

/// What a row of the OctoMap takes once it is compressed.
const Json& zstd_of(const Json& rows, const char* form, double resolution_m) {
    const auto row = std::find_if(rows.begin(), rows.end(), [&](const Json& r) {
        return r.at("map") == "octomap" && r.at("form") == form && r.at("resolution_m") == resolution_m &&
               !r.at("explained_only").get<bool>();
    });
    return row->at("zstd_bytes");
}

/// What a tree tells of itself, whether it was built or read from its file, and its rows.
void add_tree(const ::octomap::OcTree& tree, const octomap::OctomapSizes& s, TreeOrigin origin,
              std::optional<std::size_t> corrections, const PlaneMap& map, Json& sizes, Json& report) {
    const double resolution = tree.getResolution();
    Json& rows = report["sizes"];
    add_tree_rows(tree, s, origin, map, corrections, rows);
    sizes["octomap_bt"] = s.bt_bytes;
    sizes["octomap_occupied_leaves"] = points_bytes(static_cast<double>(s.occupied_leaves));
    sizes["octomap_bt_memory"] = s.bt_loaded_memory_bytes;
    sizes["octomap_bt_occupied"] = s.bt_occupied_bytes;
    sizes["octomap_bt_zstd"] = zstd_of(rows, kBt, resolution);
    sizes["octomap_bt_occupied_zstd"] = zstd_of(rows, kBtOccupied, resolution);
    report["octomap"] = {{"resolution_m", resolution},
                         {"nodes", s.nodes},
                         {"leaves", s.leaves},
                         {"occupied_leaves", s.occupied_leaves}};
    const Coverage c = coverage_of(map, octomap::occupied_voxels_of(tree), resolution);
    report["coverage"]["leaves_explained"] = c.leaves_explained;
    report["coverage"]["area_supported"] = c.area_supported;
    report["coverage"]["leaves_explained_half"] = c.leaves_explained_half;
}

/// The rows of what the OctoMap would be at other resolutions. Returns those of them that a robot has no
/// memory for.
Json add_other_resolutions(const octomap::OctomapBuilder& builder, const octomap::OctomapSizes& sizes,
                           const PlaneMap& map, const std::vector<double>& resolutions_m, Json& rows) {
    Json left_out = Json::array();
    for (const double resolution_m : resolutions_m) {
        const double finer = builder.tree().getResolution() / resolution_m;
        if (finer == 1) continue;
        // A tree's cells are of space, mostly of the free.
        if (static_cast<double>(sizes.allocated_bytes) * std::pow(std::max(1.0, finer), 3) > kMostTreeBytes) {
            left_out.push_back(resolution_m);
            continue;
        }
        if (const auto tree = builder.tree_at(resolution_m))
            add_tree_rows(*tree, octomap::sizes_of(*tree), TreeOrigin::kBuilt, map, std::nullopt, rows);
    }
    return left_out;
}

void add_octomap(const octomap::OctomapBuilder& builder, const PlaneMap& map,
                 const std::vector<double>& resolutions_m, Json& sizes, Json& report) {
    const octomap::OctomapSizes s = builder.sizes();
    const octomap::VoxelSet cloud_1cm = builder.voxel_cloud(0.01);
    const std::size_t working = builder.working_bytes();
    sizes["octomap_memory"] = s.memory_bytes;
    sizes["octomap_ot"] = s.ot_bytes;
    sizes["voxel_cloud_1cm"] = points_bytes(static_cast<double>(cloud_1cm.size()));
    sizes["octomap_working"] = working;
    add_tree(builder.tree(), s, TreeOrigin::kBuilt, working - s.memory_bytes + s.allocated_bytes, map, sizes,
             report);
    report["octomap"]["rebuilds"] = builder.rebuilds();
    const Json left_out = add_other_resolutions(builder, s, map, resolutions_m, report["sizes"]);
    report["sizes_left_out"] = left_out;
    add_cloud_rows(cloud_1cm, report["sizes"]);
}

std::string share_text(const Json& share) {
    return share.is_number() ? format("%.1f %%", 100 * share.get<double>()) : "not measured";
}

std::string ratio_text(double ratio) {
    return format(ratio < 10 ? "%.2f" : "%.0f", ratio);
}

bool has_octomap(const Json& report) {
    return report.at("octomap").at("resolution_m").is_number();
}

std::string coverage_text(const Json& report) {
    const Json& coverage = report.at("coverage");
    if (!has_octomap(report)) {
        return "There is no OctoMap of this run to compare with: how much of what was seen the planes "
               "explain is "
               "not measured, so the sizes below say little.\n\n";
    }
    return "The planes' outlines explain **" + share_text(coverage.at("leaves_explained")) +
           "** of the OctoMap's occupied leaves, and **" + share_text(coverage.at("area_supported")) +
           "** of the outlines' area has an occupied leaf beside it. Every ratio below is at that "
           "coverage.\n\n";
}

struct Row {
    const char* key;
    std::string name;
};

std::vector<Row> rows_of(const Json& report) {
    std::vector<Row> rows = {
        {"plane_map_message", "plane map, the message"},
        {"plane_map_zstd", "plane map, the message, zstd"},
        {"plane_map_memory", "plane map, in memory"},
        {"plane_map_working", "plane map, to go on mapping: with keyframes' regions and rasters, in memory"}};
    if (has_octomap(report)) {
        const std::string octomap =
            "OctoMap " + format("%.4g cm", 100 * report.at("octomap").at("resolution_m").get<double>());
        rows.insert(
            rows.end(),
            {{"octomap_bt", octomap + ", .bt file"},
             {"octomap_bt_zstd", octomap + ", .bt file, zstd"},
             {"octomap_bt_occupied", octomap + ", .bt file of the occupied space alone"},
             {"octomap_bt_occupied_zstd", octomap + ", .bt file of the occupied space alone, zstd"},
             {"octomap_bt_memory", octomap + ", .bt file loaded, in memory"},
             {"octomap_ot", octomap + ", .ot file"},
             {"octomap_memory", octomap + ", its working tree, in memory"},
             {"octomap_working", octomap + ", to go on mapping: tree and keyframes' depth, in memory"},
             {"octomap_occupied_leaves", octomap + ", occupied leaf centres at 12 B"},
             {"voxel_cloud_1cm", "cloud of 1 cm voxels of the keyframes at 12 B"}});
    }
    rows.insert(rows.end(),
                {{"raw_cloud", "raw clouds of all frames at 12 B a pixel, with depth or without"}});
    return rows;
}

/// The pairs that hold the same kind of thing.
std::string like_with_like(const Json& sizes) {
    const struct {
        const char *octomap, *planes, *what;
    } pairs[] = {
        {"octomap_bt", "plane_map_message", "as a file"},
        {"octomap_bt_zstd", "plane_map_zstd", "as a file compressed by zstd"},
        {"octomap_bt_occupied_zstd", "plane_map_zstd", "as such a file of the occupied space alone"}};
    std::string text;
    for (const auto& pair : pairs) {
        const Json octomap = sizes.value(pair.octomap, Json()), planes = sizes.value(pair.planes, Json());
        if (!octomap.is_number() || !planes.is_number() || planes.get<double>() <= 0) continue;
        text += (text.empty() ? "" : ", ") + ratio_text(octomap.get<double>() / planes.get<double>()) +
                " times " + pair.what;
    }
    return text;
}

std::string notes(const Json& report) {
    if (!has_octomap(report)) return "";
    const std::string like = like_with_like(report.at("sizes_bytes"));
    return (like.empty() ? "" : "\nLike with like, the OctoMap takes " + like + ".\n") +
           "\n- The .bt file holds the free space, too, which the planes do not say; the row of the occupied "
           "space "
           "alone leaves it out.\n"
           "- The message is the map to use, not what it takes to go on mapping.\n"
           "- In memory OctoMap's rows here are its own count, about half of what the allocator takes: that "
           "is "
           "in the table of like with like.\n"
           "- The ratios are of this resolution; another gives others (--octomap-resolution-m).\n";
}

}  // namespace

std::string bytes_text(double bytes, int decimals) {
    if (bytes < 1e3) return format("%.0f B", bytes);
    const std::string number = "%." + std::to_string(decimals) + "f ";
    if (bytes < 1e6) return format((number + "kB").c_str(), bytes / 1e3);
    if (bytes < 1e9) return format((number + "MB").c_str(), bytes / 1e6);
    return format("%.2f GB", bytes / 1e9);
}

std::string format(const char* pattern, double value) {
    char text[256];
    std::snprintf(text, sizeof(text), pattern, value);
    return text;
}

namespace {

void add_sizes_of(const PlaneMap& map, const std::optional<WorkingBytes>& working, Json& report) {
    report["sizes"] = Json::array();
    add_plane_rows(map, working, report["sizes"]);
    const Json& message = report["sizes"].front();

    Json sizes;
    sizes["plane_map_memory"] = memory_bytes(map);
    sizes["plane_map_message"] = message.at("bytes");
    for (const char* key : {"octomap_memory", "octomap_bt", "octomap_ot", "octomap_occupied_leaves",
                            "raw_cloud", "voxel_cloud_1cm"})
        sizes[key] = nullptr;
    sizes["plane_map_zstd"] = message.at("zstd_bytes");
    for (const char* key : {"plane_map_working", "octomap_bt_memory", "octomap_bt_occupied",
                            "octomap_bt_zstd", "octomap_bt_occupied_zstd", "octomap_working"})
        sizes[key] = nullptr;
    report["octomap"] = {{"resolution_m", nullptr}, {"nodes", nullptr}};
    for (const char* key : {"leaves_explained", "area_supported", "leaves_explained_half", "within_2cm",
                            "within_band", "within_5cm", "by_range", "outline_seen_within_band"})
        report["coverage"][key] = nullptr;
    report["sizes_bytes"] = sizes;
}

}  // namespace

void add_map_sizes(const PlaneMap& map, Json& report) {
    add_sizes_of(map, std::nullopt, report);
}

void add_sizes(pipeline::Pipeline& pipeline, std::int64_t frames, const std::vector<double>& resolutions_m,
               Json& report) {
    const map::PlaneMapper& mapper = pipeline.map().mapper();
    const CameraInfo* camera = pipeline.decoder().camera();
    const double pixels = camera != nullptr ? double(camera->depth.width) * camera->depth.height : 0;
    const std::size_t corrections = mapper.working_bytes() + mapper.memory_bytes();
    add_sizes_of(mapper.map(), WorkingBytes{corrections - mapper.keyframe_bytes(), corrections}, report);
    Json& sizes = report["sizes_bytes"];
    sizes["raw_cloud"] = points_bytes(pixels * static_cast<double>(frames));
    sizes["plane_map_working"] = corrections;
    if (pipeline.octomap() != nullptr)
        add_octomap(pipeline.octomap()->builder(), mapper.map(), resolutions_m, sizes, report);
}

void add_stored_octomap(const std::filesystem::path& bt_file, const PlaneMap& map, Json& report) {
    const std::unique_ptr<::octomap::OcTree> tree = octomap::read_bt(bt_file);
    add_tree(*tree, octomap::sizes_of(*tree), TreeOrigin::kReadFromBt, std::nullopt, map,
             report["sizes_bytes"], report);
}

std::string sizes_markdown(const Json& report) {
    const Json& sizes = report.at("sizes_bytes");
    const double message = sizes.at("plane_map_message").get<double>();
    std::string out =
        "## Size\n\n" + coverage_text(report) +
        "| map of the same run | size | times the plane map's message |\n| --- | ---: | ---: |\n";
    for (const Row& row : rows_of(report)) {
        const Json size = sizes.value(row.key, Json());
        if (!size.is_number()) {
            out += "| " + row.name + " | not measured | |\n";
            continue;
        }
        const double value = size.get<double>();
        out += "| " + row.name + " | " + bytes_text(value) + " | " +
               (message > 0 ? ratio_text(value / message) : "") + " |\n";
    }
    return out + notes(report) + size_rows_markdown(report);
}

}  // namespace planemap
