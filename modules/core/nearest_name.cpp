// SPDX-License-Identifier: BSD-3-Clause
#include "core/nearest_name.hpp"

#include <algorithm>
#include <vector>

namespace planemap {

namespace {

/// Upper case as lower case, - as _.
std::string folded(std::string_view text) {
    std::string result(text);
    for (char& c : result) {
        if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
        if (c == '-') c = '_';
    }
    return result;
}

/// Edits between a and b: insertions, deletions, replacements, and swaps of neighbours (optimal string
/// alignment).
std::size_t edits(std::string_view a, std::string_view b) {
    std::vector<std::size_t> before(b.size() + 1), last(b.size() + 1), row(b.size() + 1);
    for (std::size_t j = 0; j <= b.size(); ++j) row[j] = j;
    for (std::size_t i = 1; i <= a.size(); ++i) {
        before.swap(last);
        last.swap(row);
        row[0] = i;
        for (std::size_t j = 1; j <= b.size(); ++j) {
            const std::size_t replaced = last[j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1);
            row[j] = std::min({last[j] + 1, row[j - 1] + 1, replaced});
            if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1]) {
                row[j] = std::min(row[j], before[j - 2] + 1);
            }
        }
    }
    return row[b.size()];
}

}  // namespace

std::string nearest_name(std::string_view word, std::span<const std::string> names) {
    std::size_t longest = 0;
    for (const std::string& name : names) longest = std::max(longest, name.size());
    if (word.empty() || word.size() > 2 * longest) return {};  // no name is near, however the letters fall
    const std::string meant = folded(word);
    const std::string* nearest = nullptr;
    std::size_t fewest = 0;
    for (const std::string& name : names) {
        const std::size_t count = edits(meant, folded(name));
        if (3 * count > std::max(meant.size(), name.size())) continue;
        if (nearest == nullptr || count < fewest) {
            nearest = &name;
            fewest = count;
        }
    }
    if (nearest != nullptr) return *nearest;
    constexpr std::size_t kLettersThatTell = 3;
    if (meant.size() < kLettersThatTell) return {};
    const auto begun = std::find_if(names.begin(), names.end(),
                                    [&](const std::string& name) { return folded(name).starts_with(meant); });
    return begun == names.end() ? std::string() : *begun;
}

}  // namespace planemap
