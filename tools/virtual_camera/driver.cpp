// SPDX-License-Identifier: BSD-3-Clause
// An OpenNI2 driver whose one device streams a recording or the simulator. OpenNI2 loads it from the folder
// that planemap-virtual-camera sets up, into whatever program runs there; kOrderVariable says what it
// streams.
#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <condition_variable>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <mutex>
#include <new>
#include <thread>

#define XN_NEW(type, ...) new type(__VA_ARGS__)
#define XN_DELETE(pointer) delete (pointer)
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wpedantic"
#include <Driver/OniDriverAPI.h>
#pragma GCC diagnostic pop

#include "core/registration.hpp"
#include "virtual_camera/feed.hpp"

namespace planemap::virtual_camera {
namespace {

namespace driver = oni::driver;
using Clock = std::chrono::steady_clock;

constexpr const char* kUri = "virtual://camera";
constexpr const char* kSerial = "VIRTUAL0001";
constexpr int kMaxDepth_mm = 10000;

void say(const std::string& what) {
    std::fprintf(stderr, "virtual camera: %s\n", what.c_str());
}

/// Writes a property of type T; the caller's room must be large enough.
template <typename T>
OniStatus give(const T& value, void* data, int* size) {
    if (*size < static_cast<int>(sizeof(T))) return ONI_STATUS_BAD_PARAMETER;
    std::memcpy(data, &value, sizeof(T));
    *size = sizeof(T);
    return ONI_STATUS_OK;
}
OniStatus give_text(const char* text, void* data, int* size) {
    const int needed = static_cast<int>(std::strlen(text)) + 1;
    if (*size < needed) return ONI_STATUS_BAD_PARAMETER;
    std::memcpy(data, text, static_cast<std::size_t>(needed));
    *size = needed;
    return ONI_STATUS_OK;
}
template <typename T>
OniStatus take(T& value, const void* data, int size) {
    if (size != static_cast<int>(sizeof(T))) return ONI_STATUS_BAD_PARAMETER;
    std::memcpy(&value, data, sizeof(T));
    return ONI_STATUS_OK;
}

/// What both streams and the device share.
struct DeviceState {
    explicit DeviceState(const Order& order) : feed(order) {}

    /// Depth lies at colour's pixels: because the input's does, or because it was asked for and is done.
    bool is_registered() const { return feed.camera().registered || registration; }

    Feed feed;
    std::atomic<bool> registration{false};
    std::atomic<int> running{0};  ///< streams that were started
};

/// Depth or colour.
class Stream : public driver::StreamBase {
  public:
    Stream(OniSensorType type, const OniVideoMode& mode, DeviceState& state, void (*started)(void*),
           void* cookie)
        : type_(type), mode_(mode), state_(state), started_(started), cookie_(cookie) {}

    OniStatus start() override {
        {
            const std::lock_guard lock(mutex_);
            if (running_) return ONI_STATUS_OK;
            running_ = true;
        }
        ++state_.running;
        started_(cookie_);
        return ONI_STATUS_OK;
    }
    void stop() override {
        const std::lock_guard lock(mutex_);
        if (running_) --state_.running;
        running_ = false;
    }

    int getRequiredFrameSize() override {
        return mode_.resolutionX * mode_.resolutionY * static_cast<int>(bytes_per_pixel());
    }

