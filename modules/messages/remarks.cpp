// SPDX-License-Identifier: BSD-3-Clause
#include "messages/remarks.hpp"

namespace planemap::messages {

bool Remarks::set(const std::string& kind, const std::string& text) {
    Remark& remark = by_kind_[kind];
    remark.text = text;
    if (text.empty()) return false;
    ++remark.times;
    std::int64_t power = 1;
    while (power < remark.times) power *= 10;
    return power == remark.times;
}

std::vector<std::string> Remarks::texts() const {
    std::vector<std::string> out;
    for (const auto& [kind, remark] : by_kind_)
        if (!remark.text.empty()) out.push_back(remark.text);
    return out;
}

}  // namespace planemap::messages
