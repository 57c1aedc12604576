// SPDX-License-Identifier: BSD-3-Clause
// The OctoMap process over a long walk: how long messages wait, what is dropped, how soon it stops.
//   octomap_benchmark [keyframes=3000] [keyframes a second=30] [background=1]
//   octomap_benchmark insertion ...   what depth images cost beside OctoMap's own insertion: see there
// A camera of 640 x 480 walks through rooms and comes back to them; every hundredth keyframe closes a loop,
// which moves all keyframes since the last one and, every fifth time, all there are. Keyframes come at a
// fixed rate, as over udp: what a handler holds up waits in a queue of 8 frames, and then the newest is
// dropped.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <deque>
#include <numbers>
#include <planemap/map_size_t.hpp>
#include <string>
#include <thread>
#include <vector>

#include "messages/channels.hpp"
#include "messages/convert.hpp"
#include "messages/decode.hpp"
#include "octomap/insertion_benchmark.hpp"
#include "octomap/octomap_shell.hpp"

namespace planemap::octomap {
namespace {

using Clock = std::chrono::steady_clock;

double ms(Clock::duration d) {
    return std::chrono::duration<double, std::milli>(d).count();
}

CameraInfo camera() {
    CameraInfo camera;
    camera.depth = camera.color = {640, 480, 525, 525, 319.5, 239.5};
    return camera;
}

constexpr double kRoom_m = 6, kHeight_m = 2.5;

/// Depth of a room of 6 x 6 x 2.5 m with a pillar, seen from a pose in it.
DepthImage depth_at(const Pose& room_from_camera) {
    const CameraInfo info = camera();
    DepthImage depth(info.depth.width, info.depth.height);
    const Eigen::Vector3d origin = room_from_camera.translation();
    const Eigen::Vector3d low(-kRoom_m / 2, -kHeight_m / 2, -kRoom_m / 2);
    for (int v = 0; v < depth.height; ++v) {
        for (int u = 0; u < depth.width; ++u) {
            const Eigen::Vector3d ray = room_from_camera.linear() * info.depth.unproject(u, v, 1);
            double z = 1e9;
            for (int axis = 0; axis < 3; ++axis) {
                const double wall = ray[axis] > 0 ? -low[axis] : low[axis];
                if (std::abs(ray[axis]) > 1e-9) z = std::min(z, (wall - origin[axis]) / ray[axis]);
            }
            for (const int axis : {0, 2}) {  // the pillar's side that faces the camera
                const double side = ray[axis] > 0 ? -0.3 : 0.3;
                const double at = std::abs(ray[axis]) > 1e-9 ? (side - origin[axis]) / ray[axis] : -1;
                if (at > 0.2 && std::abs(origin[2 - axis] + at * ray[2 - axis]) < 0.3) z = std::min(z, at);
            }
            // A millimetre of pattern, so that the image does not compress to nothing.
            depth(u, v) = static_cast<std::uint16_t>(1000 * z + (u * 7 + v * 13) % 5 - 2);
        }
    }
    return depth;
}

struct View {
    Pose world_from_camera;
    bot_core::images_t frame;
};

/// 60 views a room, 10 rooms in a row; then again from the first.
std::vector<View> make_views() {
    std::vector<View> views;
    for (int room = 0; room < 10; ++room) {
        for (int i = 0; i < 60; ++i) {
            const double angle = 2 * std::numbers::pi * i / 60;
            const Eigen::Vector3d p(1.2 * std::cos(angle), 0, 1.2 * std::sin(angle));
            const Pose in_room =
                make_pose(p, Eigen::Quaterniond(Eigen::AngleAxisd(angle + 0.7 * std::sin(3 * angle),
                                                                  -Eigen::Vector3d::UnitY())));
            View view;
            view.world_from_camera = in_room;
            view.world_from_camera.translation().x() += kRoom_m * room;
            view.frame.utime = 0;
            view.frame.image_types = {bot_core::images_t::DEPTH_MM_ZIPPED};
            view.frame.images = {
                messages::depth_image_message(depth_at(in_room), 0, messages::DepthEncoding::kZipped)};
            view.frame.n_images = 1;
            views.push_back(std::move(view));
        }
    }
    return views;
}

/// What came while the shell was busy.
struct Pending {
    int id;
    KeyframeTrajectory trajectory;
};

int run(int keyframes, double rate_hz, bool background) {
    const std::vector<View> views = make_views();
    std::printf("%d keyframes at %.0f a second, built in the %s\n", keyframes, rate_hz,
                background ? "background" : "handler");
    messages::Bus bus("memq://");
    auto shell =
        std::make_unique<OctomapShell>(bus, std::make_shared<messages::FrameDecoder>(bus), OctomapOptions{},
                                       background ? Building::kInBackground : Building::kInHandler);
    map_size_t last{};
    int states = 0;
    bus.subscribe(messages::channels::kOctomapSize, [&](const messages::RawMessage& m) {
        last = messages::decode<map_size_t>(m.bytes);
        ++states;
    });
    bus.publish(messages::channels::kCameraInfo, messages::to_message(camera(), 0, 0));
    bus.drain();

    std::vector<double> handler_ms;
    KeyframeTrajectory trajectory;
    std::deque<Pending> queue;
    int overflow = 0, made = 0;
    const Clock::time_point start = Clock::now();
    const auto due = [&] { return static_cast<int>(ms(Clock::now() - start) * 1e-3 * rate_hz); };
    const auto busy = [&](auto&& work) {
        const Clock::time_point before = Clock::now();
        work();
        handler_ms.push_back(ms(Clock::now() - before));
    };
    while (made < keyframes || !queue.empty()) {
        for (; made < std::min(due(), keyframes); ++made) {
            const View& view = views[static_cast<std::size_t>(made) % views.size()];
            trajectory.keyframes.push_back({made, made + 1, view.world_from_camera});
            if (made % 100 == 99) {
                const int from = made % 500 == 499 ? 0 : made - 99;
                for (int id = from; id <= made; ++id)
                    trajectory.keyframes[static_cast<std::size_t>(id)].world_from_camera.translation().x() +=
                        0.01 * (id - from) / (made - from + 1.0);
                ++trajectory.revision;
            }
            trajectory.utime = made + 1;
            if (queue.size() >= 8) {
                ++overflow;
            } else {
                queue.push_back({made, trajectory});
            }
        }
        if (queue.empty()) {
            busy([&] { shell->poll(); });
            bus.drain();
            std::this_thread::sleep_for(std::chrono::milliseconds(2));
            continue;
        }
        const Pending next = std::move(queue.front());
        queue.pop_front();
        bot_core::images_t frame = views[static_cast<std::size_t>(next.id) % views.size()].frame;
        frame.utime = next.id + 1;
        Keyframe keyframe;
        keyframe.id = next.id;
        keyframe.utime = next.id + 1;
        bus.publish(messages::channels::kFrame, frame);
        busy([&] { bus.drain(); });
        bus.publish(messages::channels::kKeyframe, messages::to_message(keyframe, next.id));
        busy([&] { bus.drain(); });
        bus.publish(messages::channels::kTrajectory, messages::to_message(next.trajectory, next.id));
        busy([&] { bus.drain(); });
        busy([&] { shell->poll(); });
        bus.drain();
    }
    const double fed_s = 1e-3 * ms(Clock::now() - start);
    const Clock::time_point stop = Clock::now();
    const std::clock_t stop_cpu = std::clock();
    shell->finish();
    bus.drain();
    const double finished_ms = ms(Clock::now() - stop);
    const std::int64_t dropped = shell->status().dropped_count() + overflow;
    const std::string line = shell->status().line();
    shell.reset();
    const double stop_ms = ms(Clock::now() - stop);
    const double stop_cpu_ms = 1e3 * static_cast<double>(std::clock() - stop_cpu) / CLOCKS_PER_SEC;
    std::sort(handler_ms.begin(), handler_ms.end());
    std::printf("fed in %.1f s; longest handler %.1f ms, 99.9 %% of them below %.1f ms\n", fed_s,
                handler_ms.back(), handler_ms[handler_ms.size() * 999 / 1000]);
    std::printf("%lld keyframes dropped, %d states, the last one with %d keyframes, %lld nodes\n",
                static_cast<long long>(dropped), states, last.n_keyframes,
                static_cast<long long>(last.n_nodes));
    std::printf("finished in %.0f ms, gone in %.0f ms (CPU %.0f ms)\n%s\n", finished_ms, stop_ms, stop_cpu_ms,
                line.c_str());
    return 0;
}

}  // namespace
}  // namespace planemap::octomap

int main(int argc, char** argv) {
    if (argc > 1 && std::string(argv[1]) == "insertion")
        return planemap::octomap::insertion_benchmark({argv + 2, argv + argc});
    const int keyframes = argc > 1 ? std::atoi(argv[1]) : 3000;
    const double rate_hz = argc > 2 ? std::atof(argv[2]) : 30;
    return planemap::octomap::run(std::max(keyframes, 1), std::max(rate_hz, 0.1),
                                  argc <= 3 || std::atoi(argv[3]) != 0);
}
