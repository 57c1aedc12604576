// SPDX-License-Identifier: BSD-3-Clause
#include "bench_odometry/disturbances.hpp"

#include <algorithm>
#include <cmath>

namespace planemap::bench_odometry {

namespace {

/// Changes `count` frames from the first disturbed one on; change(shown, i) with i from 0.
template <typename Change>
Script changed(const Undisturbed& source, std::size_t count, const Change& change) {
    Script script = undisturbed(source.frames);
    const std::size_t end = std::min(source.frames, source.first + count);
    for (std::size_t i = source.first; i < end; ++i) change(script[i], i - source.first);
    return script;
}

std::size_t frames_of(const Undisturbed& source, double seconds) {
    return static_cast<std::size_t>(std::lround(seconds * source.rate_hz));
}

template <int kSeconds>
Script cover(const Undisturbed& source) {
    return changed(source, frames_of(source, kSeconds),
                   [](Shown& shown, std::size_t) { shown.covered = true; });
}

template <int kCount>
Script repeat_color(const Undisturbed& source) {
    return changed(source, kCount, [&](Shown& shown, std::size_t) { shown.color = source.first - 1; });
}

template <int kCount>
Script repeat_old_color(const Undisturbed& source) {
    return changed(source, kCount, [&](Shown& shown, std::size_t) {
        shown.color = source.first - 1;
        shown.keeps_color_stamp = true;
    });
}

Script repeat_depth(const Undisturbed& source) {
    return changed(source, 30, [&](Shown& shown, std::size_t) { shown.depth = source.first - 1; });
}

Script repeat_both(const Undisturbed& source) {
    return changed(source, 30,
                   [&](Shown& shown, std::size_t) { shown.color = shown.depth = source.first - 1; });
}

Script flicker(const Undisturbed& source) {
    return changed(source, 60,
                   [&](Shown& shown, std::size_t i) { shown.color = source.first - kFramesBefore + i % 2; });
}

/// Half a second down to 3 %, a second there, and half a second back.
Script darken(const Undisturbed& source) {
    constexpr double kDark = 0.03;
    const std::size_t ramp = frames_of(source, 0.5), dark = frames_of(source, 1);
    return changed(source, 2 * ramp + dark, [&](Shown& shown, std::size_t i) {
        const std::size_t from_end = 2 * ramp + dark - 1 - i;
        const double share =
            std::min(1.0, static_cast<double>(std::min(i, from_end) + 1) / static_cast<double>(ramp));
        shown.light = std::pow(kDark, share);
    });
}

Script smear(const Undisturbed& source) {
    return changed(source, 15, [](Shown& shown, std::size_t) { shown.smear = 1.0 / 32; });
}

std::int64_t time_of(std::size_t frames, double rate_hz) {
    return std::llround(1e6 * static_cast<double>(frames) / rate_hz);
}

/// The camera goes on; its clock begins again.
Script restart(const Undisturbed& source) {
    const std::int64_t back_us = time_of(source.first, source.rate_hz);
    return changed(source, source.frames, [&](Shown& shown, std::size_t) { shown.later_us = -back_us; });
}

/// The first half once more, to the same modules.
Script replay(const Undisturbed& source) {
    Script script = undisturbed(source.first);
    const Script again = script;
    script.insert(script.end(), again.begin(), again.end());
    return script;
}

Script leave(const Undisturbed& source) {
    return undisturbed(source.frames);
}

}  // namespace

Script undisturbed(std::size_t frames) {
    Script script(frames);
    for (std::size_t i = 0; i < frames; ++i) script[i].at = script[i].color = script[i].depth = i;
    return script;
}

const std::vector<Disturbance>& known_disturbances() {
    static const std::vector<Disturbance> kDisturbances{
        {"none", "nothing", leave},
        {"covered-1s", "colour black and no depth for 1 s while the camera moves on", cover<1>},
        {"covered-3s", "the same for 3 s", cover<3>},
        {"color-3", "one colour image for 3 frames, with new stamps", repeat_color<3>},
        {"color-10", "the same for 10", repeat_color<10>},
        {"color-30", "the same for 30", repeat_color<30>},
        {"color-old-3", "one colour image for 3 frames, with the stamp that it has", repeat_old_color<3>},
        {"color-old-10", "the same for 10", repeat_old_color<10>},
        {"color-old-30", "the same for 30", repeat_old_color<30>},
        {"depth-30", "one depth image for 30 frames, with new stamps", repeat_depth},
        {"both-30", "one colour and one depth image for 30 frames, with new stamps", repeat_both},
        {"flicker", "the two newest colour images in turn for 60 frames", flicker},
        {"dark", "light goes to 3 % in 0.5 s, stays for 1 s, and comes back in 0.5 s", darken},
        {"blur", "colour smeared sideways over 1/32 of its width for 15 frames", smear},
        {"restart", "the camera goes on, its stamps begin again", restart},
        {"replay", "the frames before once more, with their stamps", replay},
    };
    return kDisturbances;
}

Script returns(std::size_t walk, std::size_t rest, int cuts, std::size_t frames, std::int64_t pause_us,
               double rate_hz) {
    Script script = undisturbed(walk);
    for (int cut = 0; cut < cuts; ++cut) {
        const std::size_t share = (rest - frames) * static_cast<std::size_t>(cut);
        const std::size_t begin = walk + (cuts > 1 ? share / static_cast<std::size_t>(cuts - 1) : 0);
        // Stamps go on after the pause, whatever the source has left out.
        const std::size_t shown_before = script.size();
        const std::int64_t later_us =
            (cut + 1) * pause_us + time_of(shown_before, rate_hz) - time_of(begin, rate_hz);
        for (std::size_t i = begin; i < begin + frames; ++i) {
            Shown shown;
            shown.at = shown.color = shown.depth = i;
            shown.later_us = later_us;
            script.push_back(shown);
        }
    }
    return script;
}

}  // namespace planemap::bench_odometry
