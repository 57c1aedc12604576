// SPDX-License-Identifier: BSD-3-Clause
#include "sensor/position_file.hpp"

#include <spdlog/spdlog.h>

#include <fstream>
#include <iomanip>
#include <sstream>
#include <system_error>

#include "core/files.hpp"
#include "core/stamp.hpp"

namespace planemap::sensor {

std::optional<std::int64_t> PositionFile::read() const {
    std::error_code ignored;
    if (file_.empty() || !std::filesystem::exists(file_, ignored)) return std::nullopt;
    std::istringstream text(read_file(file_, 64));
    std::int64_t utime = 0;
    if (!(text >> utime)) {  // a power cut while it was written
        spdlog::warn("{}: holds no time stamp; playing from the beginning", file_.string());
        return std::nullopt;
    }
    spdlog::info("goes on after the frame at {}", seconds_text(utime));
    return utime;
}

bool PositionFile::keep(std::int64_t utime, std::int64_t now_us) {
    constexpr std::int64_t kKeepPeriod_us = 100000;
    if (file_.empty() || now_us - kept_us_ < kKeepPeriod_us) return true;
    kept_us_ = now_us;
    std::ofstream(file_, std::ios::app).close();  // it is there
    std::fstream file(file_, std::ios::in | std::ios::out);
    file << std::setw(20) << utime << "\n";  // over the last one, in one write: never half of it
    file.close();
    return static_cast<bool>(file);
}

void PositionFile::remove() const {
    std::error_code ignored;
    if (!file_.empty()) std::filesystem::remove(file_, ignored);
}

}  // namespace planemap::sensor
