// SPDX-License-Identifier: BSD-3-Clause
#include "camera/live_source.hpp"

#include <algorithm>
#include <stdexcept>
#include <thread>
#include <utility>

namespace planemap::camera {

namespace {

using namespace std::chrono_literals;

constexpr auto kWait = 100ms, kSilence = 2000ms;
constexpr std::chrono::milliseconds kFirstPatience = 1000ms, kLastPatience = 15000ms;

}  // namespace

LiveSource::LiveSource(Open open) : open_(std::move(open)), opened_(open_({})) {
    info_ = opened_->info();
    name_ = opened_->name();
    serial_ = opened_->serial();
    notes_ = opened_->notes();
}

void LiveSource::close(const std::string& why) {
    trouble_ = name_ + ": " + why;
    if (const std::string ending = opened_->ending(); !ending.empty()) trouble_ += "; " + ending;
    opened_->end_recording();
    if (const std::string fault = new_fault(); !fault.empty()) trouble_ += "; " + fault;
    opened_.reset();
    patience_ = kFirstPatience;
    retry_at_ = Clock::now() + patience_;
}

/// The same camera as before: where it is plugged in may be another place now.
void LiveSource::open_again() {
    if (Clock::now() < retry_at_) return;
    try {
        std::unique_ptr<LiveCamera> opened = open_(serial_);
        if (!(opened->info() == info_))
            throw std::runtime_error(opened->name() + ": came back as another camera");
        opened_ = std::move(opened);
        trouble_.clear();
    } catch (const std::exception& error) {
        trouble_ = name_ + " is away: " + error.what();
        patience_ = std::min(2 * patience_, kLastPatience);
        retry_at_ = Clock::now() + patience_;
    }
}

/// What failed beside the frames since it was asked last.
std::string LiveSource::new_fault() {
    if (!fault_.empty()) return {};
    fault_ = opened_->fault();
    return fault_;
}

std::string LiveSource::end() {
    if (opened_) {
        opened_->end_recording();
        new_fault();
    }
    return fault_;
}

ReadResult LiveSource::next(SensorFrame& frame) {
    frame = {};
    ReadResult result{.status = ReadResult::Status::kNothing, .message = {}};
    if (!opened_) open_again();
    if (!opened_) {
        std::this_thread::sleep_for(kWait);
        result.message = trouble_;
        return result;
    }
    std::optional<LiveFrame> live = opened_->next(kWait, result.lost);
    if (!live) {
        if (opened_->is_unplugged()) {
            close("unplugged");
        } else if (opened_->silence() > kSilence) {
            close("sends nothing any more, and is opened again");
        }
        result.message = trouble_;
        return result;
    }
    if (live->depth.width != info_.depth.width || live->depth.height != info_.depth.height) {
        result.status = ReadResult::Status::kBroken;
        result.message = name_ + ": the size of its images changed";
        return result;
    }
    result.status = ReadResult::Status::kFrame;
    result.beside = new_fault();
    const int resets = clock_.resets();
    frame.utime = clock_.host_time(live->depth_us, live->arrival_us);
    if (clock_.resets() > resets)
        ++result.lost["synchronisations with the camera's clock, which began again or jumped"];
    frame.depth = std::move(live->depth);
    if (live->color.empty()) return result;
    frame.color_utime = frame.utime + live->color_us - live->depth_us;
    frame.color = std::move(live->color);
    return result;
}

}  // namespace planemap::camera
