// SPDX-License-Identifier: BSD-3-Clause
#include "bench_map/sequences.hpp"

#include <algorithm>
#include <charconv>
#include <sstream>
#include <stdexcept>

#include "simulator/simulated_source.hpp"

namespace planemap::bench_map {

namespace {

constexpr std::int64_t kEvery = 5;  // frames
// At walking speed, more than two rounds.
constexpr const char* kBuilding = "sim:building?speed=0.8&turn=60&frames=10000";

bool is_digit(char c) {
    return c >= '0' && c <= '9';
}

/// "a1..3b" as a1b, a2b, a3b; a word without a range as it is.
std::vector<std::string> expanded(const std::string& word) {
    const auto dots = word.find("..");
    if (dots == std::string::npos || dots == 0 || dots + 2 >= word.size() || !is_digit(word[dots - 1]) ||
        !is_digit(word[dots + 2]))
        return {word};
    std::size_t begin = dots, end = dots + 2;
    while (begin > 0 && is_digit(word[begin - 1])) --begin;
    while (end < word.size() && is_digit(word[end])) ++end;
    int from = 0, to = 0;
    std::from_chars(word.data() + begin, word.data() + dots, from);
    std::from_chars(word.data() + dots + 2, word.data() + end, to);
    if (to < from || to - from > 1000)
        throw std::invalid_argument("sequences: \"" + word + "\" is no range of 1 to 1000");
    std::vector<std::string> words;
    for (int i = from; i <= to; ++i)
        words.push_back(word.substr(0, begin) + std::to_string(i) + word.substr(end));
    return words;
}

}  // namespace

const char* const kDefaultSequences = "sim:office?seed=1..5,redkitchen";

std::vector<std::string> parse_sequences(const std::string& list) {
    std::vector<std::string> sequences;
    std::istringstream words(list);
    for (std::string word; std::getline(words, word, ',');)
        for (std::string& name : expanded(word)) sequences.push_back(std::move(name));
    if (sequences.empty()) throw std::invalid_argument("sequences: none given");
    return sequences;
}

std::optional<std::string> input_of(const std::string& sequence, const std::filesystem::path& data,
                                    std::string& missing) {
    if (sequence == "sim:building") return kBuilding;
    if (sequence.starts_with("sim:")) {
        simulator::parse_simulator_name(sequence);  // an error now, not in an hour
        return sequence;
    }
    for (const std::filesystem::path& path : {data / sequence, std::filesystem::path(sequence)})
        if (std::filesystem::exists(path)) return path.string();
    missing = (data / sequence).string() + ": no such folder (set PLANEMAP_DATA, or give --data)";
    return std::nullopt;
}

std::optional<std::vector<TruePlane>> true_planes(const std::string& input, std::int64_t frames) {
    if (!input.starts_with("sim:")) return std::nullopt;
    const simulator::SimulatedSource source(simulator::parse_simulator_name(input));
    Sight sight;
    sight.min_m = source.camera().depth_min_m;
    sight.max_m = source.camera().depth_max_m;
    sight.max_angle_deg = simulator::DepthSensorOptions().grazing_from_deg;
    const auto all = static_cast<std::int64_t>(*source.size());
    const std::int64_t count = frames > 0 ? std::min(frames, all) : all;
    TruthCollector truth(source.world());
    for (std::int64_t i = 0; i < count; i += kEvery)
        truth.add(source.depth_view(static_cast<std::size_t>(i)), sight);
    return truth.planes();
}

}  // namespace planemap::bench_map
