// SPDX-License-Identifier: BSD-3-Clause
// What is in an LCM log: channels, types, rates, gaps.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

namespace planemap {

/// The messages of one type on one channel. Times are those of logging.
struct ChannelSummary {
    std::string channel, type;  ///< as they may be printed; a type that is not ours as its fingerprint
    std::int64_t events = 0;
    std::uint64_t bytes = 0;  ///< of the messages
    double rate_hz = 0;       ///< from the first to the last; 0 for one event
    std::int64_t gaps = 0;    ///< steps of more than three times the median step
    double longest_step_s = 0;
    std::int64_t steps_back = 0;  ///< events logged before the one before them
};

struct LogSummary {
    std::filesystem::path file;
    std::uint64_t bytes = 0;
    std::int64_t events = 0;
    std::int64_t first_utime = 0, last_utime = 0;  ///< earliest and latest, microseconds
    std::vector<ChannelSummary> channels;          ///< by name
    std::int64_t other_events = 0;                 ///< of channels beyond kMaxChannels
    std::vector<std::string> complaints;           ///< what is damaged, a line each

    static constexpr std::size_t kMaxChannels = 1000;
};

/// Reads a whole log. Calls `progress` with the share that is read, 0 to 1; where it gives false, throws
/// std::runtime_error. Throws std::runtime_error naming file and reason if it cannot be read or holds no
/// event.
LogSummary summarise(const std::filesystem::path& file, const std::function<bool(double)>& progress);

/// For people: a heading, and a line a channel.
std::string text_of(const LogSummary& summary);
nlohmann::ordered_json json_of(const LogSummary& summary);

}  // namespace planemap