    OniBool isPropertySupported(int id) override {
        switch (id) {
            case ONI_STREAM_PROPERTY_AUTO_EXPOSURE:
            case ONI_STREAM_PROPERTY_AUTO_WHITE_BALANCE:
            case ONI_STREAM_PROPERTY_EXPOSURE:
                return type_ == ONI_SENSOR_COLOR;
            case ONI_STREAM_PROPERTY_MAX_VALUE:
            case ONI_STREAM_PROPERTY_MIN_VALUE:
                return type_ == ONI_SENSOR_DEPTH;
            case ONI_STREAM_PROPERTY_HORIZONTAL_FOV:
            case ONI_STREAM_PROPERTY_VERTICAL_FOV:
            case ONI_STREAM_PROPERTY_VIDEO_MODE:
            case ONI_STREAM_PROPERTY_STRIDE:
            case ONI_STREAM_PROPERTY_MIRRORING:
            case ONI_STREAM_PROPERTY_CROPPING:  // never done, but recordings without it cannot be played
                return TRUE;
            default:
                return FALSE;
        }
    }
    OniStatus getProperty(int id, void* data, int* size) override {
        if (!isPropertySupported(id)) return ONI_STATUS_NOT_SUPPORTED;
        switch (id) {
            case ONI_STREAM_PROPERTY_HORIZONTAL_FOV:
                return give(fov(camera().width, camera().fx), data, size);
            case ONI_STREAM_PROPERTY_VERTICAL_FOV:
                return give(fov(camera().height, camera().fy), data, size);
            case ONI_STREAM_PROPERTY_VIDEO_MODE:
                return give(mode_, data, size);
            case ONI_STREAM_PROPERTY_STRIDE:
                return give(mode_.resolutionX * static_cast<int>(bytes_per_pixel()), data, size);
            case ONI_STREAM_PROPERTY_MIRRORING:
                return give(OniBool{mirror_}, data, size);
            case ONI_STREAM_PROPERTY_AUTO_EXPOSURE:
                return give(OniBool{exposure_ == 0}, data, size);
            case ONI_STREAM_PROPERTY_AUTO_WHITE_BALANCE:
                return give(OniBool{TRUE}, data, size);
            case ONI_STREAM_PROPERTY_EXPOSURE:
                return give(exposure_.load(), data, size);
            case ONI_STREAM_PROPERTY_CROPPING:
                return give(OniCropping{}, data, size);
            case ONI_STREAM_PROPERTY_MAX_VALUE:
                return give(is_fine() ? 65000 : kMaxDepth_mm, data, size);
            default:
                return give(0, data, size);
        }
    }
    OniStatus setProperty(int id, const void* data, int size) override {
        int value = 0;
        switch (id) {
            case ONI_STREAM_PROPERTY_VIDEO_MODE: {
                const std::lock_guard lock(mutex_);
                return take(mode_, data, size);
            }
            case ONI_STREAM_PROPERTY_MIRRORING:
                if (take(value, data, size) != ONI_STATUS_OK) return ONI_STATUS_BAD_PARAMETER;
                mirror_ = value != 0;
                return ONI_STATUS_OK;
            case ONI_STREAM_PROPERTY_AUTO_EXPOSURE:
                if (take(value, data, size) != ONI_STATUS_OK) return ONI_STATUS_BAD_PARAMETER;
                exposure_ = value != 0 ? 0 : kOwnExposure;
                return ONI_STATUS_OK;
            case ONI_STREAM_PROPERTY_EXPOSURE:
                if (take(value, data, size) != ONI_STATUS_OK) return ONI_STATUS_BAD_PARAMETER;
                exposure_ = value;
                return ONI_STATUS_OK;
            default:
                return ONI_STATUS_NOT_SUPPORTED;
        }
    }

    /// Hands an image on, if the stream runs.
    template <typename Pixel>
    void send(const Image<Pixel>& image, std::int64_t stamp_us) {
        const std::lock_guard lock(mutex_);
        if (!running_ || image.empty()) return;
        OniFrame* const frame = getServices().acquireFrame();
        if (frame == nullptr) return;
        frame->dataSize = getRequiredFrameSize();
        frame->sensorType = type_;
        frame->timestamp = static_cast<std::uint64_t>(stamp_us);
        frame->frameIndex = ++frame_index_;
        frame->width = mode_.resolutionX;
        frame->height = mode_.resolutionY;
        frame->videoMode = mode_;
        frame->croppingEnabled = FALSE;
        frame->cropOriginX = frame->cropOriginY = 0;
        frame->stride = mode_.resolutionX * static_cast<int>(bytes_per_pixel());
        fill(image, static_cast<Pixel*>(frame->data));
        raiseNewFrame(frame);
        getServices().releaseFrame(frame);
    }

