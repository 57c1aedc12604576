// SPDX-License-Identifier: BSD-3-Clause
#include "benchmark/sequences.hpp"

#include <algorithm>
#include <charconv>
#include <cstdlib>
#include <cstring>

#include "benchmark/choices.hpp"
#include "simulator/simulated_source.hpp"

namespace planemap::benchmark {

namespace {

constexpr const char* kSimulator = "sim:";

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

SequenceInfo sequence_of(const std::string& name, const std::vector<SequenceInfo>& known, Unknown unknown) {
    const bool is_known = std::any_of(known.begin(), known.end(),
                                      [&](const SequenceInfo& sequence) { return sequence.name == name; });
    if (!is_known && name.starts_with(kSimulator)) {
        simulator::parse_simulator_name(name);  // an error now, not in an hour
        return {name, "simulated", name.substr(std::strlen(kSimulator)), "", 0};
    }
    if (!is_known && unknown == Unknown::kIsPath) return {name, "", "", "", 0};
    return named("sequences", name, known);
}

/// Throws DataMissing where a file or folder of the data is not there.
std::string found_in(const std::filesystem::path& data, const std::string& name) {
    for (const std::filesystem::path& path : {data / name, std::filesystem::path(name)})
        if (std::filesystem::exists(path)) return path.string();
    throw DataMissing((data / name).string() +
                      ": no such file or folder (set PLANEMAP_DATA, or give --data)");
}

}  // namespace

std::filesystem::path default_data_folder() {
    if (const char* root = std::getenv("PLANEMAP_DATA")) return root;
    return std::filesystem::path(PLANEMAP_SOURCE) / ".." / "shared" / "data";
}

std::vector<SequenceInfo> with_recordings(const std::vector<SequenceInfo>& own) {
    std::vector<SequenceInfo> all{
        {"redkitchen", "Kinect, hand-held, a kitchen with revisits; the truth errs by centimetres", "", "",
         100},
        {"fr1_rpy_start", "Kinect, fast rotations with blur over a desk", "", "", 50},
        {"fr3_cabinet", "Xtion, around a cabinet, 58 frames 0.67 s apart", "", "", 58},
        {"livingroom_micro", "synthetic living room without noise; no truth", "", "", 50},
    };
    all.insert(all.end(), own.begin(), own.end());
    return all;
}

std::vector<SequenceInfo> parse_sequences(const std::string& list, const std::vector<SequenceInfo>& known,
                                          Unknown unknown) {
    std::vector<SequenceInfo> sequences;
    for_each_word("sequences", list, [&](const std::string& word) {
        for (const std::string& name : expanded(word)) sequences.push_back(sequence_of(name, known, unknown));
    });
    return sequences;
}

std::string input_of(const SequenceInfo& sequence, const std::filesystem::path& data) {
    if (sequence.simulator.empty()) return found_in(data, sequence.name);
    const std::string name = kSimulator + sequence.simulator;
    if (sequence.poses.empty()) return name;
    return name + (name.find('?') == std::string::npos ? "?" : "&") +
           "trajectory=" + found_in(data, sequence.poses);
}

std::string file_name_of(const std::string& sequence) {
    std::string name = sequence;
    std::replace_if(
        name.begin(), name.end(), [](char c) { return std::string(":/?&=").find(c) != std::string::npos; },
        '-');
    return name;
}

}  // namespace planemap::benchmark
