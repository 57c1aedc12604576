// SPDX-License-Identifier: BSD-3-Clause
// The bytes that segmentation and registration give, on every architecture: images made of whole numbers, and
// hashes of what comes out beside those that the portable kernels gave on x86-64
// (tests/stored/same_bits.txt). A change that means to move them is stored with
//   PLANEMAP_STORE=1 build/tests/same_bits_test
#include <gtest/gtest.h>

#include <bit>
#include <cstdlib>
#include <fstream>
#include <iomanip>
#include <map>
#include <random>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

#include "core/registration.hpp"
#include "core/undistortion.hpp"
#include "segmentation/cells.hpp"

namespace planemap::segmentation {
namespace {

const std::string kStored = PLANEMAP_SOURCE "/tests/stored/same_bits.txt";

/// FNV-1a.
class Hash {
  public:
    void add(std::uint64_t value) {
        for (int shift = 0; shift < 64; shift += 8) {
            value_ ^= (value >> shift) & 0xff;
            value_ *= 0x100000001b3;
        }
    }
    void add(double value) { add(std::bit_cast<std::uint64_t>(value)); }
    template <typename Derived>
    void add(const Eigen::DenseBase<Derived>& values) {
        for (const auto value : values.reshaped()) add(static_cast<double>(value));
    }
    template <typename Pixel>
    void add(const Image<Pixel>& image) {
        add(static_cast<std::uint64_t>(image.width));
        add(static_cast<std::uint64_t>(image.height));
        for (const Pixel pixel : image.pixels) add(static_cast<std::uint64_t>(pixel));
    }
    std::string text() const {
        std::ostringstream out;
        out << std::hex << std::setw(16) << std::setfill('0') << value_;
        return out.str();
    }

