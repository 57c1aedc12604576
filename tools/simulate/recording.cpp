// SPDX-License-Identifier: BSD-3-Clause
#include "simulate/recording.hpp"

#include <exception>

#include "messages/log.hpp"

namespace planemap {

namespace {

/// Writes what a bus delivers. An error stays here until it is asked for: thrown in a handler, the bus would
/// count it as one bad message.
class Recorder {
  public:
    Recorder(const sensor::SensorShell& sensor, messages::Bus& bus, const std::filesystem::path& log)
        : sensor_(sensor), writer_(log) {
        bus.subscribe(".*", [this](const messages::RawMessage& message) { write(message); });
    }
    std::int64_t bytes() const { return bytes_; }
    void throw_if_failed() const {
        if (error_) std::rethrow_exception(error_);
    }
    void close() { writer_.close(); }

  private:
    void write(const messages::RawMessage& message) {
        if (error_) return;
        try {
            writer_.write({events_++,
                           sensor_.last_utime(),
                           std::string(message.channel),
                           {message.bytes.begin(), message.bytes.end()}});
            bytes_ += static_cast<std::int64_t>(message.bytes.size());
        } catch (...) {
            error_ = std::current_exception();
        }
    }

    const sensor::SensorShell& sensor_;
    messages::LogWriter writer_;
    std::int64_t events_ = 0, bytes_ = 0;
    std::exception_ptr error_;
};

}  // namespace

std::int64_t record(sensor::SensorShell& sensor, messages::Bus& bus, std::int64_t max_frames,
                    const std::filesystem::path& log,
                    const std::function<void(std::int64_t frames)>& on_frame,
                    const std::function<void()>& at_end) {
    Recorder recorder(sensor, bus, log);
    try {
        while (!messages::stop_requested() && (max_frames == 0 || sensor.frames() < max_frames) &&
               sensor.poll() >= 0) {
            bus.drain();
            recorder.throw_if_failed();
            on_frame(sensor.frames());
        }
        if (at_end) at_end();
        bus.drain();
        recorder.throw_if_failed();
        recorder.close();
    } catch (...) {
        std::error_code ignored;
        std::filesystem::remove(log, ignored);
        throw;
    }
    return recorder.bytes();
}

std::int64_t record(std::unique_ptr<FrameSource> source, std::int64_t max_frames,
                    const std::filesystem::path& log,
                    const std::function<void(std::int64_t frames)>& on_frame) {
    messages::Bus bus("memq://");
    sensor::SensorShellOptions options;
    options.speed = 0;
    sensor::SensorShell sensor(bus, std::move(source), options);
    return record(sensor, bus, max_frames, log, on_frame);
}

}  // namespace planemap
