// SPDX-License-Identifier: BSD-3-Clause
#include "sensor/accelerometer_file.hpp"

#include <algorithm>
#include <sstream>
#include <stdexcept>
#include <string>

#include "core/stamp.hpp"
#include "core/text_file.hpp"

namespace planemap::sensor {

namespace {

constexpr double kMost = 1000;  // m/s2

Acceleration read_line(const std::string& line, StampColumn& stamps) {
    std::istringstream words(line);
    std::string stamp;
    Acceleration reading;
    words >> stamp;
    Eigen::Vector3d& a = reading.acceleration_camera;
    if (!(words >> a.x() >> a.y() >> a.z()) || !(a.norm() <= kMost))
        throw std::runtime_error("expected `timestamp ax ay az`, not \"" + shown_text(line) + "\"");
    reading.utime = stamps.read(stamp);
    return reading;
}

}  // namespace

std::vector<Acceleration> read_accelerometer_file(const std::filesystem::path& file,
                                                  const Eigen::Matrix3d& camera_from_accelerometer) {
    std::istringstream text(read_text_file(file));
    std::vector<Acceleration> readings;
    StampColumn stamps;
    int number = 0;
    for (std::string line; std::getline(text, line);) {
        ++number;
        std::replace(line.begin(), line.end(), ',', ' ');
        const std::size_t first = line.find_first_not_of(" \t\r\v\f");
        if (first == std::string::npos || line[first] == '#') continue;
        try {
            readings.push_back(read_line(line, stamps));
        } catch (const std::runtime_error& error) {
            throw std::runtime_error(file.string() + ":" + std::to_string(number) + ": " + error.what());
        }
        readings.back().acceleration_camera = camera_from_accelerometer * readings.back().acceleration_camera;
    }
    std::stable_sort(readings.begin(), readings.end(),
                     [](const Acceleration& a, const Acceleration& b) { return a.utime < b.utime; });
    return readings;
}

}  // namespace planemap::sensor
