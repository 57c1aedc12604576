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
#include "messages/process.hpp"
#include "messages/told_status.hpp"
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

/// The graph's trajectory of keyframes that come one after the other.
class GrowingTrajectory {
  public:
    int size() const { return static_cast<int>(trajectory_.keyframes.size()); }

    /// Adds a keyframe; each hundredth closes a loop, which moves the hundred before it, each five hundredth
    /// one that moves all.
    Pending add(const Pose& world_from_camera) {
        const int made = size();
        trajectory_.keyframes.push_back({made, made + 1, world_from_camera});
        if (made % 100 == 99) {
            const int from = made % 500 == 499 ? 0 : made - 99;
            for (int id = from; id <= made; ++id)
                trajectory_.keyframes[static_cast<std::size_t>(id)].world_from_camera.translation().x() +=
                    0.01 * (id - from) / (made - from + 1.0);
            ++trajectory_.revision;
        }
        trajectory_.utime = made + 1;
        return {made, trajectory_};
    }

  private:
    KeyframeTrajectory trajectory_;
};

/// How long the shell kept whoever feeds it waiting.
class HandlerTimes {
  public:
    template <typename Work>
    void add(const Work& work) {
        const Clock::time_point before = Clock::now();
        work();
        times_ms_.push_back(ms(Clock::now() - before));
    }
    /// Precondition: there are some.
    void print(double fed_s) {
        std::sort(times_ms_.begin(), times_ms_.end());
        std::printf("fed in %.1f s; longest handler %.1f ms, 99.9 %% of them below %.1f ms\n", fed_s,
                    times_ms_.back(), times_ms_[times_ms_.size() * 999 / 1000]);
    }

  private:
    std::vector<double> times_ms_;
};

/// A frame, its keyframe and the trajectory with it, as the shell hears them.
void publish(messages::Bus& bus, const Pending& next, const View& view, HandlerTimes& times) {
    bot_core::images_t frame = view.frame;
    frame.utime = next.id + 1;
    Keyframe keyframe;
    keyframe.id = next.id;
    keyframe.utime = next.id + 1;
    bus.publish(messages::channels::kFrame, frame);
    times.add([&] { bus.drain(); });
    bus.publish(messages::channels::kKeyframe, messages::to_message(keyframe, next.id));
    times.add([&] { bus.drain(); });
    bus.publish(messages::channels::kTrajectory, messages::to_message(next.trajectory, next.id));
    times.add([&] { bus.drain(); });
}

/// Feeds keyframes at their rate; of those that come while the shell is busy, eight wait. Returns how many
/// were dropped.
int feed(messages::Bus& bus, OctomapShell& shell, const std::vector<View>& views, int keyframes,
         double rate_hz, HandlerTimes& times) {
    const auto view_of = [&](int id) -> const View& {
        return views[static_cast<std::size_t>(id) % views.size()];
    };
    GrowingTrajectory trajectory;
    std::deque<Pending> queue;
    int overflow = 0;
    const Clock::time_point start = Clock::now();
    const auto due = [&] { return static_cast<int>(ms(Clock::now() - start) * 1e-3 * rate_hz); };
    while (trajectory.size() < keyframes || !queue.empty()) {
        while (trajectory.size() < std::min(due(), keyframes)) {
            Pending made = trajectory.add(view_of(trajectory.size()).world_from_camera);
            if (queue.size() >= 8) {
                ++overflow;
            } else {
                queue.push_back(std::move(made));
            }
        }
        if (queue.empty()) {
            times.add([&] { shell.poll(); });
            bus.drain();
            std::this_thread::sleep_for(std::chrono::milliseconds(2));
            continue;
        }
        const Pending next = std::move(queue.front());
        queue.pop_front();
        publish(bus, next, view_of(next.id), times);
        times.add([&] { shell.poll(); });
        bus.drain();
    }
    return overflow;
}

int run(int keyframes, double rate_hz, bool background) {
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

    HandlerTimes times;
    const std::vector<View> views = make_views();
    const Clock::time_point start = Clock::now();
    const int overflow = feed(bus, *shell, views, keyframes, rate_hz, times);
    const double fed_s = 1e-3 * ms(Clock::now() - start);
    const Clock::time_point stop = Clock::now();
    const std::clock_t stop_cpu = std::clock();
    shell->finish();
    bus.drain();
    const double finished_ms = ms(Clock::now() - stop);
    const std::string line = shell->status().line();
    const std::int64_t dropped = test::told(shell->status()).dropped + overflow;
    shell.reset();
    const double stop_ms = ms(Clock::now() - stop);
    const double stop_cpu_ms = 1e3 * static_cast<double>(std::clock() - stop_cpu) / CLOCKS_PER_SEC;
    times.print(fed_s);
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
    using namespace planemap::octomap;
    return planemap::messages::run_main("octomap_benchmark", [&] {
        const std::vector<std::string> arguments(argv + 1, argv + argc);
        if (!arguments.empty() && arguments[0] == "insertion")
            return insertion_benchmark({argv + 2, argv + argc});
        const auto number = [&](std::size_t i, double otherwise) {
            return i < arguments.size() ? std::atof(arguments[i].c_str()) : otherwise;
        };
        return run(std::max(static_cast<int>(number(0, 3000)), 1), std::max(number(1, 30), 0.1),
                   number(2, 1) != 0);
    });
}
