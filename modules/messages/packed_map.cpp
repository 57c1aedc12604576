// SPDX-License-Identifier: BSD-3-Clause
#include "messages/packed_map.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <string>
#include <utility>

#include "messages/checks.hpp"
#include "messages/map_meetings.hpp"
#include "messages/varint.hpp"

namespace planemap::messages {

namespace {

/// Of a normal's two octahedral coordinates, from -1 to 1.
constexpr std::int64_t kNormalSteps = 1 << 16;
constexpr double kDStep_m = 0.0005;
constexpr std::int64_t kHalfTurn = 8192;
constexpr double kAngleStep_rad = std::numbers::pi / static_cast<double>(kHalfTurn);
constexpr double kRmsStep_m = 0.0001;
/// Nothing lies further out, in any direction of its plane or of the world.
constexpr double kFarthest_m = 3e5;
/// Inliers are sent as mantissa and exponent: to 0.2 %.
constexpr int kMantissaBits = 9, kMaxExponent = 110;
constexpr int kPackedLimit = 32767;
constexpr std::size_t kMostRings = 32767;

// Bytes that there are at the least.
constexpr std::size_t kLeastPlane = 10, kLeastRing = 1 + 3 * 2, kLeastLine = 4, kLeastPoint = 3,
                      kLeastInferred = 2;

/// A value in whole steps, of which there are at most so many; of no number 0.
std::int64_t steps(double value, double step, std::int64_t most) {
    const double count = std::round(value / step), limit = static_cast<double>(most);
    return std::isnan(count) ? 0 : static_cast<std::int64_t>(std::clamp(count, -limit, limit));
}
std::int64_t most_steps(double step) {
    return static_cast<std::int64_t>(kFarthest_m / step);
}

/// The lower half of the octahedron as it lies about the upper one, and back.
Eigen::Vector2d folded(const Eigen::Vector2d& f) {
    return {std::copysign(1 - std::abs(f.y()), f.x() < 0 ? -1.0 : 1.0),
            std::copysign(1 - std::abs(f.x()), f.y() < 0 ? -1.0 : 1.0)};
}

/// How a plane and the frame of its outlines lie, in steps. The frame's origin is the plane's point nearest
/// to the world's, its x axis that of the box (MapPlane::angle), z the normal.
struct PlaneSteps {
    std::int64_t u = 0, v = 0;  ///< of the normal
    std::int64_t d = 0, angle = 0;

