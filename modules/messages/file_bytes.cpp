// SPDX-License-Identifier: BSD-3-Clause
#include "messages/file_bytes.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <stdexcept>

namespace planemap::messages {

namespace {

[[noreturn]] void fail(const std::filesystem::path& file, const std::string& what) {
    throw std::runtime_error(file.string() + ": " + what);
}

}  // namespace

FileBytes::FileBytes(const std::filesystem::path& file) : path_(file) {
    // O_NONBLOCK: opening a FIFO must not wait for its writer before it can be refused.
    file_ = ::open(file.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
    if (file_ < 0) fail(path_, std::string("cannot open: ") + std::strerror(errno));
    struct stat info = {};
    const bool known = ::fstat(file_, &info) == 0;
    if (!known || !S_ISREG(info.st_mode)) {
        ::close(file_);
        fail(path_, S_ISDIR(info.st_mode) ? "cannot open: is a folder"
                                          : "cannot open: is no regular file (a log is read twice)");
    }
    size_ = static_cast<std::uint64_t>(std::max<off_t>(info.st_size, 0));
}

FileBytes::~FileBytes() {
    ::close(file_);
}

void FileBytes::read_exactly(std::uint64_t at, std::span<std::uint8_t> out) {
    std::size_t done = 0;
    while (done < out.size()) {
        const ssize_t got =
            ::pread(file_, out.data() + done, out.size() - done, static_cast<off_t>(at + done));
        if (got < 0 && errno == EINTR) continue;
        if (got < 0)
            fail(path_, "cannot read at byte " + std::to_string(at + done) + ": " + std::strerror(errno));
        if (got == 0) {
            fail(path_, "became shorter while it was read: " + std::to_string(at + done) + " of " +
                            std::to_string(size_) + " bytes are left");
        }
        done += static_cast<std::size_t>(got);
    }
}

void FileBytes::move_window(std::uint64_t at) {
    std::vector<std::uint8_t> bytes(static_cast<std::size_t>(std::min<std::uint64_t>(kWindow, size_ - at)));
    read_exactly(at, bytes);
    window_ = std::move(bytes);
    window_at_ = at;
}

std::size_t FileBytes::from_window(std::uint64_t at, std::span<std::uint8_t> out) const {
    if (at < window_at_ || at >= window_at_ + window_.size()) return 0;
    const auto begin = static_cast<std::size_t>(at - window_at_);
    const std::size_t n = std::min(out.size(), window_.size() - begin);
    std::copy_n(window_.data() + begin, n, out.data());
    return n;
}

void FileBytes::read(std::uint64_t at, std::span<std::uint8_t> out) {
    std::size_t done = from_window(at, out);
    if (done < out.size() && out.size() - done < kWindow) {
        move_window(at + done);
        done += from_window(at + done, out.subspan(done));
    }
    read_exactly(at + done, out.subspan(done));
}

void FileBytes::peek(std::uint64_t at, std::span<std::uint8_t> out) {
    const std::size_t done = from_window(at, out);
    read_exactly(at + done, out.subspan(done));
}

std::uint64_t FileBytes::find(const std::array<std::uint8_t, 4>& word, std::uint64_t from, std::uint64_t to) {
    while (from < to && from + word.size() <= size_) {
        if (from < window_at_ || from + word.size() > window_at_ + window_.size()) move_window(from);
        const std::uint8_t* begin = window_.data() + (from - window_at_);
        const std::uint8_t* end = window_.data() + window_.size();
        const void* found = ::memmem(begin, static_cast<std::size_t>(end - begin), word.data(), word.size());
        if (found != nullptr) {
            const auto place = window_at_ + static_cast<std::uint64_t>(
                                                static_cast<const std::uint8_t*>(found) - window_.data());
            return std::min(place, to);
        }
        from = window_at_ + window_.size() - (word.size() - 1);
    }
    return to;
}

std::uint64_t FileBytes::zeros_from(std::uint64_t from) {
    std::vector<std::uint8_t> bytes(kWindow);
    for (std::uint64_t end = size_; end > from;) {
        const std::uint64_t begin = end - std::min<std::uint64_t>(end - from, kWindow);
        const auto part = std::span(bytes).first(static_cast<std::size_t>(end - begin));
        peek(begin, part);
        const auto last =
            std::find_if(part.rbegin(), part.rend(), [](std::uint8_t byte) { return byte != 0; });
        if (last != part.rend()) return end - static_cast<std::uint64_t>(last - part.rbegin());
        end = begin;
    }
    return from;
}

}  // namespace planemap::messages