  private:
    static constexpr int kOwnExposure = 100;

    static float fov(int pixels, double focal_px) {
        return static_cast<float>(2 * std::atan(0.5 * pixels / focal_px));
    }
    /// Of the pixels that are sent, at the size of the input.
    const PinholeCamera& camera() const {
        const CameraInfo& both = state_.feed.camera();
        return type_ == ONI_SENSOR_COLOR || state_.is_registered() ? both.color : both.depth;
    }
    std::size_t bytes_per_pixel() const { return type_ == ONI_SENSOR_COLOR ? 3 : 2; }
    bool is_fine() const { return mode_.pixelFormat == ONI_PIXEL_FORMAT_DEPTH_100_UM; }

    static Rgb converted(Rgb pixel, bool) { return pixel; }
    static std::uint16_t converted(std::uint16_t mm, bool is_fine) {
        return is_fine ? static_cast<std::uint16_t>(mm > 6553 ? 0 : 10 * mm) : mm;
    }
    /// Every pixel of the mode takes the one of the image that it begins with.
    template <typename Pixel>
    void fill(const Image<Pixel>& image, Pixel* out) const {
        for (int v = 0; v < mode_.resolutionY; ++v) {
            const Pixel* const row = image.row(v * image.height / mode_.resolutionY);
            for (int u = 0; u < mode_.resolutionX; ++u) {
                const int from = u * image.width / mode_.resolutionX;
                *out++ = converted(row[mirror_ ? image.width - 1 - from : from], is_fine());
            }
        }
    }

    const OniSensorType type_;
    OniVideoMode mode_;
    DeviceState& state_;
    void (*const started_)(void*);
    void* const cookie_;
    std::mutex mutex_;  ///< held while a frame is handed on, so that none comes after stop()
    bool running_ = false;
    std::atomic<bool> mirror_{true};  ///< as PrimeSense's devices begin
    std::atomic<int> exposure_{0};    ///< 0: automatic
    int frame_index_ = 0;
};

/// The camera: a thread takes ticks from the feed while one of its streams runs.
class Device : public driver::DeviceBase {
  public:
    Device(const Order& order, void (*started)(void*), void* cookie)
        : state_(order), started_(started), cookie_(cookie) {
        const CameraInfo& camera = state_.feed.camera();
        depth_modes_ = modes(camera.depth, {ONI_PIXEL_FORMAT_DEPTH_1_MM, ONI_PIXEL_FORMAT_DEPTH_100_UM});
        color_modes_ = modes(camera.color, {ONI_PIXEL_FORMAT_RGB888});
        sensors_.push_back({ONI_SENSOR_DEPTH, static_cast<int>(depth_modes_.size()), depth_modes_.data()});
        if (options().color == "yes")
            sensors_.push_back(
                {ONI_SENSOR_COLOR, static_cast<int>(color_modes_.size()), color_modes_.data()});
        thread_ = std::thread([this] { run(); });
    }
    ~Device() override {
        {
            const std::lock_guard lock(mutex_);
            stop_ = true;
        }
        changed_.notify_all();
        thread_.join();
    }

    /// Nothing is streamed any more.
    void unplug() { unplugged_ = true; }

    OniStatus getSensorInfoList(OniSensorInfo** sensors, int* count) override {
        *sensors = sensors_.data();
        *count = static_cast<int>(sensors_.size());
        return ONI_STATUS_OK;
    }
    driver::StreamBase* createStream(OniSensorType type) override {
        const auto sensor = std::find_if(sensors_.begin(), sensors_.end(),
                                         [&](const OniSensorInfo& s) { return s.sensorType == type; });
        if (sensor == sensors_.end()) return nullptr;
        auto* const stream = new Stream(type, sensor->pSupportedVideoModes[0], state_, started_, cookie_);
        const std::lock_guard lock(streams_mutex_);
        (type == ONI_SENSOR_DEPTH ? depth_ : color_) = stream;
        return stream;
    }
    void destroyStream(driver::StreamBase* stream) override {
        {
            const std::lock_guard lock(streams_mutex_);
            if (stream == depth_) depth_ = nullptr;
            if (stream == color_) color_ = nullptr;
        }
        static_cast<Stream*>(stream)->stop();
        delete stream;
    }

