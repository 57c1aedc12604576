// SPDX-License-Identifier: BSD-3-Clause
#include "messages/decode.hpp"

#include <algorithm>
#include <bot_core/images_t.hpp>
#include <bot_core/pose_t.hpp>
#include <bot_core/rigid_transform_t.hpp>
#include <exception>
#include <kinect/frame_msg_t.hpp>
#include <limits>
#include <planemap/acceleration_t.hpp>
#include <planemap/camera_info_t.hpp>
#include <planemap/earlier_plane_map_t.hpp>
#include <planemap/keyframe_t.hpp>
#include <planemap/look_t.hpp>
#include <planemap/map_size_t.hpp>
#include <planemap/module_status_t.hpp>
#include <planemap/odometry_t.hpp>
#include <planemap/planar_regions_t.hpp>
#include <planemap/plane_map_t.hpp>
#include <planemap/seen_space_t.hpp>
#include <planemap/surfaces_t.hpp>
#include <planemap/trajectory_t.hpp>
#include <string>

namespace planemap::messages {

namespace {

/// Walks encoded bytes: skips what has a fixed size, bounds what has a length of its own.
class Walker {
  public:
    explicit Walker(std::span<const std::uint8_t> bytes) : bytes_(bytes) {}

    std::size_t left() const { return bytes_.size() - at_; }

    void skip(std::size_t count, const char* field) {
        if (count > left())
            fail(field, "needs " + std::to_string(count) + " bytes, " + std::to_string(left()) + " are left");
        at_ += count;
    }
    /// A big-endian length field of 2 or 4 bytes.
    std::int32_t length(const char* field, std::size_t width = 4) {
        std::uint32_t value = 0;
        const std::size_t start = at_;
        skip(width, field);
        for (std::size_t i = 0; i < width; ++i) value = value << 8 | bytes_[start + i];
        const auto count = width == 2 ? static_cast<std::int16_t>(value) : static_cast<std::int32_t>(value);
        if (count < 0) fail(field, "is negative: " + std::to_string(count));
        return count;
    }
    void array(std::int32_t count, std::size_t element, const char* field) {
        if (static_cast<std::size_t>(count) > left() / element) {
            fail(field,
                 "has " + std::to_string(count) + " elements, " + std::to_string(left()) + " bytes are left");
        }
        skip(static_cast<std::size_t>(count) * element, field);
    }
    /// For elements whose size varies: a bound by their smallest size, so that the generated decoder's resize
    /// is bounded.
    void bound(std::int32_t count, std::size_t smallest, const char* field) {
        if (static_cast<std::size_t>(count) > left() / smallest) {
            fail(field,
                 "has " + std::to_string(count) + " elements, " + std::to_string(left()) + " bytes are left");
        }
    }
    void string(const char* field) {
        const std::int32_t count = length(field);
        if (count < 1) fail(field, "has no terminating zero");
        skip(static_cast<std::size_t>(count), field);
    }
    [[noreturn]] static void fail(const char* field, const std::string& reason) {
        throw MessageError(std::string(field) + " " + reason);
    }

