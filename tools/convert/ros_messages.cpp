// SPDX-License-Identifier: BSD-3-Clause
#include "convert/ros_messages.hpp"

#include <cmath>
#include <cstring>
#include <stdexcept>

namespace planemap::convert {

namespace {

class Bytes {
  public:
    explicit Bytes(std::span<const std::uint8_t> bytes) : left_(bytes) {}

    std::size_t left() const { return left_.size(); }
    std::span<const std::uint8_t> take(std::size_t count) {
        if (count > left_.size()) {
            throw std::runtime_error("a message is cut short: " + std::to_string(count) +
                                     " bytes are to come, " + std::to_string(left_.size()) + " are there");
        }
        const auto taken = left_.first(count);
        left_ = left_.subspan(count);
        return taken;
    }
    template <typename T>
    T number() {
        T value;
        std::memcpy(&value, take(sizeof(T)).data(), sizeof(T));
        return value;
    }
    std::span<const std::uint8_t> sized() { return take(number<std::uint32_t>()); }
    std::string text() {
        const auto bytes = sized();
        return {bytes.begin(), bytes.end()};
    }
    RosHeader header() {
        number<std::uint32_t>();  // seq
        const std::int64_t seconds = number<std::uint32_t>(), nanoseconds = number<std::uint32_t>();
        return {seconds * 1000000 + (nanoseconds + 500) / 1000, text()};
    }
    Pose transform() {
        double v[7];
        for (double& value : v) value = number<double>();
        const Eigen::Vector3d translation(v[0], v[1], v[2]);
        const Eigen::Quaterniond rotation(v[6], v[3], v[4], v[5]);
        if (!translation.allFinite() || !(std::abs(rotation.norm() - 1) < 0.01))
            throw std::runtime_error("a transform is none");
        return make_pose(translation, rotation.normalized());
    }

  private:
    std::span<const std::uint8_t> left_;
};

}  // namespace

RosImage read_image(std::span<const std::uint8_t> bytes) {
    Bytes in(bytes);
    RosImage image;
    image.header = in.header();
    image.height = in.number<std::uint32_t>();
    image.width = in.number<std::uint32_t>();
    image.encoding = in.text();
    image.is_bigendian = in.number<std::uint8_t>() != 0;
    image.step = in.number<std::uint32_t>();
    image.data = in.sized();
    if (image.header.frame_id == "1" && in.left() >= sizeof(float)) image.depth_unit_m = in.number<float>();
    return image;
}

RosCompressedImage read_compressed_image(std::span<const std::uint8_t> bytes) {
    Bytes in(bytes);
    RosCompressedImage image;
    image.header = in.header();
    image.format = in.text();
    image.data = in.sized();
    return image;
}

RosCameraInfo read_camera_info(std::span<const std::uint8_t> bytes) {
    Bytes in(bytes);
    RosCameraInfo info;
    in.header();
    info.height = in.number<std::uint32_t>();
    info.width = in.number<std::uint32_t>();
    info.distortion_model = in.text();
    const std::uint32_t count = in.number<std::uint32_t>();
    Bytes distortion(in.take(std::size_t{count} * sizeof(double)));
    for (std::uint32_t i = 0; i < count; ++i) info.D.push_back(distortion.number<double>());
    for (double& value : info.K) value = in.number<double>();
    in.take(9 * sizeof(double));  // R
    for (double& value : info.P) value = in.number<double>();
    return info;
}

Pose read_transform(std::span<const std::uint8_t> bytes) {
    return Bytes(bytes).transform();
}

std::vector<RosTransform> read_transforms(std::span<const std::uint8_t> bytes) {
    Bytes in(bytes);
    std::vector<RosTransform> transforms;
    for (std::uint32_t left = in.number<std::uint32_t>(); left > 0; --left) {
        RosTransform transform;
        transform.frame = in.header().frame_id;
        transform.child_frame = in.text();
        transform.frame_from_child = in.transform();
        transforms.push_back(std::move(transform));
    }
    return transforms;
}

float read_float(std::span<const std::uint8_t> bytes) {
    return Bytes(bytes).number<float>();
}

std::pair<std::string, std::string> read_key_value(std::span<const std::uint8_t> bytes) {
    Bytes in(bytes);
    std::string key = in.text();
    return {std::move(key), in.text()};
}

}  // namespace planemap::convert
