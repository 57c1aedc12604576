// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <span>
#include <vector>

namespace planemap::messages {

/// A regular file that is read at any place. Keeps a window of it, so that going forward through small pieces
/// is cheap, and a look far ahead costs no more than its bytes. Everything that fails throws
/// std::runtime_error that names file, place and reason: no such file, no regular file (a FIFO would wait for
/// ever), a read error, a file that became shorter meanwhile.
class FileBytes {
  public:
    explicit FileBytes(const std::filesystem::path& file);
    ~FileBytes();
    FileBytes(const FileBytes&) = delete;
    FileBytes& operator=(const FileBytes&) = delete;

    const std::filesystem::path& path() const { return path_; }
    std::uint64_t size() const { return size_; }  ///< when it was opened

    /// Copies out.size() bytes from `at` on, of which there must be that many; what follows is likely read
    /// next.
    void read(std::uint64_t at, std::span<std::uint8_t> out);
    /// The same for a look aside: the window stays where it is.
    void peek(std::uint64_t at, std::span<std::uint8_t> out);
    /// Where four bytes stand first in [from, to); `to` if they do not. They may reach beyond `to`.
    std::uint64_t find(const std::array<std::uint8_t, 4>& word, std::uint64_t from, std::uint64_t to);
    /// The place in [from, size()] from which on there is nothing but zeros.
    std::uint64_t zeros_from(std::uint64_t from);

  private:
    static constexpr std::size_t kWindow = 65536;

    void read_exactly(std::uint64_t at, std::span<std::uint8_t> out);
    void move_window(std::uint64_t at);
    /// The part of out that the window holds is copied; returns how many bytes.
    std::size_t from_window(std::uint64_t at, std::span<std::uint8_t> out) const;

    std::filesystem::path path_;
    int file_ = -1;
    std::uint64_t size_ = 0, window_at_ = 0;
    std::vector<std::uint8_t> window_;
};

}  // namespace planemap::messages
