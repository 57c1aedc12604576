// SPDX-License-Identifier: BSD-3-Clause
// ROS messages as their bytes, written by hand: what the bags of the tests and of the fuzzing harness hold.
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

namespace planemap::convert {

/// A message's bytes as ROS serialises them.
class RosBytes {
  public:
    RosBytes() = default;
    RosBytes(std::string type) : type_(std::move(type)) {}
    template <typename T>
    RosBytes& number(T value) {
        const auto* bytes = reinterpret_cast<const std::uint8_t*>(&value);
        bytes_.insert(bytes_.end(), bytes, bytes + sizeof(T));
        return *this;
    }
    RosBytes& numbers(const std::vector<double>& values) {
        for (const double value : values) number(value);
        return *this;
    }
    RosBytes& data(const std::vector<std::uint8_t>& bytes) {
        number(static_cast<std::uint32_t>(bytes.size()));
        bytes_.insert(bytes_.end(), bytes.begin(), bytes.end());
        return *this;
    }
    RosBytes& text(const std::string& text) { return data({text.begin(), text.end()}); }
    RosBytes& header(std::int64_t utime, const std::string& frame) {
        number(std::uint32_t{7}).number(static_cast<std::uint32_t>(utime / 1000000));
        return number(static_cast<std::uint32_t>(utime % 1000000 * 1000)).text(frame);
    }
    const std::string& type() const { return type_; }
    const std::vector<std::uint8_t>& bytes() const { return bytes_; }

  private:
    std::string type_;
    std::vector<std::uint8_t> bytes_;
};

inline RosBytes image(std::int64_t utime, const std::string& frame, std::uint32_t width, std::uint32_t height,
                      const std::string& encoding, std::uint32_t step,
                      const std::vector<std::uint8_t>& data) {
    return RosBytes("sensor_msgs/Image")
        .header(utime, frame)
        .number(height)
        .number(width)
        .text(encoding)
        .number(std::uint8_t{0})
        .number(step)
        .data(data);
}

inline RosBytes camera_info(std::uint32_t width, std::uint32_t height, double f,
                            const std::string& model = "plumb_bob", const std::vector<double>& lens = {}) {
    RosBytes info("sensor_msgs/CameraInfo");
    info.header(1, "optical").number(height).number(width).text(model);
    info.number(static_cast<std::uint32_t>(lens.size())).numbers(lens);
    info.numbers({f, 0, width / 2.0, 0, f, height / 2.0, 0, 0, 1});
    return info.numbers(std::vector<double>(9)).numbers(std::vector<double>(12));
}

}  // namespace planemap::convert
