// SPDX-License-Identifier: BSD-3-Clause
#include "camera/freenect_camera.hpp"

#include <libfreenect.h>
#include <sys/time.h>

#include <cstring>
#include <stdexcept>

#include "camera/kinect_depth.hpp"
#include "camera/usb_cameras.hpp"

namespace planemap::camera {

namespace {

constexpr std::ptrdiff_t kPixels = std::ptrdiff_t{640} * 480;  // of FREENECT_RESOLUTION_MEDIUM

using namespace std::chrono_literals;

constexpr auto kFirstFrame = 5000ms;
constexpr std::int64_t kPeriod_us = 33333, kTicksPerUs = 60;

/// Of the modes that there are: libfreenect's fakenect ends the process when it is asked for another.
bool offers(freenect_depth_format format) {
    for (int i = 0; i < freenect_get_depth_mode_count(); ++i) {
        const freenect_frame_mode mode = freenect_get_depth_mode(i);
        if (mode.depth_format == format && mode.resolution == FREENECT_RESOLUTION_MEDIUM) return true;
    }
    return false;
}

}  // namespace

/// What libfreenect gave, given back.
struct FreenectCamera::Device {
    Device() {
        if (freenect_init(&context, nullptr) < 0)
            throw std::runtime_error("freenect: libfreenect does not start");
        freenect_set_log_level(context, FREENECT_LOG_FATAL);
        freenect_select_subdevices(context, FREENECT_DEVICE_CAMERA);
    }
    ~Device() {
        if (handle != nullptr) freenect_close_device(handle);
        freenect_shutdown(context);
    }
    Device(const Device&) = delete;
    Device& operator=(const Device&) = delete;

