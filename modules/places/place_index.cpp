// SPDX-License-Identifier: BSD-3-Clause
#include "places/place_index.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>

namespace planemap::places {

PlaceIndex::PlaceIndex() {
    std::mt19937_64 engine(20160924);
    std::array<std::uint8_t, 256> all{};
    std::iota(all.begin(), all.end(), std::uint8_t{0});
    std::size_t next = all.size();
    for (auto& table : bits_) {
        for (auto& bit : table) {
            if (next == all.size()) {
                for (std::size_t i = all.size(); i-- > 1;) std::swap(all[i], all[engine() % (i + 1)]);
                next = 0;
            }
            bit = all[next++];
        }
    }
    for (auto& table : places_of_) table.resize(std::size_t{1} << kBits);
}

PlaceIndex::Words PlaceIndex::words(std::span<const Descriptor> descriptors) const {
    Words words;
    for (std::size_t table = 0; table < kTables; ++table) {
        words[table].reserve(descriptors.size());
        for (const Descriptor& descriptor : descriptors) {
            unsigned word = 0;
            for (const auto bit : bits_[table]) word = word << 1 | (descriptor[bit / 8] >> (bit % 8) & 1u);
            words[table].push_back(static_cast<std::uint16_t>(word));
        }
        std::sort(words[table].begin(), words[table].end());
        words[table].erase(std::unique(words[table].begin(), words[table].end()), words[table].end());
    }
    return words;
}

void PlaceIndex::list(Listing& listing, std::int32_t place) {
    std::int32_t entry = first_unused_;
    if (entry < 0) {
        entry = static_cast<std::int32_t>(entries_.size());
        entries_.push_back({});
    } else {
        first_unused_ = entries_[static_cast<std::size_t>(entry)].next;
    }
    entries_[static_cast<std::size_t>(entry)] = {place, listing.first};
    listing.first = entry;
    ++listing.listed;
}

void PlaceIndex::unlist(Listing& listing, std::int32_t& link) {
    const std::int32_t entry = link;
    Entry& e = entries_[static_cast<std::size_t>(entry)];
    link = e.next;
    e.next = first_unused_;
    first_unused_ = entry;
    --listing.listed;
}

int PlaceIndex::add(std::span<const Descriptor> descriptors) {
    const int place = free_.empty() ? numbers_++ : free_.back();
    if (!free_.empty()) free_.pop_back();
    const Words mine = words(descriptors);
    for (std::size_t table = 0; table < kTables; ++table) {
        for (const auto word : mine[table]) {
            Listing& listing = places_of_[table][word];
            if (++listing.count <= static_cast<std::int32_t>(kMostPlaces))
                list(listing, place);
            else
                while (listing.first >= 0) unlist(listing, listing.first);
        }
    }
    return place;
}

void PlaceIndex::remove(int place, std::span<const Descriptor> descriptors) {
    const Words mine = words(descriptors);
    for (std::size_t table = 0; table < kTables; ++table) {
        for (const auto word : mine[table]) {
            Listing& listing = places_of_[table][word];
            --listing.count;
            for (std::int32_t* link = &listing.first; *link >= 0;) {
                Entry& entry = entries_[static_cast<std::size_t>(*link)];
                if (entry.place == place)
                    unlist(listing, *link);
                else
                    link = &entry.next;
            }
        }
    }
    free_.push_back(place);
}

std::size_t PlaceIndex::memory_bytes() const {
    return kTables * (std::size_t{1} << kBits) * sizeof(Listing) + entries_.size() * sizeof(Entry);
}

std::vector<double> PlaceIndex::scores(std::span<const Descriptor> descriptors) const {
    std::vector<double> scores(static_cast<std::size_t>(numbers_), 0.0);
    const Words mine = words(descriptors);
    const std::size_t too_common = std::max<std::size_t>(20, static_cast<std::size_t>(size()) / 10);
    double total = 0;
    for (std::size_t table = 0; table < kTables; ++table) {
        for (const auto word : mine[table]) {
            const Listing& listing = places_of_[table][word];
            const double weight = std::log1p(size() / (1.0 + listing.count));
            total += weight;
            if (static_cast<std::size_t>(listing.listed) > too_common) continue;
            for (std::int32_t entry = listing.first; entry >= 0;
                 entry = entries_[static_cast<std::size_t>(entry)].next)
                scores[static_cast<std::size_t>(entries_[static_cast<std::size_t>(entry)].place)] += weight;
        }
    }
    for (double& score : scores) score /= std::max(total, 1e-12);
    return scores;
}

}  // namespace planemap::places
