// SPDX-License-Identifier: BSD-3-Clause
#include "simulate/recording.hpp"

#include "messages/log.hpp"

namespace planemap {

std::int64_t record(SensorShell& sensor, Bus& bus, std::int64_t max_frames, const std::filesystem::path& log,
                    const std::function<void(std::int64_t frames)>& on_frame) {
    const std::filesystem::path beside = log.string() + ".part";
    LogWriter writer(beside);
    std::int64_t events = 0, bytes = 0;
    bus.subscribe(".*", [&](const RawMessage& message) {
        LogEvent event{events++,
                       sensor.last_utime(),
                       std::string(message.channel),
                       {message.bytes.begin(), message.bytes.end()}};
        bytes += static_cast<std::int64_t>(event.bytes.size());
        writer.write(event);
    });
    while (!stop_requested() && (max_frames == 0 || sensor.frames() < max_frames) && sensor.poll() >= 0) {
        bus.drain();
        on_frame(sensor.frames());
    }
    writer.close();
    std::filesystem::rename(beside, log);
    return bytes;
}

}  // namespace planemap
