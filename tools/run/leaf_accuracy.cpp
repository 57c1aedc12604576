// SPDX-License-Identifier: BSD-3-Clause
#include "run/leaf_accuracy.hpp"

#include <octomap/OcTree.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "octomap/octomap_sizes.hpp"
#include "run/report_text.hpp"

namespace planemap {

namespace {

using Json = nlohmann::ordered_json;

/// The leaf that holds a point, on OctoMap's lattice.
Eigen::Vector3d leaf_of(const Eigen::Vector3d& p, double resolution_m) {
    return (p / resolution_m).array().floor();
}

Eigen::Vector3d centre_of(const Eigen::Vector3d& leaf, double resolution_m) {
    return resolution_m * (leaf.array() + 0.5);
}

octomap::Voxel voxel(const Eigen::Vector3d& leaf) {
    return {static_cast<std::int32_t>(leaf.x()), static_cast<std::int32_t>(leaf.y()),
            static_cast<std::int32_t>(leaf.z())};
}

Json figures_of(const Distances& distances) {
    if (distances.count() == 0) return {{"rms_m", nullptr}, {"median_m", nullptr}};
    return {{"rms_m", distances.rms_m()}, {"median_m", distances.median_m()}};
}

std::string centimetres(const Json& metres) {
    return metres.is_number() ? format("%.2f", 100 * metres.get<double>()) : "-";
}

}  // namespace

void Distances::add(double metres) {
    mm_.add(1000 * std::abs(metres));
    squares_ += metres * metres;
}

double Distances::rms_m() const {
    return count() > 0 ? std::sqrt(squares_ / static_cast<double>(count())) : 0;
}

double Distances::median_m() const {
    return mm_.median() / 1000;
}

std::optional<double> equal_resolution(const std::vector<LeafRow>& rows, double LeafRow::*figure,
                                       double value) {
    for (std::size_t i = 0; i + 1 < rows.size(); ++i) {
        const LeafRow &coarse = rows[i], &fine = rows[i + 1];
        if (value > coarse.*figure || value < fine.*figure) continue;
        const double span = coarse.*figure - fine.*figure;
        const double part = span > 0 ? (value - fine.*figure) / span : 0;
        return fine.resolution_m + part * (coarse.resolution_m - fine.resolution_m);
    }
    return std::nullopt;
}

LeafAccuracy::LeafAccuracy(const ::octomap::OcTree* tree) : to_leaves_(std::size(kResolutions_m)) {
    if (tree == nullptr) return;
    tree_ = std::make_unique<Tree>();
    tree_->resolution_m = tree->getResolution();
    for (const Eigen::Vector3d& centre : octomap::occupied_voxels_of(*tree))
        tree_->occupied.insert(voxel(leaf_of(centre, tree_->resolution_m)));
}

void LeafAccuracy::add(const evaluation::JudgedReading& reading) {
    if (!reading.is_near) return;
    const Eigen::Vector3d& normal = reading.face->plane.normal;
    to_planes_.add(reading.distance_m);
    for (std::size_t i = 0; i < to_leaves_.size(); ++i) {
        const Eigen::Vector3d centre =
            centre_of(leaf_of(reading.p_world, kResolutions_m[i]), kResolutions_m[i]);
        to_leaves_[i].add(normal.dot(reading.p_world - centre));
    }
    if (tree_) add_to_tree(reading.p_world, normal);
}

void LeafAccuracy::add_to_tree(const Eigen::Vector3d& p_world, const Eigen::Vector3d& normal) {
    const Eigen::Vector3d own = leaf_of(p_world, tree_->resolution_m);
    const bool is_in_range = own.cwiseAbs().maxCoeff() + 1 < octomap::VoxelSet::kMaxCoordinate;
    double nearest = INFINITY;
    Eigen::Vector3d offset = Eigen::Vector3d::Zero();
    const auto look_at = [&](const Eigen::Vector3d& leaf) {
        const Eigen::Vector3d apart = p_world - centre_of(leaf, tree_->resolution_m);
        if (apart.squaredNorm() >= nearest || !tree_->occupied.contains(voxel(leaf))) return;
        nearest = apart.squaredNorm();
        offset = apart;
    };
    if (is_in_range) look_at(own);  // no centre is nearer than that of the leaf that holds the point
    if (is_in_range && std::isinf(nearest))
        for (int n = 0; n < 27; ++n)
            look_at(own + Eigen::Vector3i(n % 3 - 1, n / 3 % 3 - 1, n / 9 - 1).cast<double>());
    if (std::isinf(nearest))
        ++tree_->without_leaf;
    else
        tree_->distances.add(normal.dot(offset));
}

std::vector<LeafRow> LeafAccuracy::rows() const {
    std::vector<LeafRow> rows;
    for (std::size_t i = 0; i < to_leaves_.size(); ++i)
        rows.push_back({kResolutions_m[i], to_leaves_[i].rms_m(), to_leaves_[i].median_m()});
    return rows;
}

Json LeafAccuracy::figures() const {
    const auto known = [&](double LeafRow::*figure, double value) {
        const auto resolution =
            to_planes_.count() > 0 ? equal_resolution(rows(), figure, value) : std::nullopt;
        return resolution ? Json(*resolution) : Json(nullptr);
    };
    Json figures{
        {"readings", to_planes_.count()}, {"planes", figures_of(to_planes_)}, {"leaves", Json::array()}};
    for (std::size_t i = 0; i < to_leaves_.size(); ++i) {
        Json& row = figures["leaves"].emplace_back(Json{{"resolution_m", kResolutions_m[i]}});
        row.update(figures_of(to_leaves_[i]));
    }
    figures["octomap"] = nullptr;
    if (tree_) {
        figures["octomap"] = {{"resolution_m", tree_->resolution_m},
                              {"readings", tree_->distances.count()},
                              {"without_leaf", tree_->without_leaf}};
        figures["octomap"].update(figures_of(tree_->distances));
    }
    figures["equal_resolution_m"] = {{"by_rms", known(&LeafRow::rms_m, to_planes_.rms_m())},
                                     {"by_median", known(&LeafRow::median_m, to_planes_.median_m())}};
    return figures;
}

std::string leaf_accuracy_markdown(const Json& report) {
    const Json accuracy = report.value("accuracy_beside_size", Json());
    if (!accuracy.is_object() || accuracy.at("readings").get<std::int64_t>() == 0) return "";
    std::string out = "\n## Accuracy beside size\n\nDistances of the " + accuracy.at("readings").dump() +
                      " depth readings within 5 cm of a plane's outline: to that plane, and along its normal "
                      "to the centre of "
                      "the leaf of a voxel map that keeps every reading:\n\n"
                      "| map | RMS cm | median cm |\n| --- | ---: | ---: |\n";
    const auto row = [&](const std::string& map, const Json& figures) {
        out += "| " + map + " | " + centimetres(figures.at("rms_m")) + " | " +
               centimetres(figures.at("median_m")) + " |\n";
    };
    const auto size = [](const Json& figures) {
        return format("%.4g cm", 100 * figures.at("resolution_m").get<double>());
    };
    row("planes", accuracy.at("planes"));
    for (const Json& leaves : accuracy.at("leaves")) row("leaves of " + size(leaves), leaves);
    if (const Json& tree = accuracy.at("octomap"); tree.is_object()) {
        row("the run's OctoMap of " + size(tree) + " (" + tree.at("without_leaf").dump() +
                " readings have no occupied leaf within one of theirs)",
            tree);
    }
    const Json& equal = accuracy.at("equal_resolution_m");
    const auto resolution = [&](const char* key) {
        const Json& metres = equal.at(key);
        return metres.is_number() ? "leaves of " + centimetres(metres) + " cm" : "none of these leaves";
    };
    return out + "\nAs accurate as the planes are, by RMS, " + resolution("by_rms") + ", and by the median " +
           resolution("by_median") + ".\n";
}

}  // namespace planemap
