// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <optional>

namespace planemap::messages {

/// Counts what is missing in a stream of consecutive numbers. A late arrival takes its gap back, one that
/// comes twice changes nothing. A number far from the last is believed once the next one bears it out: ahead,
/// all in between is missing; behind, the sender started again and nothing is.
class SeqCounter {
  public:
    void add(std::uint32_t seq);

    std::int64_t missed() const { return missed_; }
    std::int64_t restarts() const { return restarts_; }

  private:
    void start(std::uint32_t seq);

    std::optional<std::uint32_t> last_, jump_;
    std::uint64_t seen_ = 0;  ///< bit i: last_ - i has come
    std::int64_t missed_ = 0, restarts_ = 0;
};

}  // namespace planemap::messages
