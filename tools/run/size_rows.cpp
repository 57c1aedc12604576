// SPDX-License-Identifier: BSD-3-Clause
#include "run/size_rows.hpp"

#include <zstd.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <sstream>
#include <stdexcept>
#include <tuple>
#include <utility>
#include <vector>

#include "map/map_file.hpp"
#include "messages/convert.hpp"
#include "octomap/mask_octree.hpp"
#include "octomap/octomap_sizes.hpp"
#include "run/coverage.hpp"
#include "run/report_text.hpp"
#include "run/vdb_bytes.hpp"

namespace planemap {

namespace {

using Json = nlohmann::ordered_json;

constexpr int kZstdLevel = 3;  // zstd's own default; a higher one takes a minute for a large .bt

template <typename T>
Json or_null(const std::optional<T>& value) {
    return value ? Json(*value) : Json();
}

SizeRow file_row(const std::string& map, const std::string& form, std::optional<double> resolution_m,
                 std::string_view bytes) {
    return {.map = map,
            .form = form,
            .resolution_m = resolution_m,
            .bytes = bytes.size(),
            .zstd_bytes = zstd_bytes(bytes)};
}

SizeRow memory_row(const std::string& map, const std::string& form, std::optional<double> resolution_m,
                   std::size_t bytes, const char* goes_on) {
    return {.map = map,
            .form = form,
            .resolution_m = resolution_m,
            .bytes = bytes,
            .in_memory = true,
            .goes_on = goes_on};
}

/// The forms of the occupied space alone.
void add_occupied_rows(const ::octomap::OcTree& tree, const std::vector<Eigen::Vector3d>& leaves,
                       bool explained_only, Json& rows) {
    const double resolution = tree.getResolution();
    const std::vector<octomap::Voxel> cells = octomap::cells_at(leaves, resolution);
    std::vector<SizeRow> occupied = {
        file_row("octomap", kBtOccupied, resolution, octomap::bt_occupied_of(tree)),
        file_row("octree", "a byte of children a node", resolution, octomap::mask_octree(cells))};
#ifdef PLANEMAP_OPENVDB
    occupied.push_back(file_row("openvdb", "topology", resolution, vdb_topology(cells)));
#endif
    for (SizeRow& row : occupied) {
        row.explained_only = explained_only;
        row.leaves = leaves.size();
        rows.push_back(row.json());
    }
}

bool is_number(const Json& json, const char* key) {
    return json.contains(key) && json.at(key).is_number();
}

/// Whether a row is a file of the occupied space alone, of all that was seen.
bool is_opponent(const Json& row) {
    return row.at("map") != "planes" && row.at("map") != "cloud" && row.at("place") == "file" &&
           !row.at("free_space").get<bool>() && !row.at("explained_only").get<bool>() &&
           row.at("zstd_bytes").is_number() && row.at("resolution_m").is_number();
}

const Json* planes_message(const Json& rows) {
    for (const Json& row : rows)
        if (row.at("map") == "planes" && row.at("form") == "message") return &row;
    return nullptr;
}

/// The smallest of the opponents at the finest resolution that is not finer than this one: a finer map would
/// be more accurate than the planes, and larger. Where all are finer, at the coarsest.
const Json* smallest_opponent(const Json& rows, double resolution_m) {
    constexpr double kSame = 1e-6;  // of a resolution
    const Json* best = nullptr;
    const auto key = [&](const Json& row) {
        const double factor = row.at("resolution_m").get<double>() / resolution_m;
        const bool is_finer = factor < 1 - kSame;
        return std::tuple(is_finer, is_finer ? 1 / factor : factor, row.at("zstd_bytes").get<std::size_t>());
    };
    for (const Json& row : rows)
        if (is_opponent(row) && (best == nullptr || key(row) < key(*best))) best = &row;
    return best;
}

std::string cm_text(double metres) {
    return format("%.3g cm", 100 * metres);
}

std::string sentence_of(const Json& headline, bool is_equal) {
    const Json& opponent = headline.at("opponent");
    std::string text = "Compressed, the planes take " +
                       bytes_text(headline.at("planes_zstd_bytes").get<double>()) +
                       " and the smallest map of the occupied space alone at " +
                       cm_text(opponent.at("resolution_m").get<double>()) + " (" +
                       opponent.at("map").get<std::string>() + ", " + opponent.at("form").get<std::string>() +
                       ") " + bytes_text(opponent.at("zstd_bytes").get<double>()) + ": " +
                       format("%.2f", headline.at("ratio").get<double>()) + " times as much";
    text += is_equal ? "; the accuracy is equal at " + cm_text(headline.at("resolution_m").get<double>()) +
                           " (RMS)"
                     : "; at which resolution the accuracy is equal was not measured";
    const Json& explained = headline.at("explained_points");
    return text + (explained.is_number()
                       ? ", and the planes explain " + format("%.1f %%", 100 * explained.get<double>()) +
                             " of the depth readings."
                       : ", and how much of the depth the planes explain was not measured.");
}

std::string holds_text(const Json& row) {
    std::string text = row.at("free_space").get<bool>() ? "occupied and free" : "occupied";
    if (row.at("map") == "planes") text = "planes";
    if (row.at("explained_only").get<bool>()) text += ", what planes explain alone";
    return text;
}

}  // namespace

std::vector<double> size_resolutions(const std::string& text) {
    std::vector<double> resolutions_m;
    std::istringstream words(text);
    for (std::string word; std::getline(words, word, ',');) {
        double value = 0;
        const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
        if (error != std::errc() || end != word.data() + word.size() || !(value >= 0.001 && value <= 10))
            throw std::invalid_argument("size-resolutions holds \"" + word +
                                        "\", must be numbers from 0.001 to 10");
        resolutions_m.push_back(value);
    }
    return resolutions_m;
}

std::size_t zstd_bytes(std::string_view bytes) {
    std::string out(ZSTD_compressBound(bytes.size()), '\0');
    const std::size_t size = ZSTD_compress(out.data(), out.size(), bytes.data(), bytes.size(), kZstdLevel);
    if (ZSTD_isError(size) != 0) throw std::runtime_error(std::string("zstd: ") + ZSTD_getErrorName(size));
    return size;
}

Json SizeRow::json() const {
    return {{"map", map},
            {"form", form},
            {"resolution_m", or_null(resolution_m)},
            {"bytes", bytes},
            {"zstd_bytes", or_null(zstd_bytes)},
            {"place", in_memory ? "memory" : "file"},
            {"free_space", free_space},
            {"goes_on", goes_on},
            {"explained_only", explained_only},
            {"leaves", or_null(leaves)}};
}

void add_plane_rows(const PlaneMap& map, const std::optional<WorkingBytes>& working, Json& rows) {
    const std::vector<std::uint8_t> message = messages::to_bytes(messages::to_message(map, 0));
    const std::string_view bytes(reinterpret_cast<const char*>(message.data()), message.size());
    rows.push_back(file_row("planes", "message", std::nullopt, bytes).json());
    rows.push_back(file_row("planes", "map file", std::nullopt, map::plane_map_log(map)).json());
    rows.push_back(memory_row("planes", "map", std::nullopt, memory_bytes(map), "no").json());
    if (!working) return;
    rows.push_back(
        memory_row("planes", "planes and rasters", std::nullopt, working->fixed_poses, "fixed poses").json());
    rows.push_back(memory_row("planes", "planes, rasters and keyframes' regions", std::nullopt,
                              working->corrections, "corrections")
                       .json());
}

void add_tree_rows(const ::octomap::OcTree& tree, const octomap::OctomapSizes& sizes, TreeOrigin origin,
                   const PlaneMap& map, std::optional<std::size_t> corrections, Json& rows) {
    const double resolution = tree.getResolution();
    const auto add = [&](SizeRow row, std::size_t leaves) {
        row.free_space = true;
        row.leaves = leaves;
        rows.push_back(row.json());
    };
    if (origin == TreeOrigin::kBuilt) {
        add(memory_row("octomap", "working tree", resolution, sizes.allocated_bytes, "fixed poses"),
            sizes.leaves);
        if (corrections)
            add(memory_row("octomap", "working tree and keyframes' depth", resolution, *corrections,
                           "corrections"),
                sizes.leaves);
        SizeRow full = file_row("octomap", ".ot", resolution, octomap::ot_of(tree));
        full.goes_on = "fixed poses";
        add(full, sizes.leaves);
    }
    add(file_row("octomap", kBt, resolution, octomap::bt_of(tree)), sizes.bt_leaves);
    add(memory_row("octomap", ".bt reloaded", resolution, sizes.bt_loaded_allocated_bytes, "no"),
        sizes.bt_leaves);
    const std::vector<Eigen::Vector3d> leaves = octomap::occupied_voxels_of(tree);
    add_occupied_rows(tree, leaves, false, rows);
    const std::vector<Eigen::Vector3d> explained = explained_leaves(map, leaves, resolution);
    add_occupied_rows(*octomap::tree_of(explained, resolution), explained, true, rows);
}

void add_cloud_rows(const octomap::VoxelSet& cloud_1cm, Json& rows) {
    for (const int cm : {1, 2, 5}) {
        octomap::VoxelSet coarser;
        const auto floored = [cm](int c) { return (c >= 0 ? c : c - cm + 1) / cm; };
        if (cm > 1)
            cloud_1cm.for_each([&](const octomap::Voxel& v) {
                coarser.insert({floored(v.x), floored(v.y), floored(v.z)});
            });
        const std::size_t points = (cm > 1 ? coarser : cloud_1cm).size();
        rows.push_back(SizeRow{.map = "cloud",
                               .form = "12 B a voxel",
                               .resolution_m = cm / 100.0,
                               .bytes = kCloudPointBytes * points,
                               .leaves = points}
                           .json());
    }
}

Json headline_of(const Json& report) {
    const Json& rows = report.at("sizes");
    const Json* planes = planes_message(rows);
    if (planes == nullptr || !is_number(report.at("octomap"), "resolution_m")) return {};
    double resolution = report.at("octomap").at("resolution_m").get<double>();
    Json equal;
    if (const auto accuracy = report.find("accuracy_beside_size");
        accuracy != report.end() && accuracy->is_object())
        if (const auto at = accuracy->find("equal_resolution_m"); at != accuracy->end() && at->is_object())
            equal = at->value("by_rms", Json());
    const bool is_equal = equal.is_number() && equal.get<double>() > 0;
    if (is_equal) resolution = equal.get<double>();
    const Json* opponent = smallest_opponent(rows, resolution);
    if (opponent == nullptr) return {};
    const double own = planes->at("zstd_bytes").get<double>();
    Json headline = {{"ratio", opponent->at("zstd_bytes").get<double>() / own},
                     {"planes_zstd_bytes", planes->at("zstd_bytes")},
                     {"opponent",
                      {{"map", opponent->at("map")},
                       {"form", opponent->at("form")},
                       {"resolution_m", opponent->at("resolution_m")},
                       {"zstd_bytes", opponent->at("zstd_bytes")}}},
                     {"resolution_m", is_equal ? equal : Json()},
                     {"explained_points", report.value("explained_points", Json())}};
    headline["sentence"] = sentence_of(headline, is_equal);
    return headline;
}

std::string size_rows_markdown(const Json& report) {
    const auto rows = report.find("sizes");
    if (rows == report.end() || !rows->is_array() || rows->empty()) return "";
    std::string text = "\n### Like with like\n\n";
    if (const auto headline = report.find("headline"); headline != report.end() && headline->is_object())
        text += "**" + headline->at("sentence").get<std::string>() + "**\n\n";
    text +=
        "| map | form | resolution | holds | goes on with | leaves | size | zstd |\n"
        "| --- | --- | ---: | --- | --- | ---: | ---: | ---: |\n";
    for (const Json& row : *rows) {
        const Json &resolution = row.at("resolution_m"), &zstd = row.at("zstd_bytes"),
                   &leaves = row.at("leaves");
        text += "| " + row.at("map").get<std::string>() + " | " + row.at("form").get<std::string>() +
                (row.at("place") == "memory" ? ", in memory" : "") + " | " +
                (resolution.is_number() ? cm_text(resolution.get<double>()) : "") + " | " + holds_text(row) +
                " | " + row.at("goes_on").get<std::string>() + " | " +
                (leaves.is_number() ? std::to_string(leaves.get<std::int64_t>()) : "") + " | " +
                bytes_text(row.at("bytes").get<double>()) + " | " +
                (zstd.is_number() ? bytes_text(zstd.get<double>()) : "") + " |\n";
    }
    if (const auto left_out = report.find("sizes_left_out"); left_out != report.end() && left_out->is_array())
        for (const Json& resolution : *left_out)
            text += "\nAt " + cm_text(resolution.get<double>()) +
                    " the OctoMap would take more than 512 MB: it was not built.\n";
    return text +
           "\nMemory is what the allocator takes. A cloud's points are the centres of voxels that hold a "
           "reading of a "
           "keyframe. Leaves that planes explain lie within one resolution of an outline.\n";
}

}  // namespace planemap