    Eigen::Vector3d normal() const {
        Eigen::Vector2d f(static_cast<double>(u), static_cast<double>(v));
        f /= static_cast<double>(kNormalSteps);
        const double z = 1 - std::abs(f.x()) - std::abs(f.y());
        if (z < 0) f = folded(f);
        return Eigen::Vector3d(f.x(), f.y(), z).normalized();
    }
    /// A plane that lies so, with its box at the frame's origin.
    MapPlane laid() const {
        MapPlane plane;
        plane.normal = normal().cast<float>();
        plane.center = (static_cast<double>(-d) * kDStep_m * normal()).cast<float>();
        plane.angle = static_cast<float>(static_cast<double>(angle) * kAngleStep_rad);
        return plane;
    }
};

PlaneSteps plane_steps(const MapPlane& plane) {
    PlaneSteps s;
    const Eigen::Vector3d n = plane.plane().normal;
    Eigen::Vector2d f = n.head<2>() / n.lpNorm<1>();
    if (n.z() < 0) f = folded(f);
    s.u = steps(f.x(), 1.0 / static_cast<double>(kNormalSteps), kNormalSteps);
    s.v = steps(f.y(), 1.0 / static_cast<double>(kNormalSteps), kNormalSteps);
    const Plane rounded{s.normal(), -s.normal().dot(plane.center.cast<double>())};
    s.d = steps(rounded.d, kDStep_m, most_steps(kDStep_m));
    MapPlane moved = plane;
    moved.move_to(rounded);
    s.angle = steps(static_cast<double>(moved.angle), kAngleStep_rad, kHalfTurn);
    if (s.angle == -kHalfTurn) s.angle = kHalfTurn;  // the same
    return s;
}

/// The rings of an outline, in steps of the message's unit, in the frame of PlaneSteps.
struct RingSteps {
    std::vector<std::int16_t> sizes;
    std::vector<std::array<std::int64_t, 2>> vertices;
};

RingSteps ring_steps(const MapOutline& outline, const Pose& frame_from_plane, double unit) {
    RingSteps rings;
    const std::int64_t most = most_steps(unit);
    for_each_packed(
        outline.packed, [&](std::size_t size) { rings.sizes.push_back(static_cast<std::int16_t>(size)); },
        [&](std::int16_t x, std::int16_t y) {
            const double step = static_cast<double>(outline.unit);
            const Eigen::Vector3d p = frame_from_plane * Eigen::Vector3d(step * x, step * y, 0);
            rings.vertices.push_back({steps(p.x(), unit, most), steps(p.y(), unit, most)});
        });
    return rings;
}

/// Twice the middle of what the rings reach, and how far they reach on either side, in steps.
struct Reach {
    std::array<std::int64_t, 2> twice_middle{0, 0}, size{0, 0};
};

Reach reach_of(const RingSteps& rings) {
    Reach reach;
    if (rings.vertices.empty()) return reach;
    for (std::size_t k = 0; k < 2; ++k) {
        const auto [low, high] = std::minmax_element(rings.vertices.begin(), rings.vertices.end(),
                                                     [k](auto& a, auto& b) { return a[k] < b[k]; });
        reach.twice_middle[k] = (*low)[k] + (*high)[k];
        reach.size[k] = (*high)[k] - (*low)[k];
    }
    return reach;
}

/// The rings about a point, in half steps, which hold them exactly; of what reaches further than 16 bits in a
/// multiple.
MapOutline outline_about(const std::array<std::int64_t, 2>& twice_middle, const RingSteps& rings,
                         double unit) {
    std::int64_t farthest = 0;
    for (const auto& vertex : rings.vertices)
        for (std::size_t k = 0; k < 2; ++k)
            farthest = std::max(farthest, std::abs(2 * vertex[k] - twice_middle[k]));
    const std::int64_t multiple = std::max<std::int64_t>(1, (farthest + kPackedLimit - 1) / kPackedLimit);
    MapOutline outline;
    outline.unit = static_cast<float>(unit / 2 * static_cast<double>(multiple));
    outline.packed.reserve(rings.sizes.size() + 2 * rings.vertices.size());
    std::size_t next = 0;
    for (const std::int16_t size : rings.sizes) {
        outline.packed.push_back(size);
        for (const std::size_t stop = next + static_cast<std::size_t>(size); next < stop; ++next)
            for (std::size_t k = 0; k < 2; ++k)
                outline.packed.push_back(static_cast<std::int16_t>(
                    std::lround(static_cast<double>(2 * rings.vertices[next][k] - twice_middle[k]) /
                                static_cast<double>(multiple))));
    }
    return outline;
}

/// The plane as who hears it has it: the box is around the outline, and the area the outline's.
MapPlane heard(const PlaneSteps& lies, const RingSteps& rings, double unit) {
    MapPlane plane = lies.laid();
    const Reach reach = reach_of(rings);
    const auto half = [&](std::int64_t twice) { return unit / 2 * static_cast<double>(twice); };
    plane.center = (plane.world_from_plane() *
                    Eigen::Vector3d(half(reach.twice_middle[0]), half(reach.twice_middle[1]), 0))
                       .cast<float>();
    plane.half_extents = Eigen::Vector2d(half(reach.size[0]), half(reach.size[1])).cast<float>();
    plane.outline = outline_about(reach.twice_middle, rings, unit);
    plane.area = static_cast<float>(area(plane.outline.rings()));
    return plane;
}

std::uint64_t inlier_steps(float inliers) {
    constexpr std::int64_t kMost = (1 << kMantissaBits) - 1;
    double count = std::isnan(inliers) ? 3 : std::max(3.0, static_cast<double>(inliers));
    std::uint64_t exponent = 0;
    for (; std::round(count) > static_cast<double>(kMost) && exponent < kMaxExponent; ++exponent) count /= 2;
    return exponent << kMantissaBits | static_cast<std::uint64_t>(steps(count, 1, kMost));
}

float inliers_of(std::uint64_t sent) {
    const std::uint64_t mantissa = sent & ((1 << kMantissaBits) - 1), exponent = sent >> kMantissaBits;
    require(exponent <= kMaxExponent && mantissa >= 3, "plane.inliers", "are fewer than 3, or too many");
    return std::ldexp(static_cast<float>(mantissa), static_cast<int>(exponent));
}

class Packer {
  public:
    explicit Packer(float unit) : unit_(unit) {}

