// SPDX-License-Identifier: BSD-3-Clause
#include "camera/oni_source.hpp"

#include <algorithm>
#include <array>
#include <stdexcept>

#include "camera/frame_pairing.hpp"
#include "camera/oni_file.hpp"
#include "camera/openni2_device.hpp"

namespace planemap::camera {

namespace {

/// The player reads a file; that it takes longer means that it does not go on.
constexpr int kPatience_ms = 5000;

std::int64_t half_period_us(const openni::VideoStream& depth) {
    return 500000 / std::max(depth.getVideoMode().getFps(), 1);
}

}  // namespace

/// The file as a device that hands out one frame after the other when asked (playback speed -1: manual).
class OniSource::Player {
  public:
    explicit Player(const std::filesystem::path& file) : file_(file), pairing_(0) {
        check_oni_file(file);
        const std::string path = std::filesystem::absolute(file).string();
        if (device_.open(path.c_str()) != openni::STATUS_OK || !device_.isFile())
            fail("cannot be played: " + openni2_error());
        openni::PlaybackControl* const playback = device_.getPlaybackControl();
        if (playback == nullptr || playback->setSpeed(-1) != openni::STATUS_OK ||
            playback->setRepeatEnabled(false) != openni::STATUS_OK)
            fail("cannot be played frame by frame: " + openni2_error());
        if (!device_.hasSensor(openni::SENSOR_DEPTH)) fail("holds no depth");
        open(0, openni::SENSOR_DEPTH);
        has_color_ = device_.hasSensor(openni::SENSOR_COLOR);
        if (has_color_) open(1, openni::SENSOR_COLOR);
        if (has_color_ && !is_color_format(streams_[1].getVideoMode().getPixelFormat())) {
            has_color_ = false;
            streams_[1].destroy();
        }
        for (std::size_t i = 0; i < count(); ++i)
            left_[i] = std::max(playback->getNumberOfFrames(streams_[i]), 0);
        frames_ = static_cast<std::size_t>(left_[0]);
        pairing_ = Pairing(half_period_us(depth()));
        pairing_.expect_color(has_color_);
        for (std::size_t i = 0; i < count(); ++i) {
            if (streams_[i].start() != openni::STATUS_OK) fail("cannot be played: " + openni2_error());
        }
    }

    const openni::VideoStream& depth() const { return streams_[0]; }
    const openni::VideoStream* color() const { return has_color_ ? &streams_[1] : nullptr; }
    std::size_t frames() const { return frames_; }
    std::int64_t unpaired_colors() const { return pairing_.unpaired_colors(); }

    using Pairing = FramePairing<openni::VideoFrameRef>;
    /// Nothing at the end. Throws std::runtime_error if the player does not come to it.
    std::optional<Pairing::Pair> next() {
        for (;;) {
            if (std::optional<Pairing::Pair> pair = pairing_.take()) return pair;
            if (left_[0] + left_[1] == 0) {
                pairing_.end();
                return pairing_.take();
            }
            read_one();
        }
    }

  private:
    [[noreturn]] void fail(const std::string& what) const {
        throw std::runtime_error(file_.string() + ": " + what);
    }
    std::size_t count() const { return has_color_ ? 2 : 1; }
    void open(std::size_t i, openni::SensorType type) {
        if (streams_[i].create(device_, type) != openni::STATUS_OK)
            fail("cannot be played: " + openni2_error());
    }
    /// Waiting lets the player go on by one record; what it gave is read before it is asked again.
    void read_one() {
        std::array<openni::VideoStream*, 2> all{&streams_[0], &streams_[1]};
        int ready = -1;
        openni::VideoFrameRef frame;
        if (openni::OpenNI::waitForAnyStream(all.data(), static_cast<int>(count()), &ready, kPatience_ms) !=
                openni::STATUS_OK ||
            streams_[static_cast<std::size_t>(ready)].readFrame(&frame) != openni::STATUS_OK ||
            !frame.isValid())
            fail("the recording breaks off with " + std::to_string(left_[0]) + " depth frames to go");
        const auto i = static_cast<std::size_t>(ready);
        left_[i] = std::max(left_[i] - 1, 0);
        const auto stamp_us = static_cast<std::int64_t>(frame.getTimestamp());
        if (i == 0)
            pairing_.add_depth(stamp_us, frame);
        else
            pairing_.add_color(stamp_us, frame);
    }

    OpenNi2Library library_;  // ends after all that is of it
    std::filesystem::path file_;
    openni::Device device_;
    std::array<openni::VideoStream, 2> streams_;
    std::array<int, 2> left_{};  ///< frames that were not read yet
    bool has_color_ = false;
    std::size_t frames_ = 0;
    Pairing pairing_;
};

OniSource::OniSource(std::filesystem::path file, CameraRequest request)
    : file_(std::move(file)), request_(std::move(request)), player_(std::make_unique<Player>(file_)) {
    const bool is_registered = request_.wants_registration();
    if (player_->color() == nullptr) {
        notes_.push_back(file_.string() + ": holds no colour that can be read; depth alone is used");
    } else if (is_registered && !request_.described && request_.options.registration == "auto") {
        notes_.push_back(file_.string() +
                         ": does not say whether its depth is registered to colour, and is taken to "
                         "be; give --camera-registration off, or --camera camera.json, if it is not");
    }
    camera_ = camera_info(file_.filename().string(), player_->depth(), player_->color(), is_registered,
                          request_, notes_);
}

OniSource::~OniSource() = default;

std::optional<std::size_t> OniSource::size() const {
    if (request_.repeat) return std::nullopt;
    return player_->frames();
}

ReadResult OniSource::next(SensorFrame& frame) {
    frame = {};
    std::optional<Player::Pairing::Pair> pair = player_->next();
    if (!pair && request_.repeat) {
        player_.reset();  // before the file is opened again
        player_ = std::make_unique<Player>(file_);
        reported_unpaired_ = 0;
        pair = player_->next();
        if (pair) later_us_ = last_us_ + 2 * half_period_us(player_->depth()) - pair->depth_us;
    }
    if (!pair) return {.status = ReadResult::Status::kEnd, .message = {}};
    ReadResult result{.status = ReadResult::Status::kFrame, .message = {}};
    frame.utime = last_us_ = pair->depth_us + later_us_;
    frame.depth = depth_image(pair->depth);
    if (pair->color) {
        frame.color_utime = std::max<std::int64_t>(pair->color_us + later_us_, 1);  // 0 would be none
        frame.color = color_image(*pair->color);
    } else if (player_->color() != nullptr) {
        result.lost["depth frames without a colour frame near in time"] = 1;
    }
    const std::int64_t unpaired = player_->unpaired_colors() - reported_unpaired_;
    reported_unpaired_ += unpaired;
    if (unpaired > 0) result.lost["colour frames without a depth frame near in time"] = unpaired;
    const bool fits = frame.depth.width == camera_.depth.width && frame.depth.height == camera_.depth.height;
    if (fits) return result;
    frame = {};
    return {.status = ReadResult::Status::kBroken,
            .message = file_.string() + ": the size of its images changes"};
}

}  // namespace planemap::camera
