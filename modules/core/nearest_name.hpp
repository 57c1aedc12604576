// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace planemap {

/// The name that `word` was probably meant to be: the one with the fewest letters left out, added, replaced
/// or swapped with their neighbour, at most one in three of the longer of both; else the first one that
/// begins with `word` (three letters or more). Case and the difference of - and _ do not count. Of equally
/// near names the first. Empty when none is near; `word` may be anything and of any length.
std::string nearest_name(std::string_view word, std::span<const std::string> names);

}  // namespace planemap
