// SPDX-License-Identifier: BSD-3-Clause
#include "camera/oni_recording.hpp"

#include <stdexcept>
#include <utility>

#include "camera/openni2_device.hpp"

namespace planemap::camera {

namespace {

using namespace std::chrono_literals;

constexpr auto kLookEvery = 250ms;
/// Longer than a disk that is busy holds a write up.
constexpr auto kPatience = 5s;
/// Several seconds of a camera: the file is closed before another program takes the rest.
constexpr std::uintmax_t kFreeBytes = 64 << 20;

std::filesystem::path beside(const std::filesystem::path& file) {
    return file.parent_path() / ("." + file.filename().string() + ".partial");
}

/// Why a recording that stands there must end now; empty: it need not.
std::string lack_of_room(const std::filesystem::path& file) {
    std::error_code unknown;
    const std::filesystem::space_info space = std::filesystem::space(file, unknown);
    if (unknown || space.available >= kFreeBytes) return {};
    return "its disk is nearly full (less than " + std::to_string(kFreeBytes >> 20) + " MB are free)";
}

}  // namespace

OniRecording::OniRecording(std::filesystem::path file, openni::VideoStream& depth, openni::VideoStream* color)
    : file_(std::move(file)), beside_(beside(file_)), walk_(beside_) {
    if (std::filesystem::exists(file_))
        throw std::runtime_error(file_.string() + " is there already: give another --record, or remove it");
    const std::filesystem::path folder = file_.has_parent_path() ? file_.parent_path() : ".";
    if (const std::string lack = lack_of_room(folder); !lack.empty())
        throw std::runtime_error(file_.string() + ": cannot be recorded: " + lack);
    const bool works = recorder_.create(beside_.c_str()) == openni::STATUS_OK &&
                       recorder_.attach(depth) == openni::STATUS_OK &&
                       (color == nullptr || recorder_.attach(*color, true) == openni::STATUS_OK) &&
                       recorder_.start() == openni::STATUS_OK;
    if (!works) throw std::runtime_error(file_.string() + ": cannot be recorded: " + openni2_error());
}

/// What keeps the recording from going on; empty: nothing.
std::string OniRecording::trouble() {
    if (std::string lack = lack_of_room(beside_); !lack.empty()) return lack;
    const std::uint64_t before = walk_.place();
    try {
        walk_.go_on();
    } catch (const std::exception& error) {
        if (before > 0) return error.what();  // else its header is still to come
    }
    if (walk_.place() > before) grew_ = Clock::now();
    return Clock::now() - grew_ > kPatience ? "nothing more of it is written (is its disk full?)" : "";
}

void OniRecording::watch() {
    if (!is_running() || Clock::now() - looked_ < kLookEvery) return;
    looked_ = Clock::now();
    if (const std::string why = trouble(); !why.empty()) close(why);
}

void OniRecording::end() {
    if (is_running()) close("");
}

/// `why`: it ends too early; empty: it does not.
void OniRecording::close(const std::string& why) {
    recorder_.stop();
    recorder_.destroy();
    std::string fault = why, left;
    try {
        walk_ = OniWalk(beside_);
        walk_.go_on();
        if (!walk_.is_at_end()) throw std::runtime_error("it could not be closed");
        if (!fault.empty()) walk_.finish();
        std::filesystem::rename(beside_, file_);
        left = "what was recorded before is whole";
    } catch (const std::exception& error) {
        if (fault.empty()) fault = error.what();
        left = "what was recorded before is not whole, and is left as " + beside_.string();
    }
    if (!fault.empty()) fault_ = file_.string() + ": the recording ends here: " + fault + "; " + left;
}

}  // namespace planemap::camera
