// SPDX-License-Identifier: BSD-3-Clause
// The input as a ROS 1 bag: every message that its reader gives, and then the frames.
#include <bzlib.h>
#include <lz4frame.h>

#include <stdexcept>

#include "convert/bag_reader.hpp"
#include "convert/bag_source.hpp"
#include "convert/ros_bytes.hpp"
#include "fuzz/fuzz.hpp"

namespace planemap::fuzz {

namespace {

using convert::RosBytes;

constexpr std::uint32_t kWidth = 8, kHeight = 6;
constexpr std::int64_t kStart = 1600000000000000;

void read_messages(const std::filesystem::path& file, std::size_t file_size) {
    convert::BagReader bag(file);
    std::vector<std::string> topics;
    for (const auto& [topic, type] : bag.types()) topics.push_back(topic);
    bag.select(topics);
    std::size_t count = 0;
    for (convert::BagMessage message; bag.next(message); ++count)
        require(bag.types().count(message.topic) == 1, "a message's topic is one of the bag's");
    require(count <= bag.size() && bag.size() <= file_size, "messages are no more than there is room for");
    bag.complaints();
}

void read_frames(const std::filesystem::path& file) {
    const std::unique_ptr<FrameSource> source = convert::open_bag(file, {});
    const CameraInfo& camera = source->camera();
    SensorFrame frame;
    for (ReadResult result = source->next(frame); result.status != ReadResult::Status::kEnd;
         result = source->next(frame)) {
        const bool is_frame = result.status == ReadResult::Status::kFrame;
        require(is_frame != frame.depth.empty(), "a frame has depth, and what is none has not");
        require(!is_frame || frame.depth.width == camera.depth.width, "depth has the camera's size");
        require(frame.color.empty() || frame.color.height == camera.color.height, "and so has colour");
    }
    source->complaints();
}

/// A bag's bytes, of records with "name=value" fields before their data.
class Bag {
  public:
    using Fields = std::vector<std::pair<std::string, std::string>>;

    template <typename T>
    static std::string number(T value) {
        return {reinterpret_cast<const char*>(&value), sizeof(T)};
    }
    static std::string sized(const std::string& bytes) {
        return number(static_cast<std::uint32_t>(bytes.size())) + bytes;
    }
    static std::string record(char op, const Fields& fields, const std::string& data) {
        return sized(header({{"op", std::string(1, op)}}) + header(fields)) + sized(data);
    }
    static std::string header(const Fields& fields) {
        std::string bytes;
        for (const auto& [name, value] : fields) bytes += sized(name + "=" + value);
        return bytes;
    }

    void add(const std::string& topic, std::int64_t utime, const RosBytes& message) {
        const std::string connection = number(connections_++);
        const std::string time = number(static_cast<std::uint32_t>(utime / 1000000)) +
                                 number(static_cast<std::uint32_t>(utime % 1000000 * 1000));
        records_ += record(7, {{"conn", connection}, {"topic", topic}}, header({{"type", message.type()}}));
        index_ += record(4, {{"ver", number(1)}, {"conn", connection}, {"count", number(1)}},
                         time + number(static_cast<std::uint32_t>(records_.size())));
        records_ += record(2, {{"conn", connection}, {"time", time}},
                           {message.bytes().begin(), message.bytes().end()});
    }
    std::string text(const std::string& compression, const std::string& stored, bool with_index) const {
        return "#ROSBAG V2.0\n" + record(3, {{"index_pos", std::string(8, '\0')}}, "") +
               record(5,
                      {{"compression", compression},
                       {"size", number(static_cast<std::uint32_t>(records_.size()))}},
                      stored) +
               (with_index ? index_ : "");
    }
    const std::string& records() const { return records_; }

  private:
    std::string records_, index_;
    std::uint32_t connections_ = 0;
};

std::string bz2(std::string bytes) {
    std::string out(bytes.size() + 1000, '\0');
    auto size = static_cast<unsigned>(out.size());
    require(BZ2_bzBuffToBuffCompress(out.data(), &size, bytes.data(), static_cast<unsigned>(bytes.size()), 1,
                                     0, 0) == BZ_OK,
            "a seed can be compressed");
    out.resize(size);
    return out;
}

std::string lz4(const std::string& bytes) {
    std::string out(LZ4F_compressFrameBound(bytes.size(), nullptr), '\0');
    const std::size_t size = LZ4F_compressFrame(out.data(), out.size(), bytes.data(), bytes.size(), nullptr);
    require(LZ4F_isError(size) == 0, "a seed can be compressed");
    out.resize(size);
    return out;
}

RosBytes raw(const std::string& encoding, std::uint32_t bytes_per_pixel) {
    return convert::image(kStart, "optical", kWidth, kHeight, encoding, bytes_per_pixel * kWidth,
                          std::vector<std::uint8_t>(std::size_t{kHeight} * kWidth * bytes_per_pixel, 4));
}

Bag driver() {
    Bag bag;
    bag.add("/d/camera_info", kStart, convert::camera_info(kWidth, kHeight, 9));
    bag.add("/c/camera_info", kStart, convert::camera_info(kWidth, kHeight, 9));
    bag.add("/d/image", kStart, raw("16UC1", 2));
    bag.add("/c/image", kStart, raw("bgr8", 3));
    return bag;
}

Bag realsense() {
    const std::string depth = "/device_0/sensor_0/Depth_0", color = "/device_0/sensor_1/Color_0";
    Bag bag;
    for (const std::string& stream : {depth, color}) {
        bag.add(stream + "/info/camera_info", kStart, convert::camera_info(kWidth, kHeight, 9));
        bag.add(stream + "/tf/0", kStart,
                RosBytes("geometry_msgs/Transform").numbers({0.01, 0, 0, 0, 0, 0, 1}));
    }
    bag.add("/device_0/sensor_0/option/Depth_Units/value", kStart,
            RosBytes("std_msgs/Float32").number(1e-3F));
    bag.add("/device_0/info", kStart, RosBytes("diagnostic_msgs/KeyValue").text("Serial Number").text("7"));
    bag.add(depth + "/image/data", kStart, raw("mono16", 2));
    bag.add(color + "/image/data", kStart, raw("rgb8", 3));
    return bag;
}

}  // namespace

void fuzz(Bytes bytes) {
    const MemoryFile file(bytes);
    try {
        read_messages(file.path(), bytes.size());
        read_frames(file.path());
    } catch (const std::runtime_error&) {
    }
}

std::vector<std::string> seeds() {
    const Bag d = driver(), r = realsense();
    return {d.text("none", d.records(), true), d.text("none", d.records(), false),
            d.text("bz2", bz2(d.records()), true), d.text("lz4", lz4(d.records()), true),
            r.text("none", r.records(), true)};
}

}  // namespace planemap::fuzz
