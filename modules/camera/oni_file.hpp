// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <utility>

namespace planemap::camera {

/// Walks the records of an OpenNI recording from its header on, as far as they are whole: of one that is
/// still being written as well.
class OniWalk {
  public:
    explicit OniWalk(std::filesystem::path file) : file_(std::move(file)) {}

    /// Goes on over what is whole by now. Throws std::runtime_error, one line that names the file and the
    /// place, if it cannot be read, is no recording, or no record begins where one must.
    void go_on();
    /// Where the first record begins that is not whole, or the end record: bytes from the file's begin.
    std::uint64_t place() const { return place_; }
    /// Of a recording that was closed: it names as many frames as it holds, and ends where it ends. OpenNI2's
    /// recorder counts those too whose write failed, and what it wrote of them stays behind the end.
    void finish() const;
    /// True behind the last frame of a recording that was closed.
    bool is_at_end() const { return is_at_end_; }

  private:
    struct Node {
        std::uint64_t frames_place = 0;  ///< of what its record says of its frames
        std::uint32_t frames = 0;        ///< that were seen
    };

    [[noreturn]] void fail(const std::string& what) const;

    std::filesystem::path file_;
    std::uint64_t place_ = 0;
    bool is_at_end_ = false;
    std::map<std::uint32_t, Node> nodes_;  ///< by id
};

/// Walks a whole recording. Throws what OniWalk throws, and for a file that is cut short, or was not closed:
/// OpenNI2's player waits for ever or fails without a reason there.
void check_oni_file(const std::filesystem::path& file);

}  // namespace planemap::camera
