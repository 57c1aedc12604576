// SPDX-License-Identifier: BSD-3-Clause
#include "camera/openni2_camera.hpp"

#include <algorithm>
#include <cstring>
#include <stdexcept>
#include <utility>

#include "camera/usb_cameras.hpp"

namespace planemap::camera {

namespace {

using namespace std::chrono_literals;

constexpr auto kFirstFrameWait = 3000ms;

std::string serial_of(const openni::Device& device) {
    char text[128] = {};
    int size = sizeof(text) - 1;
    if (device.getProperty(openni::DEVICE_PROPERTY_SERIAL_NUMBER, text, &size) != openni::STATUS_OK)
        return {};
    return text;
}

/// Without the recordings that a program may have open.
std::vector<openni::DeviceInfo> devices() {
    openni::Array<openni::DeviceInfo> found;
    openni::OpenNI::enumerateDevices(&found);
    std::vector<openni::DeviceInfo> all;
    all.reserve(static_cast<std::size_t>(found.getSize()));
    for (int i = 0; i < found.getSize(); ++i) all.push_back(found[i]);
    return all;
}

std::string modes_text(openni::Device& device, openni::SensorType type) {
    const openni::SensorInfo* const sensor = device.getSensorInfo(type);
    if (sensor == nullptr) return "none that OpenNI2 knows";
    std::string text;
    for (int i = 0; i < sensor->getSupportedVideoModes().getSize(); ++i)
        text += (i == 0 ? "" : "; ") + mode_text(sensor->getSupportedVideoModes()[i]);
    return text;
}

}  // namespace

class OpenNi2Camera::StreamListener : public openni::VideoStream::NewFrameListener {
  public:
    StreamListener(bool is_depth, LiveFrames<openni::VideoFrameRef>& frames)
        : is_depth_(is_depth), frames_(frames) {}
    void onNewFrame(openni::VideoStream& stream) override {
        LiveFrames<openni::VideoFrameRef>::Frame frame;
        frame.arrival_us = wall_us();
        if (stream.readFrame(&frame.image) != openni::STATUS_OK || !frame.image.isValid()) return;
        frame.stamp_us = static_cast<std::int64_t>(frame.image.getTimestamp());
        is_depth_ ? frames_.add_depth(std::move(frame)) : frames_.add_color(std::move(frame));
    }

  private:
    const bool is_depth_;
    LiveFrames<openni::VideoFrameRef>& frames_;
};

class OpenNi2Camera::PlugListener : public openni::OpenNI::DeviceDisconnectedListener {
  public:
    PlugListener(const std::string& uri, std::atomic<bool>& unplugged) : uri_(uri), unplugged_(unplugged) {
        openni::OpenNI::addDeviceDisconnectedListener(this);
    }
    ~PlugListener() override { openni::OpenNI::removeDeviceDisconnectedListener(this); }
    void onDeviceDisconnected(const openni::DeviceInfo* info) override {
        if (uri_ == info->getUri()) unplugged_ = true;
    }

