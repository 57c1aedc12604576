// SPDX-License-Identifier: BSD-3-Clause
#include "core/components.hpp"

#include <algorithm>
#include <filesystem>
#include <map>
#include <utility>

namespace planemap {

std::vector<int> components(const KeyframeTrajectory& trajectory) {
    std::map<int, int> keyframes;
    for (const KeyframePose& keyframe : trajectory.keyframes) ++keyframes[keyframe.component];
    std::vector<int> order;
    order.reserve(keyframes.size());
    for (const auto& [component, count] : keyframes) order.push_back(component);
    std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return keyframes[a] > keyframes[b]; });
    return order;
}

int largest_component(const KeyframeTrajectory& trajectory) {
    const std::vector<int> all = components(trajectory);
    return all.empty() ? 0 : all.front();
}

KeyframeTrajectory of_component(const KeyframeTrajectory& trajectory, int component) {
    KeyframeTrajectory part = trajectory;
    std::erase_if(part.keyframes,
                  [&](const KeyframePose& keyframe) { return keyframe.component != component; });
    if (!part.keyframes.empty()) part.utime = part.keyframes.back().utime;
    return part;
}

std::string component_file(const std::string& name, std::size_t number) {
    if (number <= 1) return name;
    const std::filesystem::path file(name);
    return file.stem().string() + "_" + std::to_string(number) + file.extension().string();
}

}  // namespace planemap