  private:
    std::span<const std::uint8_t> bytes_;
    std::size_t at_ = 0;
};

// Bytes on the wire.
constexpr std::size_t kDouble = 8, kFloat = 4, kTransform = 7 * kDouble;

void walk_image(Walker& w) {
    w.skip(8 + 4 * 4, "image header");
    const std::int32_t size = w.length("image.size");
    w.array(size, 1, "image.data");
    const std::int32_t metadata = w.length("image.nmetadata");
    w.bound(metadata, 9, "image.metadata");
    for (std::int32_t i = 0; i < metadata; ++i) {
        w.string("image.metadata.key");
        w.array(w.length("image.metadata.n"), 1, "image.metadata.value");
    }
}

void walk_region(Walker& w) {
    w.skip(kDouble * (3 + 1 + 1 + 3 + 6) + kTransform + kFloat * (3 + 1), "region");
    w.array(w.length("region.n_rings"), 4, "region.ring_sizes");
    w.array(w.length("region.n_vertices"), 8, "region.vertices");
}

void walk_regions(Walker& w) {
    const std::int32_t count = w.length("n_regions");
    w.bound(count, 192, "regions");
    for (std::int32_t i = 0; i < count; ++i) walk_region(w);
}

void walk(Walker& w, const bot_core::images_t*) {
    w.skip(8, "utime");
    const std::int32_t count = w.length("n_images");
    w.array(count, 2, "image_types");
    w.bound(count, 32, "images");
    for (std::int32_t i = 0; i < count; ++i) walk_image(w);
}
void walk(Walker& w, const bot_core::rigid_transform_t*) {
    w.skip(8 + kTransform, "rigid_transform");
}
void walk(Walker& w, const bot_core::pose_t*) {
    w.skip(8 + 8 * 16, "pose");
}
void walk(Walker& w, const kinect::frame_msg_t*) {
    w.skip(8 + 8 + 4, "image header");
    w.array(w.length("image.image_data_nbytes"), 1, "image.image_data");
    w.skip(1, "image.image_data_format");
    w.skip(8 + 4, "depth header");
    w.array(w.length("depth.depth_data_nbytes"), 1, "depth.depth_data");
    w.skip(1 + 1 + 4, "depth format");
    w.skip(6 + 1 + 24 + 8 + 1 + 1, "sensor state");
}
void walk(Walker& w, const camera_info_t*) {
    w.skip(8 + 4, "utime");
    w.string("serial");
    w.skip(2 * (8 + 32) + 1 + kTransform + 6 * kDouble, "intrinsics");
    w.skip(8 + 1 + kTransform, "body_from_camera");
    for (const char* field : {"depth_distortion", "color_distortion"}) {
        w.skip(1, field);
        w.array(w.length(field), kDouble, field);
    }
}
void walk(Walker& w, const acceleration_t*) {
    w.skip(8 + 3 * kDouble, "acceleration");
}
void walk(Walker& w, const planar_regions_t*) {
    w.skip(8 + 4, "utime");
    walk_regions(w);
    w.skip(8, "session");
}
void walk(Walker& w, const odometry_t*) {
    w.skip(8 + 8 + 4 + 1 + kTransform + 4 + kTransform + 36 * kDouble + 12 + 8, "odometry");
}
void walk(Walker& w, const keyframe_t*) {
    w.skip(8 + 8 + 4 + 4 + kTransform + 4 + kTransform + 36 * kDouble, "keyframe");
    const std::int32_t features = w.length("n_features");
    w.array(features, 8, "pixels");
    w.array(features, 12, "points");
    w.array(features, 2, "regions_of");
    w.array(w.length("n_descriptor_bytes"), 1, "descriptors");
    walk_regions(w);
    w.skip(5 * 8 + 8 + 4, "noise");
}
void walk(Walker& w, const look_t*) {
    w.skip(8 + 4 + 4 + 8 + 4 + 4 + kTransform, "look");
    walk_regions(w);
    w.skip(8, "session");
}
void walk(Walker& w, const trajectory_t*) {
    w.skip(8 + 4 + 4 + 4 + kTransform, "trajectory");
    w.array(w.length("n_keyframes"), 4 + 8 + kTransform, "keyframes");
    w.skip(8, "session");
    w.array(w.length("n_components"), 4, "components");
}
void walk(Walker& w, const surfaces_t*) {
    w.skip(8 + 4, "surfaces");
    w.array(w.length("n_keyframes"), 4 + 2, "keyframes");
    w.array(w.length("n_regions"), 4, "planes");
    w.skip(8, "session");
}
void walk(Walker& w, const seen_space_t*) {
    w.skip(8 + 4 + kFloat + 4, "seen_space");
    w.array(w.length("n_bytes"), 1, "zipped");
    w.skip(8, "session");
}
void walk(Walker& w, const plane_map_t*) {
    w.skip(8 + 4 + 4 + 4 * 3 + 8 + 4 + 4, "utime");
    w.array(w.length("n_bytes"), 1, "packed");
}
void walk(Walker& w, const earlier_plane_map_t*) {
    w.skip(8 + 4 + 4 + 4 * 3, "utime");
    const std::int32_t planes = w.length("n_planes");
    w.bound(planes, 64, "planes");
    for (std::int32_t i = 0; i < planes; ++i) {
        w.skip(4 + 1 + 4 * (3 + 1 + 3 + 1 + 2 + 1 + 1 + 1) + 2 + 4, "plane");
        w.array(w.length("plane.n_rings", 2), 2, "plane.ring_sizes");
        w.array(w.length("plane.n_vertices"), 4, "plane.vertices");
    }
    w.array(w.length("n_lines"), 4 + 8, "lines");
    w.array(w.length("n_points"), 6, "points");
    w.skip(8, "session");
    const std::int32_t inferred = w.length("n_inferred");
    w.bound(inferred, 12, "inferred");
    for (std::int32_t i = 0; i < inferred; ++i) {
        w.skip(2 + 4, "inferred");
        w.array(w.length("inferred.n_rings", 2), 2, "inferred.ring_sizes");
        w.array(w.length("inferred.n_vertices"), 4, "inferred.vertices");
    }
    w.skip(4, "component");
}
void walk(Walker& w, const map_size_t*) {
    w.skip(8 + 4 + 8 * 6 + 8 + 8, "sizes");
}
void walk(Walker& w, const module_status_t*) {
    w.skip(8 + 4, "utime");
    w.string("module");
    w.skip(1, "state");
    w.string("text");
    w.skip(8 + 4 + 4 + 5 * 8 + 8 + 4 + 4, "counters");
}

/// A type as an earlier planemap had it: today's has more fields at its end, nothing else is different on the
/// wire.
struct Earlier {
    std::uint64_t fingerprint = 0;
    std::vector<std::uint8_t> missing;  ///< what today's message has at its end
};

std::vector<std::uint8_t> zeros(std::size_t count) {
    return std::vector<std::uint8_t>(count, 0);
}

template <typename T>
std::vector<Earlier> earlier(const T*) {
    return {};
}
std::vector<Earlier> earlier(const camera_info_t*) {
    constexpr std::size_t kNoLenses = std::size_t{2} * (1 + 4);
    std::vector<std::uint8_t> unknown = zeros(8 + 1 + kTransform + kNoLenses);
    constexpr std::size_t kW = 8 + 1 + 3 * 8;  // of the identity's quaternion, 1.0
    unknown[kW] = 0x3f;
    unknown[kW + 1] = 0xf0;
    return {{0xa60897c52a8f1405, zeros(kNoLenses)}, {0xbb0361eb1a14a65e, unknown}};
}
std::vector<Earlier> earlier(const keyframe_t*) {
    return {{0x13937206eb19e2fb, {0xff, 0xff, 0xff, 0xff}}};  // of a chain that is not known
}
std::vector<Earlier> earlier(const trajectory_t*) {
    return {{0x8c700ec367b299b8, zeros(4)}};
}
std::vector<Earlier> earlier(const planar_regions_t*) {
    return {{0xaedd3398cc393ca2, zeros(8)}};
}
std::vector<Earlier> earlier(const earlier_plane_map_t*) {
    return {{0x890cd1fe3f86f0fa, zeros(4 + 4)}, {0xad69623d7bd0a548, zeros(8 + 4 + 4)}};
}
std::vector<Earlier> earlier(const map_size_t*) {
    return {{0xcc3bbfa6fd82ffe7, zeros(8)}};
}
std::vector<Earlier> earlier(const module_status_t*) {
    std::vector<std::uint8_t> unmeasured = zeros(8 + 4 + 4);
    for (const std::size_t age : {std::size_t{8}, std::size_t{12}}) {  // -1.0f
        unmeasured[age] = 0xbf;
        unmeasured[age + 1] = 0x80;
    }
    return {{0xd375fa85ae3e81e7, unmeasured}};
}

/// A message of the type as it was earlier, as today's has it.
std::vector<std::uint8_t> completed(std::span<const std::uint8_t> bytes, std::uint64_t fingerprint,
                                    const std::vector<std::uint8_t>& missing) {
    std::vector<std::uint8_t> all(bytes.begin(), bytes.end());
    for (std::size_t i = 0; i < 8; ++i) all[i] = static_cast<std::uint8_t>(fingerprint >> (56 - 8 * i));
    all.insert(all.end(), missing.begin(), missing.end());
    return all;
}

}  // namespace

std::uint64_t fingerprint_of(std::span<const std::uint8_t> bytes) {
    std::uint64_t fingerprint = 0;
    for (std::size_t i = 0; i < 8 && bytes.size() >= 8; ++i) fingerprint = fingerprint << 8 | bytes[i];
    return fingerprint;
}

template <typename T>
std::vector<std::uint64_t> fingerprints() {
    std::vector<std::uint64_t> all = {static_cast<std::uint64_t>(T::getHash())};
    for (const Earlier& type : earlier(static_cast<const T*>(nullptr))) all.push_back(type.fingerprint);
    return all;
}

template <typename T>
bool is_a(std::span<const std::uint8_t> bytes) {
    const std::vector<std::uint64_t> known = fingerprints<T>();
    return std::find(known.begin(), known.end(), fingerprint_of(bytes)) != known.end();
}

template <typename T>
T decode(std::span<const std::uint8_t> bytes) {
    const std::string type = T::getTypeName();
    if (bytes.size() < 8)
        throw MessageError(type + ": " + std::to_string(bytes.size()) + " bytes, not even a fingerprint");
    if (bytes.size() > static_cast<std::size_t>(std::numeric_limits<int>::max()))
        throw MessageError(type + ": over 2 GiB");
    const std::uint64_t fingerprint = fingerprint_of(bytes), today = static_cast<std::uint64_t>(T::getHash());
    if (fingerprint != today) {
        for (const Earlier& then : earlier(static_cast<const T*>(nullptr)))
            if (fingerprint == then.fingerprint) return decode<T>(completed(bytes, today, then.missing));
        throw OtherTypeError(type + ": the fingerprint is another type's");
    }
    try {
        Walker walker(bytes.subspan(8));
        walk(walker, static_cast<const T*>(nullptr));
        if (walker.left() != 0) throw MessageError(std::to_string(walker.left()) + " bytes too many");
        T message;
        const int used = message.decode(bytes.data(), 0, static_cast<int>(bytes.size()));
        if (used != static_cast<int>(bytes.size()))
            throw MessageError("the decoder read " + std::to_string(used) + " bytes");
        return message;
    } catch (const std::exception& error) {
        throw MessageError(type + ": " + error.what());
    }
}

/// For each type that decode.hpp names.
#define PLANEMAP_DECODES(T)                               \
    template T decode<T>(std::span<const std::uint8_t>);  \
    template bool is_a<T>(std::span<const std::uint8_t>); \
    template std::vector<std::uint64_t> fingerprints<T>();

PLANEMAP_DECODES(bot_core::images_t)
PLANEMAP_DECODES(bot_core::pose_t)
PLANEMAP_DECODES(bot_core::rigid_transform_t)
PLANEMAP_DECODES(kinect::frame_msg_t)
PLANEMAP_DECODES(acceleration_t)
PLANEMAP_DECODES(camera_info_t)
PLANEMAP_DECODES(planar_regions_t)
PLANEMAP_DECODES(odometry_t)
PLANEMAP_DECODES(keyframe_t)
PLANEMAP_DECODES(look_t)
PLANEMAP_DECODES(trajectory_t)
PLANEMAP_DECODES(surfaces_t)
PLANEMAP_DECODES(plane_map_t)
PLANEMAP_DECODES(earlier_plane_map_t)
PLANEMAP_DECODES(seen_space_t)
PLANEMAP_DECODES(map_size_t)
PLANEMAP_DECODES(module_status_t)

#undef PLANEMAP_DECODES

}  // namespace planemap::messages
