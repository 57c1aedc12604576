// SPDX-License-Identifier: BSD-3-Clause
#include "convert/tum_folder.hpp"

#include <cstdio>
#include <set>
#include <stdexcept>
#include <string>

#include "core/camera_file.hpp"
#include "core/files.hpp"
#include "results/new_file.hpp"
#include "sensor/png.hpp"

namespace planemap::convert {

namespace fs = std::filesystem;

namespace {

std::string stamp_text(std::int64_t utime) {
    char text[40];
    const std::int64_t size = utime < 0 ? -utime : utime;
    std::snprintf(text, sizeof(text), "%s%lld.%06lld", utime < 0 ? "-" : "",
                  static_cast<long long>(size / 1000000), static_cast<long long>(size % 1000000));
    return text;
}

class Writer {
  public:
    Writer(const fs::path& folder, const CameraInfo& camera) : folder_(folder) {
        write_file(folder_ / "camera.json", camera_file_text(camera));
    }

    /// False for a stamp that was there.
    bool write(const SensorFrame& frame) {
        for (const Acceleration& reading : frame.accelerations) write_acceleration(reading);
        if (!stamps_.insert(frame.utime).second) return false;
        const std::string stamp = stamp_text(frame.utime), file = "depth/" + stamp + ".png";
        sensor::write_depth_png(folder_ / file, frame.depth);
        depth_list_ += stamp + " " + file + "\n";
        const bool has_color = !frame.color_jpeg.empty() || !frame.color.empty();
        if (has_color && color_stamps_.insert(frame.color_utime).second)
            write_color(frame, stamp + " " + file);
        return true;
    }
    /// The lists. A frame without colour has none in associations.txt, which would leave it out: where there
    /// is such a frame the lists are paired anew by who reads them.
    void finish() {
        write_file(folder_ / "depth.txt", "# timestamp filename\n" + depth_list_);
        if (!accelerations_.empty())
            write_file(folder_ / "accelerometer.txt", "# timestamp ax ay az\n" + accelerations_);
        if (color_stamps_.empty()) return;
        write_file(folder_ / "rgb.txt", "# timestamp filename\n" + color_list_);
        if (color_stamps_.size() == stamps_.size()) write_file(folder_ / "associations.txt", pairs_);
    }

  private:
    void write_color(const SensorFrame& frame, const std::string& depth) {
        fs::create_directories(folder_ / "rgb");
        const std::string stamp = stamp_text(frame.color_utime);
        const bool is_jpeg = !frame.color_jpeg.empty();
        const std::string file = "rgb/" + stamp + (is_jpeg ? ".jpg" : ".png");
        if (is_jpeg) {
            write_file(folder_ / file,
                       {reinterpret_cast<const char*>(frame.color_jpeg.data()), frame.color_jpeg.size()});
        } else {
            sensor::write_color_png(folder_ / file, frame.color);
        }
        color_list_ += stamp + " " + file + "\n";
        pairs_ += depth + " " + stamp + " " + file + "\n";
    }

    /// In the axes that are assumed where camera.json says nothing of them.
    void write_acceleration(const Acceleration& reading) {
        const Eigen::Vector3d a = camera_from_accelerometer({}).transpose() * reading.acceleration_camera;
        char text[120];
        std::snprintf(text, sizeof(text), " %.9g %.9g %.9g\n", a.x(), a.y(), a.z());
        accelerations_ += stamp_text(reading.utime) + text;
    }

    fs::path folder_;
    std::string accelerations_;
    std::string depth_list_, color_list_, pairs_;
    std::set<std::int64_t> stamps_, color_stamps_;
};

}  // namespace

TumFolder write_tum_folder(FrameSource& source, const Trajectory& truth, const fs::path& folder,
                           const std::function<bool(std::int64_t)>& go_on,
                           const std::function<void(const std::string&)>& say) {
    NewFolder target(folder);
    fs::create_directories(target.part() / "depth");
    Writer writer(target.part(), source.camera());
    TumFolder written;
    std::set<std::string> said;
    SensorFrame frame;
    for (ReadResult result = source.next(frame); result.status != ReadResult::Status::kEnd;
         result = source.next(frame)) {
        if (!result.message.empty() && said.insert(result.reason).second) say(result.message);
        if (result.status == ReadResult::Status::kBroken) {
            ++written.broken;
        } else if (!writer.write(frame)) {
            ++written.repeated;
        } else {
            ++written.frames;
            written.colorless += result.color_left_out;
        }
        if (!go_on(written.frames))
            throw std::runtime_error(folder.string() + ": stopped; nothing was written");
    }
    if (written.frames == 0) {
        throw std::runtime_error(folder.string() + ": nothing was written: none of the " +
                                 std::to_string(written.broken) + " frames could be read");
    }
    writer.finish();
    if (!truth.empty()) write_trajectory(target.part() / "groundtruth.txt", truth);
    target.put_in_place();
    return written;
}

}  // namespace planemap::convert
