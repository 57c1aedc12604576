// SPDX-License-Identifier: BSD-3-Clause
#include "map/map_output.hpp"

#include <spdlog/spdlog.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <stdexcept>
#include <system_error>
#include <vector>

#include "core/components.hpp"
#include "map/earlier_map.hpp"
#include "map/map_file.hpp"
#include "messages/bus.hpp"

namespace planemap::map {

namespace {

constexpr std::int64_t kWritePeriodUs = 5000000;
constexpr std::int64_t kTimesTheCost = 50;        // of a write, until the next one
constexpr std::int64_t kRetryPeriodUs = 1000000;  // after a write that failed
constexpr std::int64_t kSeenSpaceUs = 500000;     // to find what was seen to be empty: a stop waits for it
constexpr const char* kFile = "plane_map.lcmlog";

/// Whether an error says that a disk has no room or fails, which may pass, and not that a path is wrong.
bool is_disk_trouble(const std::error_code& error) {
    for (const int trouble : {ENOSPC, EDQUOT, EFBIG, EIO, ESTALE, ENOMEM})
        if (error.value() == trouble) return true;
    return false;
}

void make_folder(const std::filesystem::path& folder) {
    std::error_code error;
    std::filesystem::create_directories(folder, error);
    if (error) throw std::system_error(error, folder.string() + ": cannot be made");
}

}  // namespace

std::filesystem::path MapOutput::file() const {
    return folder_ / kFile;
}

bool MapOutput::poll(const ComponentMaps& maps) {
    const std::int64_t period =
        error_.empty() ? std::max(kWritePeriodUs, kTimesTheCost * write_cost_us_) : kRetryPeriodUs;
    return messages::now_us() - last_write_us_ >= period && finish(maps);
}

bool MapOutput::finish(const ComponentMaps& maps) {
    if (!is_unwritten_ || folder_.empty()) return false;
    try_write(maps);
    return true;
}

/// A folder that cannot be one shows now, not after the run; a disk that is full now may have room later.
void MapOutput::open(const ComponentMaps& maps) {
    if (folder_.empty()) return;
    std::error_code ignored;
    if (std::filesystem::is_directory(file(), ignored))
        throw std::runtime_error(file().string() + ": is a folder, where the map is to go");
    try {
        make_folder(folder_);
        if (!std::filesystem::exists(file())) write(maps);
    } catch (const std::system_error& error) {
        if (!is_disk_trouble(error.code())) throw;
        is_unwritten_ = true;
        fail(error.what());
        return;
    }
    if (::access(folder_.c_str(), W_OK) != 0)
        throw std::runtime_error(folder_.string() + ": is no folder that can be written to");
}

/// A disk that is full or gone ends nothing: the map is kept, said not to be written, and tried again.
void MapOutput::try_write(const ComponentMaps& maps) {
    const bool failed_before = !error_.empty();
    try {
        write(maps);
        error_.clear();
        if (failed_before) spdlog::info("{} is written again", file().string());
    } catch (const std::exception& error) {
        fail(error.what());
    }
}

void MapOutput::fail(const std::string& why) {
    if (error_.empty()) spdlog::warn("{}; the map is kept, trying every second", why);
    error_ = why;
    last_write_us_ = messages::now_us();
}

/// The largest under its name, others beside it; of these what an earlier process left goes.
void MapOutput::write(const ComponentMaps& maps) {
    const std::int64_t start = messages::now_us();
    make_folder(folder_);  // somebody may have removed it
    const std::vector<const PlaneMapper*> all = maps.all();
    const auto has_time = [&] { return messages::now_us() - start < kSeenSpaceUs; };
    for (std::size_t number = 1; number <= kMostComponentFiles; ++number) {
        if (number == 1 && !make_way(maps)) break;
        const std::filesystem::path path = folder_ / component_file(kFile, number);
        std::error_code ignored;
        if (number <= all.size())
            write_plane_map(path, all[number - 1]->map(), all[number - 1]->seen_space(has_time));
        else
            std::filesystem::remove(path, ignored);
    }
    last_write_us_ = messages::now_us();
    write_cost_us_ = last_write_us_ - start;
    is_unwritten_ = false;
}

/// Keeps what an earlier process left, under another name. False while there is nothing to write that is
/// worth as much.
bool MapOutput::make_way(const ComponentMaps& maps) {
    if (is_ours_ || !may_hold_planes(file())) return is_ours_ = true;
    if (maps.largest().map().planes.empty()) return false;
    const KeptMap kept = keep_earlier_map(file());
    spdlog::info("the earlier map is kept as {}", kept.file.string());
    for (const std::filesystem::path& removed : kept.removed)
        spdlog::info("{}: removed, the newest of its kind are kept", removed.string());
    return is_ours_ = true;
}

}  // namespace planemap::map
