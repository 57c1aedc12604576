// SPDX-License-Identifier: BSD-3-Clause
// The office seen from one place while one thing changes. Times are seconds after the change.
#include <cmath>
#include <numbers>

#include "simulator/looks.hpp"
#include "simulator/office.hpp"

namespace planemap::simulator {

using Eigen::Vector3d;

namespace {

/// A hand that holds the camera at a place: it sways a little about it and looks about the target.
std::vector<Waypoint> look_on(const Vector3d& place, const Vector3d& target) {
    constexpr int kSteps = 12;
    constexpr double kSway = 0.15, kRise = 0.06, kLook = 0.45;
    const Vector3d aside = (target - place).cross(kUp).normalized();
    std::vector<Waypoint> tour;
    for (int i = 0; i < kSteps; ++i) {
        const double angle = 2 * std::numbers::pi * i / kSteps;
        tour.push_back({place + kSway * std::cos(angle) * aside + kRise * std::sin(angle) * kUp,
                        target + kLook * std::sin(angle) * aside + 0.1 * std::cos(2 * angle) * kUp});
    }
    return tour;
}

/// Where the camera stands, and what it looks at: the free floor before the east wall.
const Vector3d kPlace(1.9, 2.6, 1.45), kFloor(3.9, 2.3, 0.6);

World with_tour(WorldBuilder& office, const Vector3d& place, const Vector3d& target) {
    World& world = office.world();
    world.tour = look_on(place, target);
    world.pace = 0.4;
    return std::move(world);
}

/// The office with a box of 90 x 60 x 86 cm, 1.8 m ahead.
World with_box(const std::string& name, std::uint64_t seed, double texel_scale, Body box) {
    WorldBuilder office(name, seed, texel_scale);
    add_office(office, true);
    office.begin_body(std::move(box));
    office.add_box("box", {{3.7, 2.6, 0}, kSouth}, {0.9, 0.6, 0.86}, kOak, kPoster, {.bottom = true});
    office.end_body();
    return with_tour(office, kPlace, kFloor);
}

Pose shifted(const Vector3d& by) {
    Pose pose = Pose::Identity();
    pose.translation() = by;
    return pose;
}

/// A rotation about an axis through a point.
Pose turned(const Vector3d& point, const Vector3d& axis, double angle) {
    Pose pose = Pose::Identity();
    pose.linear() = Eigen::AngleAxisd(angle, axis).toRotationMatrix();
    pose.translation() = point - pose.linear() * point;
    return pose;
}

constexpr double kStep_s = 0.1;  // between the keys of a path

/// A person's walk along a line at 1.2 m/s, with a rest of 2 s at one of its corners.
struct Walk {
    std::vector<Vector3d> line;
    std::size_t rest_at = 0;

    static constexpr double kSpeed_m_s = 1.2, kRest_s = 2;

