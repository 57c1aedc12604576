// SPDX-License-Identifier: BSD-3-Clause
// Named things that a benchmark's user chooses from. An Info has a name and says what it is (`what`).
#pragma once

#include <algorithm>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

namespace planemap {

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

/// Those of `known` that a comma-separated list names, in its order. Throws std::invalid_argument that leads
/// with `field` for an unknown name or an empty list.
template <typename Info>
std::vector<Info> chosen(const std::string& field, const std::string& list, const std::vector<Info>& known) {
    std::vector<Info> infos;
    std::istringstream words(list);
    for (std::string word; std::getline(words, word, ',');) {
        const auto found =
            std::find_if(known.begin(), known.end(), [&](const Info& info) { return info.name == word; });
        if (found == known.end())
            throw std::invalid_argument(field + ": there is no \"" + word + "\", only " +
                                        names_of(known, ", "));
        infos.push_back(*found);
    }
    if (infos.empty()) throw std::invalid_argument(field + ": none given");
    return infos;
}

}  // namespace planemap
