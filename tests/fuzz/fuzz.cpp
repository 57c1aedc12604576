// SPDX-License-Identifier: BSD-3-Clause
#include "fuzz/fuzz.hpp"

#include <spdlog/spdlog.h>
#include <sys/mman.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <fstream>

namespace planemap::fuzz {

void require(bool condition, const char* what) {
    if (condition) return;
    std::fprintf(stderr, "fuzz: this does not hold: %s\n", what);
    std::abort();
}

MemoryFile::MemoryFile(Bytes bytes) : file_(::memfd_create("fuzz", MFD_CLOEXEC)) {
    require(file_ >= 0, "a file in memory can be made");
    for (std::size_t written = 0; written < bytes.size();) {
        const ssize_t n = ::write(file_, bytes.data() + written, bytes.size() - written);
        require(n > 0, "a file in memory can be written");
        written += static_cast<std::size_t>(n);
    }
}
MemoryFile::~MemoryFile() {
    ::close(file_);
}
std::filesystem::path MemoryFile::path() const {
    return "/proc/self/fd/" + std::to_string(file_);
}

}  // namespace planemap::fuzz

/// With PLANEMAP_FUZZ_SEEDS=FOLDER the harness writes its seeds there and ends.
extern "C" int LLVMFuzzerInitialize(int*, char***) {
    spdlog::set_level(spdlog::level::off);
    const char* const folder = std::getenv("PLANEMAP_FUZZ_SEEDS");
    if (folder == nullptr) return 0;
    int count = 0;
    for (const std::string& seed : planemap::fuzz::seeds()) {
        std::ofstream file(std::filesystem::path(folder) / ("seed-" + std::to_string(count++)),
                           std::ios::binary);
        file << seed << std::flush;
        planemap::fuzz::require(file.good(), "seeds can be written");
    }
    std::exit(0);
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    planemap::fuzz::fuzz({data, size});
    return 0;
}