    std::vector<std::uint8_t> packed(const PlaneMap& map) {
        heard_.reserve(map.planes.size());
        out_.put(map.planes.size());
        int last_id = -1;
        for (const MapPlane& plane : map.planes) {
            put_plane(plane, last_id);
            last_id = plane.id;
        }
        put_lines(map);
        put_points(map);
        out_.put(map.inferred.size());
        for (const InferredRings& rings : map.inferred) {
            const std::size_t plane = index(map, rings.plane);
            out_.put(plane);
            put_rings(ring_steps(rings.outline, frame_from_plane_[plane], unit_));
        }
        return out_.take();
    }

  private:
    static std::size_t index(const PlaneMap& map, int id) {
        return static_cast<std::size_t>(map.find(id) - map.planes.data());
    }

    void put_plane(const MapPlane& plane, int last_id) {
        const PlaneSteps lies = plane_steps(plane);
        frame_from_plane_.push_back(lies.laid().world_from_plane().inverse(Eigen::Isometry) *
                                    plane.world_from_plane());
        const RingSteps rings = ring_steps(plane.outline, frame_from_plane_.back(), unit_);
        out_.put_signed(std::int64_t{plane.id} - last_id - 1);
        out_.put(static_cast<std::uint64_t>(plane.label));
        for (const std::int64_t s : {lies.u, lies.v, lies.d, lies.angle}) out_.put_signed(s);
        out_.put(static_cast<std::uint64_t>(std::max<std::int64_t>(
            0, steps(static_cast<double>(plane.rms), kRmsStep_m, most_steps(kRmsStep_m)))));
        out_.put(inlier_steps(plane.inliers));
        out_.put(static_cast<std::uint64_t>(std::max<int>(0, plane.keyframes)));
        put_rings(rings);
        heard_.push_back(heard(lies, rings, unit_));
    }

    void put_rings(const RingSteps& rings) {
        if (rings.sizes.size() > kMostRings)
            throw std::length_error("plane map: an outline of too many rings");
        out_.put(rings.sizes.size());
        std::array<std::int64_t, 2> last{0, 0};
        std::size_t next = 0;
        for (const std::int16_t size : rings.sizes) {
            out_.put(static_cast<std::uint64_t>(size));
            for (const std::size_t stop = next + static_cast<std::size_t>(size); next < stop; ++next) {
                for (std::size_t k = 0; k < 2; ++k) out_.put_signed(rings.vertices[next][k] - last[k]);
                last = rings.vertices[next];
            }
        }
    }