  private:
    const std::string uri_;
    std::atomic<bool>& unplugged_;
};

OpenNi2Camera::OpenNi2Camera(const std::string& wanted, const CameraRequest& request) {
    find(wanted);
    plug_ = std::make_unique<PlugListener>(uri_, unplugged_);
    depth_listener_ = std::make_unique<StreamListener>(true, frames_);
    color_listener_ = std::make_unique<StreamListener>(false, frames_);
    open_depth(request);
    open_color(request);
    start();
    wait_for_depth();
    verify(request);
    info_ = camera_info(name_, depth_, has_color() ? &color_ : nullptr, is_registered_, request, notes_);
    frames_.begin(period_us(), has_color());
    if (!request.record.empty())
        recording_ = std::make_unique<OniRecording>(request.record, depth_, has_color() ? &color_ : nullptr);
}

OpenNi2Camera::~OpenNi2Camera() {
    recording_.reset();
    for (openni::VideoStream* stream : {&depth_, &color_}) {
        if (!stream->isValid()) continue;
        stream->removeNewFrameListener(listener_of(*stream));
        stream->stop();
        stream->destroy();
    }
    frames_.clear();
    device_.close();
}

OpenNi2Camera::StreamListener* OpenNi2Camera::listener_of(const openni::VideoStream& stream) const {
    return (&stream == &depth_ ? depth_listener_ : color_listener_).get();
}

void OpenNi2Camera::note(const std::string& what) {
    notes_.push_back(name_ + ": " + what);
}

/// Opens the device: by URI as it is, by serial number after a look at each, else the first that opens.
void OpenNi2Camera::find(const std::string& wanted) {
    std::string refusal;
    for (const openni::DeviceInfo& info : devices()) {
        const bool by_uri = wanted == info.getUri();
        if (device_.open(info.getUri()) != openni::STATUS_OK) {
            if (wanted.empty() || by_uri)
                refusal = std::string(info.getName()) + " (" + info.getUri() +
                          ") cannot be opened: " + openni2_error();
            continue;
        }
        serial_ = serial_of(device_);
        if (wanted.empty() || by_uri || wanted == serial_) {
            uri_ = info.getUri();
            name_ = std::string(info.getName()) + (serial_.empty() ? "" : " " + serial_);
            return;
        }
        device_.close();
    }
    const std::string input = wanted.empty() ? "openni2" : "openni2:" + wanted;
    const std::vector<UsbCamera> usb = usb_cameras();
    const bool no_permission = std::any_of(
        usb.begin(), usb.end(), [](const UsbCamera& c) { return c.input == "openni2" && !c.may_open; });
    if (!refusal.empty() && !no_permission) throw std::runtime_error(input + ": " + refusal);
    if (!wanted.empty() && !devices().empty())
        throw std::runtime_error(
            input + ": no camera has this URI or serial number; planemap-sensor --list shows them");
    throw std::runtime_error(input + ": " + why_no_camera("openni2", usb));
}

void OpenNi2Camera::choose_mode(openni::VideoStream& stream, openni::SensorType type,
                                const CameraOptions& options) {
    const auto& modes = stream.getSensorInfo().getSupportedVideoModes();
    const auto cost = [&](const openni::VideoMode& mode) {
        const bool depth = type == openni::SENSOR_DEPTH;
        const bool fine = mode.getPixelFormat() == openni::PIXEL_FORMAT_DEPTH_100_UM;
        const bool usable = depth ? fine || mode.getPixelFormat() == openni::PIXEL_FORMAT_DEPTH_1_MM
                                  : is_color_format(mode.getPixelFormat());
        const bool wanted_format = depth ? fine == (options.depth_unit == "100um")
                                         : mode.getPixelFormat() == openni::PIXEL_FORMAT_RGB888;
        return 1000000 * !usable +
               1000 * (std::abs(mode.getResolutionX() - options.width()) +
                       std::abs(mode.getResolutionY() - options.height())) +
               2 * std::abs(mode.getFps() - options.rate_hz) + !wanted_format;
    };
    const openni::VideoMode* best = nullptr;
    for (int i = 0; i < modes.getSize(); ++i)
        if (best == nullptr || cost(modes[i]) < cost(*best)) best = &modes[i];
    if (best != nullptr) stream.setVideoMode(*best);  // what it does is looked up when it runs
}

void OpenNi2Camera::open_depth(const CameraRequest& request) {
    if (!device_.hasSensor(openni::SENSOR_DEPTH)) throw std::runtime_error(name_ + ": has no depth");
    if (depth_.create(device_, openni::SENSOR_DEPTH) != openni::STATUS_OK)
        throw std::runtime_error(name_ + ": its depth cannot be opened: " + openni2_error());
    choose_mode(depth_, openni::SENSOR_DEPTH, request.options);
    depth_.setMirroringEnabled(request.options.mirror);
}

/// Without colour that OpenNI2 gives, the camera is used for its depth.
void OpenNi2Camera::open_color(const CameraRequest& request) {
    if (!device_.hasSensor(openni::SENSOR_COLOR)) {
        note(
            "its colour is no stream of OpenNI2 (as the Astra Pro's, which is a webcam of its own); depth "
            "alone is used");
        return;
    }
    if (color_.create(device_, openni::SENSOR_COLOR) != openni::STATUS_OK) {
        note("its colour cannot be opened (" + openni2_error() + "); depth alone is used");
        return;
    }
    choose_mode(color_, openni::SENSOR_COLOR, request.options);
    if (!is_color_format(color_.getVideoMode().getPixelFormat())) {
        note("sends colour as " + mode_text(color_.getVideoMode()) +
             ", which is not read; depth alone is used");
        color_.destroy();
        return;
    }
    color_.setMirroringEnabled(request.options.mirror);
    device_.setImageRegistrationMode(request.wants_registration() ? openni::IMAGE_REGISTRATION_DEPTH_TO_COLOR
                                                                  : openni::IMAGE_REGISTRATION_OFF);
    if (request.options.frame_sync) device_.setDepthColorSyncEnabled(true);
}

void OpenNi2Camera::start() {
    for (openni::VideoStream* stream : {&depth_, &color_}) {
        if (!stream->isValid()) continue;
        stream->addNewFrameListener(listener_of(*stream));
        if (stream->start() != openni::STATUS_OK)
            throw std::runtime_error(name_ + ": does not start: " + openni2_error());
    }
}

/// The first frames are not used: the device may change how it takes them meanwhile.
void OpenNi2Camera::wait_for_depth() {
    const auto until = std::chrono::steady_clock::now() + kFirstFrameWait;
    while (!frames_.wait_for_depth(50ms)) {
        if (unplugged_) throw std::runtime_error(name_ + ": was unplugged while it started");
        if (std::chrono::steady_clock::now() > until)
            throw std::runtime_error(name_ + ": no depth came within " +
                                     std::to_string(kFirstFrameWait.count() / 1000) + " s of its start");
    }
}

std::optional<LiveFrame> OpenNi2Camera::next(std::chrono::milliseconds wait, Losses& lost) {
    const auto pair = frames_.next(wait, lost);
    if (!pair) return std::nullopt;
    if (recording_) recording_->watch();
    LiveFrame frame{
        pair->depth_us, pair->color_us, pair->depth.arrival_us, depth_image(pair->depth.image), {}};
    if (pair->color) frame.color = color_image(pair->color->image);
    return frame;
}

std::int64_t OpenNi2Camera::period_us() const {
    return 1000000 / std::max(depth_.getVideoMode().getFps(), 1);
}

void OpenNi2Camera::set_exposure(int exposure) {
    openni::CameraSettings* const settings = color_.getCameraSettings();
    const auto is_done = [&] {
        if (settings == nullptr) return false;
        return exposure == 0 ? settings->getAutoExposureEnabled()
                             : !settings->getAutoExposureEnabled() && settings->getExposure() == exposure;
    };
    if (settings == nullptr) {
        if (exposure != 0) note("has no setting for exposure; --camera-exposure does nothing");
        return;
    }
    settings->setAutoExposureEnabled(exposure == 0);
    if (exposure != 0) settings->setExposure(exposure);
    if (!is_done() && exposure != 0)
        note("exposure " + std::to_string(exposure) + " was asked for, and it is " +
             (settings->getAutoExposureEnabled() ? "automatic" : std::to_string(settings->getExposure())));
}

/// Registration may be accepted and not done, and may be done only if it is asked for while the streams run.
void OpenNi2Camera::verify_registration(bool wanted) {
    const auto mode = wanted ? openni::IMAGE_REGISTRATION_DEPTH_TO_COLOR : openni::IMAGE_REGISTRATION_OFF;
    if (device_.getImageRegistrationMode() != mode) device_.setImageRegistrationMode(mode);
    is_registered_ = device_.getImageRegistrationMode() == openni::IMAGE_REGISTRATION_DEPTH_TO_COLOR;
    if (wanted && !is_registered_)
        note("registration was asked for and is not done: its colour is unregistered");
    if (!wanted && is_registered_) note("depth is registered to colour, although that was not asked for");
}

/// What the device does now that its streams run, against what was asked for.
void OpenNi2Camera::verify(const CameraRequest& request) {
    const CameraOptions& options = request.options;
    for (openni::VideoStream* stream : {&depth_, &color_}) {
        if (!stream->isValid()) continue;
        const openni::VideoMode mode = stream->getVideoMode();
        const std::string what = stream == &depth_ ? "depth" : "colour";
        if (mode.getResolutionX() != options.width() || mode.getResolutionY() != options.height() ||
            mode.getFps() != options.rate_hz)
            note(what + " was asked for as " + options.resolution + " at " + std::to_string(options.rate_hz) +
                 " Hz, and comes as " + mode_text(mode));
        if (stream->getMirroringEnabled() != options.mirror)
            note(what + (options.mirror ? " is not mirrored, although that was asked for"
                                        : " is mirrored, and cannot be had otherwise: so will be the map"));
    }
    const bool fine = depth_.getVideoMode().getPixelFormat() == openni::PIXEL_FORMAT_DEPTH_100_UM;
    if (fine != (options.depth_unit == "100um"))
        note("depth was asked for in " + options.depth_unit + ", and comes in " + (fine ? "100um" : "1mm"));
    if (!has_color()) return;
    verify_registration(request.wants_registration());
    set_exposure(options.exposure);
    if (options.frame_sync && !device_.getDepthColorSyncEnabled())
        note("does not take depth and colour at the same time; they are paired by their stamps");
}

std::string OpenNi2Camera::ending() const {
    if (!recording_ || !recording_->is_running()) return {};
    return "the recording ends here: " + recording_->file().string();
}

void OpenNi2Camera::end_recording() {
    if (recording_) recording_->end();
}

std::string OpenNi2Camera::fault() const {
    return recording_ ? recording_->fault() : "";
}

std::string list_openni2_cameras() {
    const OpenNi2Library library;
    std::string text;
    for (const openni::DeviceInfo& info : devices()) {
        openni::Device device;
        text +=
            std::string("openni2:") + info.getUri() + "  " + info.getName() + " (" + info.getVendor() + ")";
        if (device.open(info.getUri()) != openni::STATUS_OK) {
            text += "\n  cannot be opened: " + openni2_error() + "\n";
            continue;
        }
        const std::string serial = serial_of(device);
        text += serial.empty() ? "\n" : ", serial number " + serial + "\n";
        text += "  depth: " + modes_text(device, openni::SENSOR_DEPTH) + "\n";
        text += "  colour: " + modes_text(device, openni::SENSOR_COLOR) + "\n";
        const bool registers =
            device.isImageRegistrationModeSupported(openni::IMAGE_REGISTRATION_DEPTH_TO_COLOR);
        text += std::string("  registration: ") + (registers ? "yes" : "no") + "\n";
        device.close();
    }
    return text;
}

}  // namespace planemap::camera
