// SPDX-License-Identifier: BSD-3-Clause
#include "messages/log.hpp"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <stdexcept>

namespace planemap::messages {

namespace {

template <typename T>
void append(std::string& out, T value) {
    for (std::size_t i = sizeof(T); i-- > 0;) out += static_cast<char>(value >> (8 * i) & 0xff);
}

[[noreturn]] void fail_at(const std::filesystem::path& file, const char* doing, int error) {
    throw std::runtime_error(file.string() + ": cannot " + doing + ": " + std::strerror(error));
}

std::FILE* opened(const std::filesystem::path& file) {
    std::FILE* handle = std::fopen(file.c_str(), "wb");
    if (handle == nullptr) fail_at(file, "open", errno);
    return handle;
}

}  // namespace

LogReader::LogReader(const std::filesystem::path& file) : records_(file) {}

bool LogReader::next(LogEvent& event) {
    while (at_ < bytes_total()) {
        auto record = records_.at(at_);
        if (record && record->synced ? counts(*record) : record && !gap_ && records_.followed(*record)) {
            if (gap_) add_gap(*gap_, at_, &*record);
            if (!record->synced) add_gap(at_, at_ + sizeof(LogRecords::kSync), &*record);
            deliver(*record, event);
            return true;
        }
        if (!gap_) gap_ = at_;
        record = resume(at_ + 1);
        truncated_ = !record && records_.cut_short(at_);
        at_ = record ? record->at : bytes_total();
    }
    if (gap_) add_last_gap(*gap_);
    return false;
}

/// What follows the last record: room that was reserved holds zeros, and lost events do not end in many.
void LogReader::add_last_gap(std::uint64_t begin) {
    constexpr std::uint64_t kLeastZeros = 4096;
    const std::uint64_t end = bytes_total();
    std::uint64_t zeros_at = truncated_ ? end : records_.file().zeros_from(begin);
    if (zeros_at > begin && end - zeros_at < kLeastZeros) zeros_at = end;
    zeros_ = end - zeros_at;
    skipped_ += zeros_;
    if (zeros_at > begin) add_gap(begin, zeros_at, nullptr);
    gap_.reset();
}

/// True if a record that begins with the sync word is whole, as far as can be told by what follows it.
bool LogReader::counts(const LogRecord& record) {
    if (records_.followed(record)) return !records_.swallows(record);
    if (records_.holds_log(record)) return true;
    const auto next = resume(at_ + 1);
    const std::uint64_t next_at = next ? next->at : bytes_total();
    return next_at >= record.end && records_.before_stray_bytes(record, next_at);
}

/// The next record that counts, searched for once.
std::optional<LogRecord> LogReader::resume(std::uint64_t from) {
    const bool searched = ahead_from_ > 0 && from >= ahead_from_ && (nothing_ahead_ || from <= ahead_->at);
    if (!searched) {
        const std::uint64_t gap = gap_.value_or(at_);
        ahead_ = records_.resume(gap, from, before_ ? std::optional(before_->number) : std::nullopt);
        ahead_from_ = from;
        nothing_ahead_ = !ahead_;
    }
    return ahead_;
}

void LogReader::deliver(const LogRecord& record, LogEvent& event) {
    event.number = record.number;
    event.utime = record.utime;
    event.channel.resize(record.channel_length);
    event.bytes.resize(record.data_length);
    const std::uint64_t channel = record.at + LogRecords::kHeader;
    records_.file().read(channel,
                         {reinterpret_cast<std::uint8_t*>(event.channel.data()), event.channel.size()});
    records_.file().read(channel + record.channel_length, event.bytes);
    if (expected_ && record.number == following(*expected_)) ++misnumbered_;
    expected_.reset();
    if (before_ && before_->end == record.at && record.number != following(before_->number))
        expected_ = following(before_->number);
    if (!first_utime_) first_utime_ = record.utime;
    ++events_;
    before_ = record;
    at_ = record.end;
    gap_.reset();
}

/// About how many events are lost in so many bytes.
std::int64_t LogReader::lost_between(std::uint64_t bytes, const LogRecord* next) const {
    if (next != nullptr) {
        const std::int64_t first = before_ ? following(before_->number) : 0;
        const std::uint64_t missing =
            static_cast<std::uint64_t>(next->number) - static_cast<std::uint64_t>(first);
        if (next->number >= first && missing <= bytes / LogRecords::kSmallest + 1)
            return static_cast<std::int64_t>(missing);
    }
    if (events_ == 0) return 1;
    const std::uint64_t good = at_ - skipped_ - bytes,
                        mean = std::max<std::uint64_t>(1, good / static_cast<std::uint64_t>(events_));
    return std::max<std::int64_t>(1, static_cast<std::int64_t>((bytes + mean / 2) / mean));
}

void LogReader::add_gap(std::uint64_t begin, std::uint64_t end, const LogRecord* next) {
    LogGap gap;
    gap.at = begin;
    gap.bytes = end - begin;
    if (next == nullptr || next->at == end) gap.events = lost_between(gap.bytes, next);
    if (before_) gap.utime_before = before_->utime;
    if (next != nullptr) gap.utime_after = next->utime;
    skipped_ += gap.bytes;
    events_lost_ += gap.events;
    ++gap_count_;
    if (gaps_.size() < kMaxGaps) gaps_.push_back(gap);
    gap_.reset();
}

namespace {

std::string time_since(std::int64_t utime, std::int64_t first) {
    char text[40];
    std::snprintf(text, sizeof(text), "%.3f s",
                  (static_cast<double>(utime) - static_cast<double>(first)) * 1e-6);
    return text;
}

std::string count_text(std::int64_t count, const std::string& what) {
    return std::to_string(count) + " " + what + (count == 1 ? "" : "s");
}

std::string size_text(std::uint64_t bytes) {
    char text[40];
    std::snprintf(text, sizeof(text), "%.1f MB", static_cast<double>(bytes) * 1e-6);
    return bytes < 100000 ? std::to_string(bytes) + " bytes" : text;
}

std::string gap_text(const LogGap& gap, std::int64_t first_utime) {
    std::string text = "bytes " + std::to_string(gap.at) + " to " + std::to_string(gap.at + gap.bytes) +
                       ", about " + count_text(gap.events, "event") + " lost";
    if (gap.utime_before) text += ", after " + time_since(*gap.utime_before, first_utime);
    if (gap.utime_after) text += ", before " + time_since(*gap.utime_after, first_utime);
    return text;
}

}  // namespace

std::vector<std::string> LogReader::complaints() const {
    const std::string name = records_.file().path().string();
    std::vector<std::string> lines;
    if (truncated_) lines.push_back(name + " is cut short: its last event is not whole");
    if (zeros_ > 0)
        lines.push_back(name + ": " + size_text(zeros_) + " of zeros at the end: the log was not closed");
    if (gap_count_ > 0) {
        lines.push_back(name + ": " + std::to_string(skipped_ - zeros_) + " bytes in " +
                        count_text(gap_count_, "place") + " are no whole LCM events, about " +
                        count_text(events_lost_, "event") + " lost (times from the log's first event)");
    }
    for (const LogGap& gap : gaps_) lines.push_back(name + ": " + gap_text(gap, first_utime_.value_or(0)));
    if (gap_count_ > static_cast<std::int64_t>(gaps_.size()))
        lines.push_back(name + ": and " +
                        std::to_string(gap_count_ - static_cast<std::int64_t>(gaps_.size())) +
                        " places more");
    if (misnumbered_ > 0) {
        lines.push_back(name + ": " + count_text(misnumbered_, "event") +
                        " with a damaged number in the header, used all the same");
    }
    return lines;
}

std::string encode_event(const LogEvent& event) {
    std::string out;
    out.reserve(LogRecords::kHeader + event.channel.size() + event.bytes.size());
    append(out, LogRecords::kSync);
    append(out, static_cast<std::uint64_t>(event.number));
    append(out, static_cast<std::uint64_t>(event.utime));
    append(out, static_cast<std::uint32_t>(event.channel.size()));
    append(out, static_cast<std::uint32_t>(event.bytes.size()));
    out += event.channel;
    out.append(event.bytes.begin(), event.bytes.end());
    return out;
}

LogWriter::LogWriter(const std::filesystem::path& file) : path_(file), file_(opened(file)) {}

void LogWriter::write(const LogEvent& event) {
    const std::string bytes = encode_event(event);
    if (std::fwrite(bytes.data(), 1, bytes.size(), file_.get()) != bytes.size())
        fail_at(path_, "write", errno);
}

void LogWriter::close() {
    std::FILE* file = file_.release();
    if (file != nullptr && std::fclose(file) != 0) fail_at(path_, "write", errno);
}

}  // namespace planemap::messages