  private:
    std::uint64_t value_ = 0xcbf29ce484222325;
};

CameraInfo camera_of(int width, int height) {
    CameraInfo info;
    const double focal = 0.875 * width;
    info.depth = info.color = {width, height, focal, focal, 0.5 * (width - 1), 0.5 * (height - 1)};
    return info;
}

/// A room, in whole numbers: inverse depth is linear in the pixels of a plane, and the nearest one is seen.
/// A ball's bulge, noise of some millimetres and readings that are none are in it.
DepthImage room(int width, int height, std::uint32_t seed) {
    struct Face {
        std::int64_t start, right, down;  // inverse depth, 1e-6 per millimetre, in the middle and across it
    };
    static constexpr Face kFaces[]{
        {320, 0, 0}, {260, 620, 40}, {250, -560, 90}, {180, 30, 900}, {200, -20, -700}};
    std::mt19937 random(seed);
    DepthImage depth(width, height);
    for (int v = 0; v < height; ++v) {
        for (int u = 0; u < width; ++u) {
            const std::int64_t x = 2 * u - width, y = 2 * v - height;
            std::int64_t inverse = 0;
            for (const Face& face : kFaces)
                inverse = std::max(inverse, face.start + (face.right * x + face.down * y) / (2 * width));
            const std::int64_t bulge = width * width / 9 - (x - width / 4) * (x - width / 4) - y * y;
            std::int64_t z = 1000000 / inverse - std::max<std::int64_t>(0, 2700 * bulge / (width * width));
            const std::int64_t grain = 1 + z * z / 1500000;
            z += static_cast<std::int64_t>(random()) % (2 * grain + 1) - grain;
            depth(u, v) = static_cast<std::uint16_t>(random() % 64 == 0 ? 0 : z);
        }
    }
    return depth;
}

/// The rotation of a quaternion in whole numbers: no sine takes part.
Pose turned(double w, double x, double y, double z, const Eigen::Vector3d& translation) {
    Pose pose = Pose::Identity();
    pose.linear() = Eigen::Quaterniond(w, x, y, z).normalized().toRotationMatrix();
    pose.translation() = translation;
    return pose;
}

using Hashes = std::map<std::string, std::string>;

void add_segmentation(const std::string& name, const DepthImage& depth, const CameraInfo& camera,
                      const CellKernels& kernels, Hashes& hashes) {
    Segmentation found;
    make_cell_segmenter(CellOptions{}, kernels)->segment(depth, camera, found);
    Hash labels, planes, shapes;
    labels.add(found.labels);
    for (const PlanarRegion& region : found.regions) {
        planes.add(region.moments.count);
        planes.add(region.moments.sum);
        planes.add(region.moments.scatter);
        planes.add(region.plane.normal);
        planes.add(region.plane.d);
        planes.add(region.rms);
        shapes.add(region.box.frame_from_box.matrix());
        shapes.add(region.box.half_extents);
        for (const Ring& ring : region.outline.rings) {
            for (const Eigen::Vector2d& vertex : ring) shapes.add(vertex);
        }
    }
    hashes[name + " regions"] = std::to_string(found.regions.size());
    hashes[name + " labels"] = labels.text();
    hashes[name + " planes"] = planes.text();
    hashes[name + " shapes"] = shapes.text();
}

Hashes segmentation_hashes(const CellKernels& kernels) {
    Hashes hashes;
    add_segmentation("room-640x480", room(640, 480, 1), camera_of(640, 480), kernels, hashes);
    add_segmentation("room-317x203", room(317, 203, 2), camera_of(317, 203), kernels, hashes);
    CameraInfo fine = camera_of(640, 480);
    fine.depth_units_per_metre = 2000;
    fine.noise = {0.001, 0.0005, 0.25};
    add_segmentation("near-640x480", room(640, 480, 3), fine, kernels, hashes);
    return hashes;
}

void add_registration(const std::string& name, const CameraInfo& camera, Hashes& hashes) {
    Hash registered;
    registered.add(register_depth(room(camera.depth.width, camera.depth.height, 4), camera));
    hashes[name] = registered.text();
}

Hashes registration_hashes() {
    Hashes hashes;
    CameraInfo camera = camera_of(640, 480);
    camera.registered = false;
    camera.color_from_depth = turned(1000, 3, -5, 2, {-0.025, 0.002, 0.001});
    add_registration("registered-same", camera, hashes);
    camera.depth = camera_of(320, 240).depth;
    add_registration("registered-coarser", camera, hashes);
    camera.depth = camera_of(1280, 960).depth;
    add_registration("registered-finer", camera, hashes);

    CameraInfo lens = camera_of(640, 480);
    lens.depth_distortion = {LensDistortion::Model::kBrown, {0.25, -0.75, -0.005, 0.0025, 0.5}};
    DepthImage depth = room(640, 480, 5);
    Undistortion(lens).undistort(depth);
    Hash undistorted;
    undistorted.add(depth);
    hashes["undistorted-brown"] = undistorted.text();
    return hashes;
}

std::string text_of(Hashes all, Hashes more) {
    all.merge(more);
    std::string text;
    for (const auto& [name, hash] : all) text.append(name).append(" ").append(hash).append("\n");
    return text;
}

TEST(SameBits, OnEveryArchitecture) {
    const std::string text = text_of(segmentation_hashes(portable_cell_kernels()), registration_hashes());
    if (std::getenv("PLANEMAP_STORE") != nullptr) std::ofstream(kStored) << text;
    std::ostringstream stored;
    stored << std::ifstream(kStored).rdbuf();
    EXPECT_EQ(text, stored.str());
}

TEST(SameBits, OfEveryInstructionSet) {
    const Hashes portable = segmentation_hashes(portable_cell_kernels());
    EXPECT_EQ(segmentation_hashes(baseline_cell_kernels()), portable);
    EXPECT_EQ(segmentation_hashes(best_cell_kernels()), portable);
    // The room is one: where nothing was found, nothing would differ.
    EXPECT_GE(std::stoi(portable.at("room-640x480 regions")), 4);
}

}  // namespace
}  // namespace planemap::segmentation