    freenect_context* context = nullptr;
    freenect_device* handle = nullptr;
};

FreenectCamera::FreenectCamera(const std::string& serial, const CameraRequest& request)
    : serial_(serial), device_(std::make_unique<Device>()) {
    const int opened = serial.empty() ? freenect_open_device(device_->context, &device_->handle, 0)
                                      : freenect_open_device_by_camera_serial(
                                            device_->context, &device_->handle, serial.c_str());
    if (opened < 0) {
        device_->handle = nullptr;
        throw std::runtime_error((serial.empty() ? "freenect: " : "freenect:" + serial + ": ") +
                                 why_no_camera("freenect", usb_cameras()));
    }
    start(request);
    const auto until = std::chrono::steady_clock::now() + kFirstFrame;
    while (!frames_.wait_for_depth(50ms) && !unplugged_ && std::chrono::steady_clock::now() < until) {
    }
    if (!frames_.wait_for_depth(0ms)) {
        stop_ = true;
        thread_.join();
        throw std::runtime_error("freenect: no depth came within " +
                                 std::to_string(kFirstFrame.count() / 1000) + " s of its start");
    }
    frames_.begin(kPeriod_us, true);
}

FreenectCamera::~FreenectCamera() {
    stop_ = true;
    if (thread_.joinable()) thread_.join();
    if (!unplugged_) {
        freenect_stop_depth(device_->handle);
        freenect_stop_video(device_->handle);
    }
}

void FreenectCamera::start(const CameraRequest& request) {
    const CameraOptions& options = request.options;
    if (options.width() != 640 || options.height() != 480 || options.rate_hz != 30)
        notes_.push_back("Kinect v1: " + options.resolution + " at " + std::to_string(options.rate_hz) +
                         " Hz was asked for, and it comes as 640x480 at 30 Hz");
    const bool wants_registration = request.wants_registration();
    const freenect_depth_format wanted = wants_registration ? FREENECT_DEPTH_REGISTERED : FREENECT_DEPTH_MM;
    is_raw_ = !offers(wanted);
    const bool is_registered = wants_registration && !is_raw_;
    if (wants_registration && is_raw_)
        notes_.emplace_back(
            "Kinect v1: comes as raw depth: registration is not done, its colour is unregistered");
    info_ = request.described ? *request.described : kinect_camera(is_registered);
    if (request.described) check(request);
    freenect_device* const handle = device_->handle;
    freenect_set_user(handle, this);
    freenect_set_depth_callback(handle, [](freenect_device* device, void* data, std::uint32_t ticks) {
        auto& self = *static_cast<FreenectCamera*>(freenect_get_user(device));
        const auto* bytes = static_cast<const std::uint8_t*>(data);
        self.frames_.add_depth({self.stamp_us(ticks), wall_us(), Bytes(bytes, bytes + kPixels * 2)});
    });
    freenect_set_video_callback(handle, [](freenect_device* device, void* data, std::uint32_t ticks) {
        auto& self = *static_cast<FreenectCamera*>(freenect_get_user(device));
        const auto* bytes = static_cast<const std::uint8_t*>(data);
        self.frames_.add_color({self.stamp_us(ticks), wall_us(), Bytes(bytes, bytes + kPixels * 3)});
    });
    freenect_set_video_mode(handle, freenect_find_video_mode(FREENECT_RESOLUTION_MEDIUM, FREENECT_VIDEO_RGB));
    freenect_set_depth_mode(handle, freenect_find_depth_mode(FREENECT_RESOLUTION_MEDIUM,
                                                             is_raw_ ? FREENECT_DEPTH_11BIT : wanted));
    if (freenect_start_depth(handle) < 0 || freenect_start_video(handle) < 0)
        throw std::runtime_error("freenect: the Kinect's streams do not start");
    thread_ = std::thread([this] { run(); });
}

void FreenectCamera::check(const CameraRequest& request) const {
    const CameraInfo& said = *request.described;
    FieldErrors errors("camera.json is of another camera");
    const auto is_vga = [](const PinholeCamera& c) { return c.width == 640 && c.height == 480; };
    errors.require(is_vga(said.depth) && is_vga(said.color), "sizes",
                   std::to_string(said.depth.width) + "x" + std::to_string(said.depth.height), "640x480");
    errors.require(said.depth_units_per_metre == 1000, "depth_units_per_metre", said.depth_units_per_metre,
                   "1000");
    errors.require(!(said.registered && is_raw_), "registered", std::string("true"),
                   "false: it comes as raw depth");
    errors.throw_if_any();
}

void FreenectCamera::run() {
    while (!stop_ && !unplugged_) {
        timeval wait{0, 100000};
        if (freenect_process_events_timeout(device_->context, &wait) < 0) unplugged_ = true;
    }
}

std::int64_t FreenectCamera::stamp_us(std::uint32_t ticks) {
    if (ticks_ < 0) ticks_ = ticks;
    // The difference as a signed number: the clock's next round is after this one.
    ticks_ += static_cast<std::int32_t>(ticks - static_cast<std::uint32_t>(ticks_));
    return ticks_ / kTicksPerUs;
}

std::optional<LiveFrame> FreenectCamera::next(std::chrono::milliseconds wait, Losses& lost) {
    const auto pair = frames_.next(wait, lost);
    if (!pair) return std::nullopt;
    LiveFrame frame{pair->depth_us, pair->color_us, pair->depth.arrival_us, DepthImage(640, 480), {}};
    std::memcpy(frame.depth.pixels.data(), pair->depth.image.data(), pair->depth.image.size());
    if (is_raw_) {
        for (std::uint16_t& raw : frame.depth.pixels) raw = raw_to_mm(raw);
    }
    if (pair->color) {
        frame.color = RgbImage(640, 480);
        std::memcpy(static_cast<void*>(frame.color.pixels.data()), pair->color->image.data(),
                    pair->color->image.size());
    }
    return frame;
}

bool has_freenect_camera() {
    freenect_context* context = nullptr;
    if (freenect_init(&context, nullptr) < 0) return false;
    freenect_set_log_level(context, FREENECT_LOG_FATAL);
    const bool has_one = freenect_num_devices(context) > 0;
    freenect_shutdown(context);
    return has_one;
}

}  // namespace planemap::camera