    OniBool isPropertySupported(int id) override {
        return id == ONI_DEVICE_PROPERTY_SERIAL_NUMBER || id == ONI_DEVICE_PROPERTY_IMAGE_REGISTRATION;
    }
    OniStatus getProperty(int id, void* data, int* size) override {
        if (id == ONI_DEVICE_PROPERTY_SERIAL_NUMBER) return give_text(kSerial, data, size);
        if (id != ONI_DEVICE_PROPERTY_IMAGE_REGISTRATION) return ONI_STATUS_NOT_SUPPORTED;
        return give(
            state_.is_registered() ? ONI_IMAGE_REGISTRATION_DEPTH_TO_COLOR : ONI_IMAGE_REGISTRATION_OFF, data,
            size);
    }
    OniStatus setProperty(int id, const void* data, int size) override {
        if (id != ONI_DEVICE_PROPERTY_IMAGE_REGISTRATION) return ONI_STATUS_NOT_SUPPORTED;
        OniImageRegistrationMode mode{};
        if (take(mode, data, size) != ONI_STATUS_OK) return ONI_STATUS_BAD_PARAMETER;
        const std::string& how = options().registration;
        if (how == "refused") return ONI_STATUS_ERROR;
        const bool is_done = how == "works" || (how == "late" && state_.running > 0);
        if (is_done) state_.registration = mode == ONI_IMAGE_REGISTRATION_DEPTH_TO_COLOR;
        return ONI_STATUS_OK;
    }
    OniBool isImageRegistrationModeSupported(OniImageRegistrationMode) override { return TRUE; }

  private:
    const Options& options() const { return state_.feed.options(); }

    std::vector<OniVideoMode> modes(const PinholeCamera& camera,
                                    const std::vector<OniPixelFormat>& formats) const {
        std::vector<OniVideoMode> all;
        for (const int size : {1, 2}) {
            for (const OniPixelFormat format : formats) {
                if (camera.width % size == 0 && camera.height % size == 0)
                    all.push_back({format, camera.width / size, camera.height / size,
                                   static_cast<int>(std::lround(options().rate_hz))});
            }
        }
        return all;
    }

    void run() {
        try {
            stream();
        } catch (const std::exception& error) {  // must not leave through OpenNI2, and is not swallowed
            say(error.what());
        }
    }
    void stream() {
        std::unique_lock lock(mutex_);
        Clock::time_point start{};
        for (Tick tick; !stop_;) {
            if (state_.running == 0) {
                changed_.wait_for(lock, std::chrono::milliseconds(20));
                continue;
            }
            lock.unlock();
            const bool more = state_.feed.next(tick);
            lock.lock();
            if (!more) return;
            if (start == Clock::time_point{}) start = Clock::now() - std::chrono::microseconds(tick.due_us);
            changed_.wait_until(lock, start + std::chrono::microseconds(tick.due_us), [&] { return stop_; });
            const bool is_frozen =
                options().freeze_s > 0 && static_cast<double>(tick.due_us) > 1e6 * options().freeze_s;
            if (stop_ || unplugged_ || is_frozen) continue;
            lock.unlock();
            send(tick);
            lock.lock();
        }
    }
    void send(const Tick& tick) {
        const bool registers = state_.registration && !state_.feed.camera().registered && !tick.depth.empty();
        const DepthImage registered =
            registers ? register_depth(tick.depth, state_.feed.camera()) : DepthImage();
        const std::lock_guard lock(streams_mutex_);
        if (depth_ != nullptr) depth_->send(registers ? registered : tick.depth, tick.depth_us);
        if (color_ != nullptr) color_->send(tick.color, tick.color_us);
    }

