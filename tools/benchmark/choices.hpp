// SPDX-License-Identifier: BSD-3-Clause
// Named things that a benchmark's user chooses from. An Info has a name and says what it is (`what`).
#pragma once

#include <algorithm>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

namespace planemap::benchmark {

/// All names, with `separator` between them.
template <typename Info>
std::string names_of(const std::vector<Info>& known, const std::string& separator = ",") {
    std::string list;
    for (const Info& info : known) list += (list.empty() ? "" : separator) + info.name;
    return list;
}

/// One line each: name, padded to `width`, and what it is.
template <typename Info>
std::string described(const std::vector<Info>& known, std::size_t width) {
    std::string text;
    for (const Info& info : known)
        text += "  " + info.name + std::string(width - info.name.size(), ' ') + info.what + "\n";
    return text;
}

/// The one of that name. Throws std::invalid_argument that leads with `field` and lists what there is.
template <typename Info>
const Info& named(const std::string& field, const std::string& name, const std::vector<Info>& known) {
    const auto found =
        std::find_if(known.begin(), known.end(), [&](const Info& info) { return info.name == name; });
    if (found == known.end()) {
        throw std::invalid_argument(field + ": there is no \"" + name + "\", only " + names_of(known, ", "));
    }
    return *found;
}

/// Calls take(word) for each word of a comma-separated list. Throws std::invalid_argument that leads with
/// `field` for an empty list.
template <typename Take>
void for_each_word(const std::string& field, const std::string& list, const Take& take) {
    std::istringstream words(list);
    bool any = false;
    for (std::string word; std::getline(words, word, ','); any = true) take(word);
    if (!any) throw std::invalid_argument(field + ": none given");
}

/// Those of `known` that a comma-separated list names, in its order; throws as named() and for_each_word().
template <typename Info>
std::vector<Info> chosen(const std::string& field, const std::string& list, const std::vector<Info>& known) {
    std::vector<Info> infos;
    for_each_word(field, list, [&](const std::string& word) { infos.push_back(named(field, word, known)); });
    return infos;
}

}  // namespace planemap::benchmark
