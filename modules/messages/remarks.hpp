// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace planemap::messages {

/// What is true of all that a module says from now on, one remark a kind.
class Remarks {
  public:
    /// A later remark of a kind (a word, not shown) takes the place of the earlier one; an empty one takes it
    /// back. Returns whether it is to be warned of: the first time that there is one of this kind, and the
    /// 10th, 100th and so on.
    bool set(const std::string& kind, const std::string& text);
    /// Those that were not taken back, in the order of their kinds.
    std::vector<std::string> texts() const;

  private:
    struct Remark {
        std::string text;
        std::int64_t times = 0;
    };
    std::map<std::string, Remark> by_kind_;
};

}  // namespace planemap::messages