    void put_lines(const PlaneMap& map) {
        std::vector<std::array<std::int64_t, 4>> lines;
        for (const IntersectionLine& line : map.lines) {
            const std::size_t a = index(map, line.plane_a), b = index(map, line.plane_b);
            const auto shared = shared_line(heard_[a], heard_[b]);
            if (!shared) continue;
            const auto along = [&](const Eigen::Vector3f& p) {
                return steps((p.cast<double>() - shared->origin).dot(shared->direction), unit_,
                             most_steps(unit_));
            };
            lines.push_back({static_cast<std::int64_t>(a), static_cast<std::int64_t>(b), along(line.from),
                             along(line.to)});
        }
        out_.put(lines.size());
        for (const auto& [a, b, start, stop] : lines) {
            out_.put(static_cast<std::uint64_t>(a));
            out_.put(static_cast<std::uint64_t>(b));
            out_.put_signed(start);
            out_.put_signed(stop - start);
        }
    }

    void put_points(const PlaneMap& map) {
        std::vector<std::array<std::size_t, 3>> points;
        for (const IntersectionPoint& point : map.points) {
            const std::array planes{index(map, point.planes[0]), index(map, point.planes[1]),
                                    index(map, point.planes[2])};
            if (shared_point(heard_[planes[0]], heard_[planes[1]], heard_[planes[2]]))
                points.push_back(planes);
        }
        out_.put(points.size());
        for (const auto& planes : points)
            for (const std::size_t plane : planes) out_.put(plane);
    }

    double unit_;
    VarintWriter out_;
    std::vector<MapPlane> heard_;         ///< of the planes so far
    std::vector<Pose> frame_from_plane_;  ///< from where their outlines are
};

class Unpacker {
  public:
    Unpacker(std::span<const std::uint8_t> bytes, float unit) : in_(bytes), unit_(unit) {}

    void unpack(PlaneMap& map) {
        const std::size_t planes = in_.count("n_planes", kLeastPlane);
        map.planes.reserve(planes);
        twice_middle_.reserve(planes);
        for (std::size_t i = 0; i < planes; ++i) map.planes.push_back(plane(map));
        const std::size_t lines = in_.count("n_lines", kLeastLine);
        map.lines.reserve(lines);
        for (std::size_t i = 0; i < lines; ++i) map.lines.push_back(line(map));
        const std::size_t points = in_.count("n_points", kLeastPoint);
        map.points.reserve(points);
        for (std::size_t i = 0; i < points; ++i) map.points.push_back(point(map));
        const std::size_t inferred = in_.count("n_inferred", kLeastInferred);
        map.inferred.reserve(inferred);
        for (std::size_t i = 0; i < inferred; ++i) {
            const std::size_t index = plane_index(map, "inferred.plane");
            const int id = map.planes[index].id;
            require(map.inferred.empty() || id > map.inferred.back().plane, "inferred.plane",
                    "does not ascend");
            map.inferred.push_back({id, outline_about(twice_middle_[index], rings("inferred.rings"), unit_)});
        }
        if (in_.left() != 0) fail("packed", "has " + std::to_string(in_.left()) + " bytes too many");
    }

  private:
    /// A number of steps of at most so many.
    std::int64_t bounded(const char* field, std::int64_t most) {
        const std::int64_t value = in_.get_signed(field);
        require(std::abs(value) <= most, field, "is too far out");
        return value;
    }

    MapPlane plane(const PlaneMap& map) {
        const std::int64_t last_id = map.planes.empty() ? -1 : map.planes.back().id;
        const std::int64_t id = in_.get_signed("plane.id") + last_id + 1;
        require(map.planes.empty() || id > last_id, "plane.id", "does not ascend");
        require(std::in_range<std::int32_t>(id), "plane.id", "is too large");
        const std::uint64_t label = in_.get("plane.label");
        require(label <= static_cast<std::uint64_t>(PlaneLabel::kVertical), "plane.label", "is unknown");
        PlaneSteps lies;
        lies.u = bounded("plane.normal", kNormalSteps);
        lies.v = bounded("plane.normal", kNormalSteps);
        lies.d = bounded("plane.d", most_steps(kDStep_m));
        lies.angle = bounded("plane.angle", kHalfTurn);
        const std::uint64_t rms = in_.get("plane.rms");
        require(rms <= static_cast<std::uint64_t>(most_steps(kRmsStep_m)), "plane.rms", "is too large");
        const float inliers = inliers_of(in_.get("plane.inliers"));
        const std::uint64_t keyframes = in_.get("plane.keyframes");
        require(keyframes <= 32767, "plane.keyframes", "are more than 32767");
        const RingSteps outline = rings("plane.rings");
        twice_middle_.push_back(reach_of(outline).twice_middle);
        MapPlane plane = heard(lies, outline, unit_);
        plane.id = static_cast<int>(id);
        plane.label = static_cast<PlaneLabel>(label);
        plane.rms = static_cast<float>(static_cast<double>(rms) * kRmsStep_m);
        plane.inliers = inliers;
        plane.keyframes = static_cast<std::int16_t>(keyframes);
        return plane;
    }

