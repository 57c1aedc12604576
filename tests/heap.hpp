// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <malloc.h>

#include <cstddef>
#include <cstdlib>

namespace planemap::test {

/// Bytes that malloc has given out, with its own.
inline std::size_t heap_in_use() {
    const struct mallinfo2 info = ::mallinfo2();
    return info.uordblks + info.hblkhd;
}

/// Whether the program's malloc tells: a sanitizer's does not.
inline bool heap_is_told() {
    const std::size_t before = heap_in_use();
    void* volatile block = std::malloc(100'000);
    const bool told = heap_in_use() > before;
    std::free(block);
    return told;
}

}  // namespace planemap::test
