// SPDX-License-Identifier: BSD-3-Clause
// Each figure of "sizes" again, by another way than the report's.
#include "run/size_rows.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <zstd.h>

#include <array>
#include <random>
#include <set>
#include <sstream>

#include "core/scene.hpp"
#include "map/map_file.hpp"
#include "messages/convert.hpp"
#include "octomap/octomap_sizes.hpp"

namespace planemap {
namespace {

using ::testing::HasSubstr;
using Json = nlohmann::ordered_json;
using Cell = std::array<int, 3>;

constexpr double kLeaf = 0.05;

/// A wall of 2 x 1.6 m at z = 1, seen from the origin.
PlaneMap wall_map() {
    const scene::Rectangle wall{scene::facing({0, 0, 1.01}, {0, 0, -1}, {1, 0, 0}), 1, 0.8, {}};
    PlaneMap map;
    map.planes.emplace_back(3, scene::region_of(wall, Pose::Identity(), 0.05), 5);
    return map;
}

/// The wall's cells occupied, before them free ones, and some clutter elsewhere.
::octomap::OcTree wall_tree() {
    ::octomap::OcTree tree(kLeaf);
    std::mt19937_64 random(1);
    std::uniform_real_distribution<double> at(-2, 2);
    for (double x = -0.975; x < 1; x += kLeaf) {
        for (double y = -0.775; y < 0.8; y += kLeaf) {
            for (double z = 0.025; z < 1; z += kLeaf) tree.updateNode(x, y, z, false, true);
            tree.updateNode(x, y, 1.025, true, true);
        }
    }
    for (int i = 0; i < 200; ++i) tree.updateNode(at(random), at(random), 2 + at(random) / 4, true, true);
    tree.updateInnerOccupancy();
    tree.prune();
    return tree;
}

std::set<Cell> occupied_cells(const ::octomap::OcTree& tree) {
    std::set<Cell> cells;
    for (auto leaf = tree.begin_leafs(), end = tree.end_leafs(); leaf != end; ++leaf) {
        if (!tree.isNodeOccupied(*leaf)) continue;
        const int n = 1 << (tree.getTreeDepth() - leaf.getDepth());
        const ::octomap::OcTreeKey low = leaf.getIndexKey();
        for (int i = 0; i < n * n * n; ++i)
            cells.insert({low[0] + i % n - 32768, low[1] + i / n % n - 32768, low[2] + i / (n * n) - 32768});
    }
    return cells;
}

/// Bytes of inner nodes of a plain octree over the cells: what they become when they are halved again and
/// again.
std::size_t mask_bytes(const std::set<Cell>& cells) {
    Cell low = *cells.begin();
    for (const Cell& c : cells)
        for (std::size_t k = 0; k < 3; ++k) low[k] = std::min(low[k], c[k]);
    std::set<Cell> level;
    for (const Cell& c : cells) level.insert({c[0] - low[0], c[1] - low[1], c[2] - low[2]});
    std::size_t nodes = 0;
    while (level != std::set<Cell>{{0, 0, 0}}) {
        std::set<Cell> parents;
        for (const Cell& c : level) parents.insert({c[0] / 2, c[1] / 2, c[2] / 2});
        nodes += parents.size();
        level = parents;
    }
    return nodes;
}

const Json& row(const Json& rows, const std::string& map, const std::string& form,
                bool explained_only = false) {
    for (const Json& row : rows)
        if (row.at("map") == map && row.at("form") == form && row.at("explained_only") == explained_only)
            return row;
    throw std::runtime_error("no row of " + map + ", " + form);
}

class SizeRows : public ::testing::Test {
  protected:
    SizeRows() {
        add_plane_rows(map_, WorkingBytes{1000, 3000}, rows_);
        add_tree_rows(tree_, octomap::sizes_of(tree_), TreeOrigin::kBuilt, map_, 12345, rows_);
    }
    const PlaneMap map_ = wall_map();
    const ::octomap::OcTree tree_ = wall_tree();
    Json rows_ = Json::array();
};

TEST_F(SizeRows, OfThePlanesAreTheMessageTheFileAndTheMemory) {
    const std::string file = map::plane_map_log(map_);
    EXPECT_EQ(row(rows_, "planes", "map file").at("bytes"), file.size());
    const plane_map_t message = messages::to_message(map_, 0);
    const Json& sent = row(rows_, "planes", "message");
    EXPECT_EQ(sent.at("bytes"), message.getEncodedSize());
    EXPECT_EQ(sent.at("place"), "file");
    EXPECT_EQ(sent.at("resolution_m"), nullptr);
    EXPECT_FALSE(sent.at("free_space"));
    EXPECT_EQ(row(rows_, "planes", "planes and rasters").at("bytes"), 1000);
    EXPECT_EQ(row(rows_, "planes", "planes and rasters").at("goes_on"), "fixed poses");
    EXPECT_EQ(row(rows_, "planes", "planes, rasters and keyframes' regions").at("bytes"), 3000);
    EXPECT_EQ(row(rows_, "planes", "planes, rasters and keyframes' regions").at("goes_on"), "corrections");
}

TEST_F(SizeRows, OfTheOctomapAreWhatOctomapReadsAndWrites) {
    std::ostringstream bt, ot;
    ::octomap::OcTree copy(tree_);
    copy.writeBinary(bt);
    tree_.write(ot);
    EXPECT_EQ(row(rows_, "octomap", ".bt").at("bytes"), bt.str().size());
    EXPECT_EQ(row(rows_, "octomap", ".ot").at("bytes"), ot.str().size());
    ::octomap::OcTree reloaded(kLeaf);
    std::istringstream stored(bt.str());
    ASSERT_TRUE(reloaded.readBinary(stored));
    for (const char* form : {".bt", ".bt reloaded"})
        EXPECT_EQ(row(rows_, "octomap", form).at("leaves"), reloaded.getNumLeafNodes()) << form;
    for (const char* form : {".ot", "working tree"})
        EXPECT_EQ(row(rows_, "octomap", form).at("leaves"), tree_.getNumLeafNodes()) << form;
    EXPECT_EQ(row(rows_, "octomap", "working tree and keyframes' depth").at("bytes"), 12345);
    EXPECT_GE(row(rows_, "octomap", "working tree").at("bytes").get<std::size_t>(), tree_.memoryUsage());
    EXPECT_GE(row(rows_, "octomap", "working tree").at("bytes"),
              row(rows_, "octomap", ".bt reloaded").at("bytes"));
    for (const char* form : {".bt", ".ot", "working tree", ".bt reloaded"}) {
        EXPECT_TRUE(row(rows_, "octomap", form).at("free_space")) << form;
        EXPECT_EQ(row(rows_, "octomap", form).at("resolution_m"), kLeaf) << form;
    }
}

TEST_F(SizeRows, OfTheOccupiedSpaceHoldTheSameCells) {
    const std::set<Cell> cells = occupied_cells(tree_);
    ::octomap::OcTree read(kLeaf);
    std::istringstream bt(octomap::bt_occupied_of(tree_));
    ASSERT_TRUE(read.readBinary(bt));
    EXPECT_EQ(occupied_cells(read), cells);
    const Json &bt_row = row(rows_, "octomap", ".bt, occupied only"),
               &octree = row(rows_, "octree", "a byte of children a node");
    EXPECT_EQ(bt_row.at("bytes"), octomap::bt_occupied_of(tree_).size());
    EXPECT_EQ(octree.at("bytes"), 13 + mask_bytes(cells));
    for (const Json* of : {&bt_row, &octree}) {
        EXPECT_EQ(of->at("leaves"), cells.size());
        EXPECT_FALSE(of->at("free_space"));
        EXPECT_EQ(of->at("goes_on"), "no");
    }
}

TEST_F(SizeRows, OfWhatPlanesExplainHoldTheCellsNearTheOutlineAlone) {
    std::set<Cell> near;
    for (const Cell& c : occupied_cells(tree_)) {
        const Eigen::Vector3d centre =
            kLeaf * (Eigen::Vector3d(c[0], c[1], c[2]) + Eigen::Vector3d::Constant(0.5));
        if (distance(map_.planes[0], centre) <= kLeaf) near.insert(c);
    }
    ASSERT_GE(near.size(), 40u * 32u);
    ASSERT_LT(near.size(), occupied_cells(tree_).size());
    const Json &bt = row(rows_, "octomap", ".bt, occupied only", true),
               &octree = row(rows_, "octree", "a byte of children a node", true);
    EXPECT_EQ(bt.at("leaves"), near.size());
    EXPECT_EQ(octree.at("leaves"), near.size());
    EXPECT_EQ(octree.at("bytes"), 13 + mask_bytes(near));
    EXPECT_LT(bt.at("bytes"), row(rows_, "octomap", ".bt, occupied only").at("bytes"));
}

TEST_F(SizeRows, OfATreeThatWasReadSayNothingOfHowItWasBuilt) {
    Json rows = Json::array();
    add_tree_rows(tree_, octomap::sizes_of(tree_), TreeOrigin::kReadFromBt, map_, std::nullopt, rows);
    for (const Json& row : rows) {
        EXPECT_NE(row.at("form"), "working tree");
        EXPECT_NE(row.at("form"), ".ot");
    }
}

TEST(SizeRowsOfClouds, CountVoxelsOfEachSize) {
    octomap::VoxelSet cloud;
    std::mt19937_64 random(1);
    std::array<std::set<Cell>, 6> of;  // by cm
    for (int i = 0; i < 2000; ++i) {
        const octomap::Voxel v{static_cast<int>(random() % 60) - 30, static_cast<int>(random() % 60) - 30,
                               static_cast<int>(random() % 9) - 4};
        cloud.insert(v);
        for (const int cm : {1, 2, 5}) {
            const auto down = [cm](int c) {
                return static_cast<int>(std::floor(static_cast<double>(c) / cm));
            };
            of[static_cast<std::size_t>(cm)].insert({down(v.x), down(v.y), down(v.z)});
        }
    }
    Json rows = Json::array();
    add_cloud_rows(cloud, rows);
    ASSERT_EQ(rows.size(), 3u);
    for (const Json& row : rows) {
        const auto cm = static_cast<std::size_t>(std::lround(100 * row.at("resolution_m").get<double>()));
        EXPECT_EQ(row.at("leaves"), of.at(cm).size());
        EXPECT_EQ(row.at("bytes"), 12 * of.at(cm).size());
    }
}

TEST(SizeRowsZstd, CompressesWithoutLoss) {
    std::string bytes;
    for (int i = 0; i < 5000; ++i) bytes += static_cast<char>(i * i / 100);
    std::string packed(ZSTD_compressBound(bytes.size()), '\0');
    packed.resize(ZSTD_compress(packed.data(), packed.size(), bytes.data(), bytes.size(), 3));
    EXPECT_EQ(zstd_bytes(bytes), packed.size());
}

Json report_of(Json rows) {
    return {{"sizes", std::move(rows)}, {"octomap", {{"resolution_m", 0.05}}}, {"explained_points", 0.8491}};
}

Json file_row(const char* map, const char* form, double resolution_m, std::size_t zstd) {
    return SizeRow{
        .map = map, .form = form, .resolution_m = resolution_m, .bytes = 2 * zstd, .zstd_bytes = zstd}
        .json();
}

TEST(Headline, IsTheMessageOverTheSmallestOccupiedFormAtEqualAccuracy) {
    Json rows = {SizeRow{.map = "planes", .form = "message", .bytes = 2500, .zstd_bytes = 2000}.json(),
                 file_row("octomap", ".bt, occupied only", 0.05, 6000),
                 file_row("octree", "a byte of children a node", 0.05, 5000),
                 file_row("octomap", ".bt, occupied only", 0.1, 1500),
                 file_row("octomap", ".bt, occupied only", 0.02, 30000)};
    Json explained = file_row("octree", "a byte of children a node", 0.05, 4000),
         free = file_row("octomap", ".bt", 0.05, 100);
    explained["explained_only"] = true;
    free["free_space"] = true;
    rows.push_back(explained);
    rows.push_back(free);
    rows.push_back(file_row("cloud", "12 B a voxel", 0.05, 100));
    Json report = report_of(rows);
    Json headline = headline_of(report);
    EXPECT_EQ(headline.at("opponent").at("map"), "octree");
    EXPECT_EQ(headline.at("opponent").at("zstd_bytes"), 5000);
    EXPECT_EQ(headline.at("planes_zstd_bytes"), 2000);
    EXPECT_DOUBLE_EQ(headline.at("ratio"), 2.5);
    EXPECT_EQ(headline.at("resolution_m"), nullptr);
    EXPECT_THAT(headline.at("sentence").get<std::string>(), HasSubstr("was not measured"));
    EXPECT_THAT(headline.at("sentence").get<std::string>(), HasSubstr("84.9 %"));

    // Never at a finer one than as accurate as the planes, which would be larger.
    const auto headline_at = [&](double equal_m) {
        report["accuracy_beside_size"] = {
            {"equal_resolution_m", {{"by_rms", equal_m}, {"by_median", nullptr}}}};
        return headline_of(report);
    };
    EXPECT_EQ(headline_at(0.02).at("opponent").at("resolution_m"), 0.02);
    EXPECT_DOUBLE_EQ(headline_at(0.018).at("ratio"), 15);
    EXPECT_EQ(headline_at(0.2).at("opponent").at("resolution_m"), 0.1) << "the coarsest that there is";
    headline = headline_at(0.023);
    EXPECT_EQ(headline.at("opponent").at("resolution_m"), 0.05);
    EXPECT_EQ(headline.at("resolution_m"), 0.023);
    EXPECT_DOUBLE_EQ(headline.at("ratio"), 2.5);
    EXPECT_THAT(headline.at("sentence").get<std::string>(), HasSubstr("2.3 cm (RMS)"));
    report["headline"] = headline;
    const std::string text = size_rows_markdown(report);
    EXPECT_THAT(text, HasSubstr(headline.at("sentence").get<std::string>()));
    EXPECT_THAT(text, HasSubstr("| octree | a byte of children a node | 5 cm | occupied | no |"));

    report["accuracy_beside_size"]["equal_resolution_m"]["by_rms"] = nullptr;
    EXPECT_EQ(headline_of(report).at("resolution_m"), nullptr);
    report["octomap"]["resolution_m"] = nullptr;
    EXPECT_TRUE(headline_of(report).is_null());
    EXPECT_TRUE(headline_of(report_of(Json::array())).is_null());
    EXPECT_EQ(size_rows_markdown(Json::object()), "");
}

TEST(SizeResolutions, AreNumbersWithCommas) {
    EXPECT_EQ(size_resolutions("0.1,0.02"), (std::vector<double>{0.1, 0.02}));
    EXPECT_TRUE(size_resolutions("").empty());
    for (const char* bad : {"fine", "0.1;0.2", "0", "-1", "nan", "20", "0.1,,0.2"}) {
        EXPECT_THROW(size_resolutions(bad), std::invalid_argument) << bad;
    }
}

}  // namespace
}  // namespace planemap
