// SPDX-License-Identifier: BSD-3-Clause
#include "places/matching.hpp"

#include <algorithm>
#include <utility>

namespace planemap::places {

namespace {

/// The two nearest so far.
struct Nearest {
    int index = -1, distance = 257, second = 257;

    void offer(int candidate, int d) {
        if (d < distance) {
            second = distance;
            distance = d;
            index = candidate;
        } else if (d < second) {
            second = d;
        }
    }
    bool is_clear(const MatchingOptions& options) const {
        return index >= 0 && distance <= options.max_distance && distance < options.ratio * second;
    }
};

}  // namespace

std::vector<Match> match(std::span<const Descriptor> a, std::span<const Descriptor> b,
                         const MatchingOptions& options) {
    std::vector<Nearest> of_a(a.size()), of_b(b.size());
    for (std::size_t i = 0; i < a.size(); ++i) {
        for (std::size_t j = 0; j < b.size(); ++j) {
            const int d = hamming_distance(a[i], b[j]);
            of_a[i].offer(static_cast<int>(j), d);
            of_b[j].offer(static_cast<int>(i), d);
        }
    }
    std::vector<Match> matches;
    for (std::size_t i = 0; i < a.size(); ++i) {
        if (!of_a[i].is_clear(options)) continue;
        const Nearest& back = of_b[static_cast<std::size_t>(of_a[i].index)];
        if (back.index == static_cast<int>(i) && back.is_clear(options))
            matches.push_back({static_cast<int>(i), of_a[i].index});
    }
    return matches;
}

std::vector<Match> match_all(std::span<const Descriptor> a, std::span<const Descriptor> b, int max_distance,
                             int most) {
    std::vector<Match> matches;
    std::vector<std::pair<int, int>> near;  // distance, index in a
    for (std::size_t j = 0; j < b.size(); ++j) {
        near.clear();
        for (std::size_t i = 0; i < a.size(); ++i) {
            const int d = hamming_distance(a[i], b[j]);
            if (d <= max_distance) near.emplace_back(d, static_cast<int>(i));
        }
        std::sort(near.begin(), near.end());
        if (static_cast<int>(near.size()) > most) near.resize(static_cast<std::size_t>(most));
        for (const auto& [d, i] : near) matches.push_back({i, static_cast<int>(j)});
    }
    return matches;
}

}  // namespace planemap::places