    double length(std::size_t corner) const {
        double sum = 0;
        for (std::size_t i = 1; i <= corner; ++i) sum += (line[i] - line[i - 1]).norm();
        return sum;
    }
    double duration() const { return length(line.size() - 1) / kSpeed_m_s + kRest_s; }
    /// Metres walked after so many seconds.
    double walked(double seconds) const {
        const double before = length(rest_at) / kSpeed_m_s;
        return kSpeed_m_s * (seconds < before ? seconds : std::max(before, seconds - kRest_s));
    }
    Vector3d at(double metres) const {
        for (std::size_t i = 1; i < line.size(); ++i) {
            const double step = (line[i] - line[i - 1]).norm();
            if (metres < step) return line[i - 1] + metres / step * (line[i] - line[i - 1]);
            metres -= step;
        }
        return line.back();
    }
    /// Standing upright at the place, facing what comes next.
    Pose pose(double seconds) const {
        constexpr double kAhead_m = 0.3;
        const double metres = std::min(walked(seconds), length(line.size() - 1) - 2 * kAhead_m);
        const Vector3d ahead = at(metres + kAhead_m) - at(metres - kAhead_m);
        Pose pose = Pose::Identity();
        pose.linear() = Eigen::AngleAxisd(std::atan2(ahead.y(), ahead.x()), kUp).toRotationMatrix();
        pose.translation() = at(metres);
        return pose;
    }
    /// A part of the person, that swings from the hip by `swing` (radians) with the steps.
    Body part(const std::string& name, double swing) const {
        constexpr double kHip_m = 0.85, kPace_m = 1.4;  // of two steps
        Body body{name, 0, duration()};
        const auto count = static_cast<int>(std::ceil(duration() / kStep_s));
        for (int i = 0; i <= count; ++i) {
            const double seconds = i * kStep_s;
            const double angle = swing * std::sin(2 * std::numbers::pi * walked(seconds) / kPace_m);
            body.path.push_back({seconds, pose(seconds) * turned(kHip_m * kUp, kNorth, angle)});
        }
        return body;
    }
};

/// A column of eight sides.
void add_column(WorldBuilder& builder, const std::string& name, const Vector3d& foot, double radius,
                double height, const Look& look) {
    constexpr int kSides = 8;
    const double half = radius * std::tan(std::numbers::pi / kSides);
    for (int i = 0; i < kSides; ++i) {
        const double angle = 2 * std::numbers::pi * i / kSides;
        const Vector3d out(std::cos(angle), std::sin(angle), 0), right = kUp.cross(out);
        builder.add_panel(name + " " + std::to_string(i + 1),
                          foot + radius * out - half * right + height * kUp, right, kDown, 2 * half, height,
                          look);
    }
}

/// A person of 1.78 m who faces east at the origin, in three bodies.
void add_person(WorldBuilder& builder, const Walk& walk) {
    constexpr Look kCloth{Pattern::kCarpet, {0.30f, 0.36f, 0.52f}},
        kTrousers{Pattern::kCarpet, {0.22f, 0.2f, 0.2f}}, kSkin{Pattern::kPaint, {0.80f, 0.62f, 0.52f}};
    builder.begin_body(walk.part("person", 0));
    builder.add_box("person chest", {{-0.12, 0.22, 0.85}, kSouth}, {0.44, 0.24, 0.62}, kCloth, kCloth, {});
    add_column(builder, "person head", {0, 0, 1.5}, 0.1, 0.28, kSkin);
    for (const bool left : {true, false}) {
        const std::string name = left ? "person left leg" : "person right leg";
        builder.begin_body(walk.part(name, left ? 0.4 : -0.4));
        builder.add_box(name, {{-0.08, left ? 0.18 : -0.02, 0.02}, kSouth}, {0.16, 0.16, 0.83}, kTrousers,
                        kTrousers, {});
    }
    builder.end_body();
}

}  // namespace

World make_appearing(std::uint64_t seed, double texel_scale) {
    return with_box("appearing", seed, texel_scale, {"box", 0, Body::kAlways});
}

World make_vanishing(std::uint64_t seed, double texel_scale) {
    return with_box("vanishing", seed, texel_scale, {"box", -Body::kAlways, 0});
}

World make_moved(std::uint64_t seed, double texel_scale) {
    Body box{"box"};
    box.path = {{0, Pose::Identity()}, {0, shifted({0, 0.35, 0})}};
    return with_box("moved", seed, texel_scale, std::move(box));
}

World make_door(std::uint64_t seed, double texel_scale) {
    constexpr double kOpens_s = 2;
    WorldBuilder office("door", seed, texel_scale);
    add_office(office, false);
    Body door{"door"};
    const auto steps = static_cast<int>(std::lround(kOpens_s / kStep_s));
    for (int i = 0; i <= steps; ++i)
        door.path.push_back({i * kStep_s, turned(kOfficeHinge, kUp, kOfficeDoorOpened * i / steps)});
    office.begin_body(std::move(door));
    add_office_door(office, 0);
    office.end_body();
    return with_tour(office, {3.3, 2.6, 1.45}, {3.5, 0, 1.15});
}

World make_walker(std::uint64_t seed, double texel_scale) {
    WorldBuilder office("walker", seed, texel_scale);
    add_office(office, true);
    // In from the corridor, around before the camera, and out to the corridor's other end.
    add_person(office, {{{1.6, -0.9, 0},
                         {3.2, -0.9, 0},
                         {3.55, -0.5, 0},
                         {3.55, 0.5, 0},
                         {3.7, 1.8, 0},
                         {4.1, 2.6, 0},
                         {3.7, 3.3, 0},
                         {3.3, 2.9, 0},
                         {3.5, 1.6, 0},
                         {3.55, 0.5, 0},
                         {3.55, -0.5, 0},
                         {4.0, -0.9, 0},
                         {5.0, -0.9, 0}},
                        5});
    return with_tour(office, {1.8, 2.9, 1.45}, {4.0, 1.6, 0.9});
}

}  // namespace planemap::simulator
