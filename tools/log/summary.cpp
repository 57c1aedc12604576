// SPDX-License-Identifier: BSD-3-Clause
#include "log/summary.hpp"

#include <algorithm>
#include <cstdio>
#include <map>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <utility>

#include "core/stamp.hpp"
#include "core/time_step.hpp"
#include "messages/decode.hpp"
#include "messages/log.hpp"
#include "messages/log_contents.hpp"

namespace planemap {

namespace {

/// Stamps of a log may be anything: differences are taken where they cannot overflow.
std::int64_t step_between(std::int64_t from, std::int64_t to) {
    const double step = static_cast<double>(to) - static_cast<double>(from);
    return static_cast<std::int64_t>(
        std::clamp(step, -static_cast<double>(kFarthestUtime), static_cast<double>(kFarthestUtime)));
}

struct Channel {
    std::int64_t events = 0, first = 0, last = 0, back = 0;
    std::uint64_t bytes = 0;
    std::vector<std::int64_t> steps;  ///< microseconds

    void add(const messages::LogEvent& event) {
        if (events++ == 0) {
            first = event.utime;
        } else {
            const std::int64_t step = step_between(last, event.utime);
            if (step < 0) ++back;
            if (step >= 0) steps.push_back(step);
        }
        last = event.utime;
        bytes += event.bytes.size();
    }

    ChannelSummary summary() {
        ChannelSummary out;
        out.events = events;
        out.bytes = bytes;
        out.steps_back = back;
        const double seconds = static_cast<double>(step_between(first, last)) * 1e-6;
        if (seconds > 0) out.rate_hz = static_cast<double>(events - 1) / seconds;
        if (steps.empty()) return out;
        const std::int64_t median = median_step(steps), limit = 3 * median;
        out.gaps =
            median == 0 ? 0 : std::count_if(steps.begin(), steps.end(), [&](auto s) { return s > limit; });
        out.longest_step_s = static_cast<double>(*std::max_element(steps.begin(), steps.end())) * 1e-6;
        return out;
    }
};

std::string size_text(std::uint64_t bytes) {
    char text[40];
    const double size = static_cast<double>(bytes);
    std::snprintf(text, sizeof(text), "%.*f %s", bytes < 1000 ? 0 : 1,
                  bytes < 1000      ? size
                  : bytes < 1000000 ? size / 1e3
                                    : size / 1e6,
                  bytes < 1000      ? "B"
                  : bytes < 1000000 ? "kB"
                                    : "MB");
    return text;
}

/// A moment, UTC; nothing for stamps that are none of this age.
std::string moment_text(std::int64_t utime) {
    const std::time_t moment = static_cast<std::time_t>(utime / 1000000);
    constexpr std::time_t kYear2000 = 946684800, kYear2200 = 7258118400;
    return moment < kYear2000 || moment > kYear2200 ? "" : " from " + date_text(moment) + " UTC";
}

}  // namespace

LogSummary summarise(const std::filesystem::path& file, const std::function<bool(double)>& progress) {
    messages::LogReader log(file);
    std::map<std::pair<std::string, std::uint64_t>, Channel> channels;
    LogSummary summary;
    summary.file = file;
    summary.bytes = log.bytes_total();
    for (messages::LogEvent event; log.next(event);) {
        if (summary.events++ == 0) summary.first_utime = summary.last_utime = event.utime;
        summary.first_utime = std::min(summary.first_utime, event.utime);
        summary.last_utime = std::max(summary.last_utime, event.utime);
        const std::pair key(event.channel, messages::fingerprint_of(event.bytes));
        if (channels.size() >= LogSummary::kMaxChannels && channels.count(key) == 0) {
            ++summary.other_events;
        } else {
            channels[key].add(event);
        }
        if (!progress(static_cast<double>(log.bytes_read()) / static_cast<double>(summary.bytes)))
            throw std::runtime_error(file.string() + ": stopped before its end");
    }
    if (summary.events == 0)
        throw std::runtime_error(file.string() + ": is no LCM log: there is not one whole event in it");
    for (auto& [key, channel] : channels) {
        ChannelSummary& row = summary.channels.emplace_back(channel.summary());
        row.channel = messages::printable(key.first);
        row.type = messages::type_name(key.second);
    }
    summary.complaints = log.complaints();
    return summary;
}

std::string text_of(const LogSummary& summary) {
    std::size_t width = 7, type_width = 4;
    for (const ChannelSummary& row : summary.channels) {
        width = std::max(width, row.channel.size());
        type_width = std::max(type_width, row.type.size());
    }
    const auto pad = [](std::string text, std::size_t to) {
        text.resize(std::max(to, text.size()), ' ');
        return text;
    };
    char line[160];
    std::snprintf(
        line, sizeof(line), ", %lld events, %.3f s", static_cast<long long>(summary.events),
        (static_cast<double>(summary.last_utime) - static_cast<double>(summary.first_utime)) * 1e-6);
    std::string text = summary.file.string() + ": " + size_text(summary.bytes) + line +
                       moment_text(summary.first_utime) + "\n";
    text += "  " + pad("channel", width) + "  " + pad("type", type_width) +
            "   events  rate, Hz   gaps  longest step, s        size\n";
    for (const ChannelSummary& row : summary.channels) {
        std::snprintf(line, sizeof(line), " %8lld  %8.2f  %5lld  %15.3f  %10s",
                      static_cast<long long>(row.events), row.rate_hz, static_cast<long long>(row.gaps),
                      row.longest_step_s, size_text(row.bytes).c_str());
        text += "  " + pad(row.channel, width) + "  " + pad(row.type, type_width) + line;
        if (row.steps_back > 0) text += "  " + std::to_string(row.steps_back) + " stamps go back";
        text += "\n";
    }
    if (summary.other_events > 0)
        text += "  and " + std::to_string(summary.other_events) + " events of other channels or types\n";
    return text;
}

nlohmann::ordered_json json_of(const LogSummary& summary) {
    nlohmann::ordered_json json = {{"file", summary.file.string()},
                                   {"bytes", summary.bytes},
                                   {"events", summary.events},
                                   {"first_utime", summary.first_utime},
                                   {"last_utime", summary.last_utime},
                                   {"channels", nlohmann::ordered_json::array()},
                                   {"other_events", summary.other_events},
                                   {"damage", summary.complaints}};
    for (const ChannelSummary& row : summary.channels) {
        json["channels"].push_back({{"channel", row.channel},
                                    {"type", row.type},
                                    {"events", row.events},
                                    {"bytes", row.bytes},
                                    {"rate_hz", row.rate_hz},
                                    {"gaps", row.gaps},
                                    {"longest_step_s", row.longest_step_s},
                                    {"steps_back", row.steps_back}});
    }
    return json;
}

}  // namespace planemap
