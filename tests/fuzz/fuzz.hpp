// SPDX-License-Identifier: BSD-3-Clause
// What the fuzzing harnesses share. A harness is one file NAME_fuzz.cpp that defines the two functions below.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace planemap::fuzz {

using Bytes = std::span<const std::uint8_t>;

/// Gives the decoder these bytes. Errors that the decoder is allowed to throw are caught here, and nothing
/// else: any other exception is a fault, as is what a sanitizer finds, or a require() that does not hold.
void fuzz(Bytes bytes);

/// Good inputs to start from, of what the project itself writes, so that they follow its formats; beside the
/// files of corpus/NAME/.
std::vector<std::string> seeds();

/// Ends the process as a fault with this text if the condition does not hold.
void require(bool condition, const char* what);

/// A file in memory that holds the bytes, for decoders that take a path. As short-lived as this object.
class MemoryFile {
  public:
    explicit MemoryFile(Bytes bytes);
    ~MemoryFile();
    MemoryFile(const MemoryFile&) = delete;
    MemoryFile& operator=(const MemoryFile&) = delete;
    std::filesystem::path path() const;

  private:
    int file_ = -1;
};

inline std::string_view as_text(Bytes bytes) {
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

}  // namespace planemap::fuzz
