// SPDX-License-Identifier: BSD-3-Clause
#include "messages/complaints.hpp"

#include <spdlog/spdlog.h>

#include <cctype>

namespace planemap::messages {

namespace {

/// The line with each run of digits as one '#'.
std::string kind_of(const std::string& line) {
    std::string kind;
    for (const char c : line) {
        const bool digit = std::isdigit(static_cast<unsigned char>(c)) != 0;
        if (!digit) kind += c;
        if (digit && (kind.empty() || kind.back() != '#')) kind += '#';
    }
    return kind;
}

}  // namespace

void Complaints::add(const std::string& line) {
    add(line, line);
}

void Complaints::add(const std::string& line, const std::string& kind_line) {
    ++count_;
    std::string name = kind_of(kind_line);
    if (kinds_.size() >= kMaxKinds && kinds_.count(name) == 0) name.clear();
    Kind& kind = kinds_[name];
    if (++kind.count == 1) {
        kind.first = name.empty() ? "other than these: " + line : line;
        spdlog::warn("{}", kind.first);
    } else if (kind.count == kind.next_said) {
        kind.next_said *= 10;
        spdlog::warn("{} ({} times so far)", line, kind.count);
    }
}

std::string Complaints::total(const Kind& kind) {
    return kind.count == 1 ? kind.first : kind.first + " (" + std::to_string(kind.count) + " times)";
}

std::vector<std::string> Complaints::totals() const {
    std::vector<std::string> lines;
    lines.reserve(kinds_.size());
    for (const auto& [name, kind] : kinds_) lines.push_back(total(kind));
    return lines;
}

void Complaints::log_totals() const {
    for (const auto& [name, kind] : kinds_) {
        if (kind.count > 1) spdlog::warn("in all: {}", total(kind));
    }
}

}  // namespace planemap::messages
