// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace planemap::messages {

/// What goes wrong again and again. The first of a kind is logged at once, as a warning, then the 10th,
/// 100th, 1000th and so on with their count; how many there were is told at the end. Lines that differ in
/// their digits only are of one kind.
class Complaints {
  public:
    static constexpr std::size_t kMaxKinds = 64;  ///< the rest, of whatever kind, is one more

    void add(const std::string& line);
    /// The same for a line whose kind its sender knows, e.g. the reason without the file's name.
    void add(const std::string& line, const std::string& kind);

    /// Of all kinds, since the start.
    std::int64_t count() const { return count_; }
    /// A line a kind, in the order of the alphabet: the first that was said, and how many there were.
    std::vector<std::string> totals() const;
    /// Logs the totals of those kinds of which more came than were said.
    void log_totals() const;

  private:
    struct Kind {
        std::string first;
        std::int64_t count = 0, next_said = 10;
    };
    static std::string total(const Kind& kind);

    std::map<std::string, Kind> kinds_;
    std::int64_t count_ = 0;
};

}  // namespace planemap::messages
