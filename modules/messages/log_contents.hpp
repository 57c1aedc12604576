// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <utility>

#include "messages/log.hpp"

namespace planemap::messages {

/// "bot_core.images_t" and the like; the fingerprint in hexadecimal digits for a type that is not ours.
std::string type_name(std::uint64_t fingerprint);
/// A channel's name as it may be printed.
std::string printable(std::string channel);

/// Which channels a log has, and what is on them: for the error that nothing of it can be used.
class LogContents {
  public:
    static constexpr std::size_t kMaxRows = 32;  ///< pairs of channel and type; the rest is counted

    void add(const LogEvent& event);
    std::int64_t count() const { return count_; }  ///< messages of all channels
    /// "OPENNI_FRAME bot_core.images_t (40), POSE 0x0123456789abcdef (3)"; types that are not known as their
    /// fingerprint. "nothing" for an empty log.
    std::string text() const;

  private:
    std::map<std::pair<std::string, std::uint64_t>, std::int64_t> messages_;
    std::int64_t count_ = 0, others_ = 0;
};

}  // namespace planemap::messages