    RingSteps rings(const char* field) {
        RingSteps rings;
        const std::size_t count = in_.count(field, kLeastRing);
        require(count <= kMostRings, field, "are more than 32767");
        rings.sizes.resize(count);
        std::array<std::int64_t, 2> last{0, 0};
        const std::int64_t most = most_steps(unit_);
        for (std::int16_t& size : rings.sizes) {
            const std::size_t vertices = in_.count(field, 2);
            require(vertices >= 3 && vertices <= kMaxRingVertices, field,
                    "has a ring of fewer than 3 or more than 32767 vertices");
            size = static_cast<std::int16_t>(vertices);
            for (std::size_t i = 0; i < vertices; ++i) {
                for (std::int64_t& k : last) {
                    k += bounded(field, 2 * most);
                    require(std::abs(k) <= most, field, "has a vertex that is too far out");
                }
                rings.vertices.push_back(last);
            }
        }
        return rings;
    }

    std::size_t plane_index(const PlaneMap& map, const char* field) {
        const std::uint64_t index = in_.get(field);
        require(index < map.planes.size(), field, "is not a plane of the map");
        return static_cast<std::size_t>(index);
    }

    IntersectionLine line(const PlaneMap& map) {
        const MapPlane &a = map.planes[plane_index(map, "line.plane_a")],
                       &b = map.planes[plane_index(map, "line.plane_b")];
        const auto shared = shared_line(a, b);
        require(shared.has_value(), "line", "joins parallel planes");
        const std::int64_t most = most_steps(unit_);
        const std::int64_t start = bounded("line.start", most), length = bounded("line.length", 2 * most);
        const auto at = [&](std::int64_t along) -> Eigen::Vector3f {
            return (shared->origin + unit_ * static_cast<double>(along) * shared->direction).cast<float>();
        };
        return {a.id, b.id, at(start), at(start + length)};
    }

    IntersectionPoint point(const PlaneMap& map) {
        std::array<const MapPlane*, 3> planes{};
        for (const MapPlane*& plane : planes) plane = &map.planes[plane_index(map, "point.planes")];
        const auto position = shared_point(*planes[0], *planes[1], *planes[2]);
        require(position.has_value(), "point", "joins planes that do not meet in one point");
        return {{planes[0]->id, planes[1]->id, planes[2]->id}, position->cast<float>()};
    }

    VarintReader in_;
    double unit_;
    std::vector<std::array<std::int64_t, 2>> twice_middle_;  ///< of the planes' outlines
};

}  // namespace

std::vector<std::uint8_t> packed_map(const PlaneMap& map, float unit) {
    return Packer(unit).packed(map);
}

void unpack_map(std::span<const std::uint8_t> bytes, float unit, PlaneMap& map) {
    require(std::isfinite(unit) && unit >= 0.0001f && unit <= 1, "unit", "is not between 0.1 mm and 1 m");
    map.planes.clear();
    map.lines.clear();
    map.points.clear();
    map.inferred.clear();
    Unpacker(bytes, unit).unpack(map);
}

}  // namespace planemap::messages
