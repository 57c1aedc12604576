// SPDX-License-Identifier: BSD-3-Clause
#include "messages/session.hpp"

#include <charconv>
#include <cstdio>
#include <cstring>
#include <random>
#include <stdexcept>
#include <system_error>

#include "core/files.hpp"
#include "core/sync_folder.hpp"

namespace planemap::messages {

namespace {

std::int64_t positive(std::uint64_t bits) {
    return static_cast<std::int64_t>(bits >> 1 | 1);
}

/// The number in the file; 0 if there is none.
std::uint64_t read_session(const std::filesystem::path& file) {
    std::error_code ignored;
    if (!std::filesystem::exists(file, ignored)) return 0;
    const std::string text = read_file(file, 64);
    std::uint64_t session = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), session, 16);
    if (error != std::errc() || session == 0)
        throw std::runtime_error(file.string() +
                                 ": is no session of 16 hexadecimal digits; remove it to start anew");
    return session;
}

}  // namespace

std::int64_t random_session() {
    std::random_device random;
    return positive(std::uint64_t{random()} << 32 | random());
}

std::int64_t next_session(std::int64_t session) {
    // splitmix64 (Steele, Lea, Flood 2014): far from every number that another session may have.
    std::uint64_t z = static_cast<std::uint64_t>(session) + 0x9e3779b97f4a7c15;
    z = (z ^ z >> 30) * 0xbf58476d1ce4e5b9;
    z = (z ^ z >> 27) * 0x94d049bb133111eb;
    return positive(z ^ z >> 31);
}

bool succeeds(std::int64_t later, std::int64_t earlier) {
    for (int i = 0; i < kMostRestarts; ++i)
        if ((earlier = next_session(earlier)) == later) return true;
    return false;
}

std::int64_t session_with_state(const std::filesystem::path& folder, const std::string& module) {
    std::error_code error;
    std::filesystem::create_directories(folder, error);
    if (error)
        throw std::runtime_error(folder.string() +
                                 ": the folder of the state cannot be made: " + error.message());
    const std::filesystem::path file = folder / (module + ".session");
    const std::uint64_t before = read_session(file);
    const std::int64_t now = before == 0 ? random_session() : next_session(static_cast<std::int64_t>(before));
    char text[24];
    std::snprintf(text, sizeof(text), "%016llx\n", static_cast<unsigned long long>(now));
    write_file(file, text);
    // A name that a power cut may take back would give the same number to two processes.
    if (const int failed = sync_folder(folder); failed != 0)
        throw std::runtime_error(folder.string() + ": cannot be synced: " + std::strerror(failed));
    return now;
}

}  // namespace planemap::messages