    DeviceState state_;
    void (*const started_)(void*);
    void* const cookie_;
    std::vector<OniVideoMode> depth_modes_, color_modes_;
    std::vector<OniSensorInfo> sensors_;
    std::mutex streams_mutex_;
    Stream *depth_ = nullptr, *color_ = nullptr;
    std::atomic<bool> unplugged_{false};
    std::mutex mutex_;
    std::condition_variable changed_;
    bool stop_ = false;
    std::thread thread_;
};

/// The driver of the one device, which comes and goes as ordered.
class Driver : public driver::DriverBase {
  public:
    using DriverBase::DriverBase;

    OniStatus initialize(driver::DeviceConnectedCallback connected,
                         driver::DeviceDisconnectedCallback disconnected,
                         driver::DeviceStateChangedCallback changed, void* cookie) override {
        DriverBase::initialize(connected, disconnected, changed, cookie);
        const char* const order = std::getenv(kOrderVariable);
        if (order == nullptr) return ONI_STATUS_OK;  // no device: nobody ordered one
        try {
            order_ = read_order(order);
        } catch (const std::exception& error) {
            say(error.what());
            return ONI_STATUS_ERROR;
        }
        std::snprintf(info_.uri, sizeof(info_.uri), "%s", kUri);
        std::snprintf(info_.vendor, sizeof(info_.vendor), "planemap");
        std::snprintf(info_.name, sizeof(info_.name), "virtual camera");
        plug_in();
        return ONI_STATUS_OK;
    }
    driver::DeviceBase* deviceOpen(const char*, const char*) override {
        const std::lock_guard lock(mutex_);
        if (!plugged_ || device_ != nullptr) return nullptr;
        try {
            device_ = new Device(order_, &Driver::on_start, this);
            order_.options.freeze_s = 0;  // opening it again is what helps
        } catch (const std::exception& error) {
            say(error.what());
        }
        return device_;
    }
    void deviceClose(driver::DeviceBase* device) override {
        {
            const std::lock_guard lock(mutex_);
            if (device == device_) device_ = nullptr;
        }
        delete device;
    }
    void shutdown() override {
        {
            const std::lock_guard lock(mutex_);
            stop_ = true;
        }
        changed_.notify_all();
        if (events_.joinable()) events_.join();
    }
    OniStatus tryDevice(const char* uri) override {
        return plugged_ && std::strcmp(uri, kUri) == 0 ? ONI_STATUS_OK : ONI_STATUS_ERROR;
    }
    void* enableFrameSync(driver::StreamBase**, int) override { return this; }
    void disableFrameSync(void*) override {}

  private:
    void plug_in() {
        plugged_ = true;
        deviceConnected(&info_);
    }
    /// The first start of a stream begins the time that unplug_s counts from.
    static void on_start(void* cookie) {
        auto* const self = static_cast<Driver*>(cookie);
        self->started();
    }
    void started() {
        const std::lock_guard lock(mutex_);
        if (order_.options.unplug_s > 0 && !events_.joinable())
            events_ = std::thread([this] { come_and_go(); });
    }
    void come_and_go() {
        const auto sleep = [this](double seconds) {
            std::unique_lock lock(mutex_);
            return !changed_.wait_for(lock, std::chrono::duration<double>(seconds), [&] { return stop_; });
        };
        if (!sleep(order_.options.unplug_s)) return;
        {
            const std::lock_guard lock(mutex_);
            plugged_ = false;
            if (device_ != nullptr) device_->unplug();
        }
        deviceDisconnected(&info_);
        if (order_.options.back_s > 0 && sleep(order_.options.back_s)) plug_in();
    }

    Order order_;
    OniDeviceInfo info_{};
    std::atomic<bool> plugged_{false};
    std::mutex mutex_;
    std::condition_variable changed_;
    Device* device_ = nullptr;  ///< OpenNI2's, which closes it
    bool stop_ = false;
    std::thread events_;
};

}  // namespace
}  // namespace planemap::virtual_camera

ONI_EXPORT_DRIVER(planemap::virtual_camera::Driver)
