// SPDX-License-Identifier: BSD-3-Clause
// The input as each of the ROS messages that are read from bags, and the pixels of those that are images.
#include <stdexcept>

#include "convert/pixels.hpp"
#include "convert/ros_bytes.hpp"
#include "convert/ros_messages.hpp"
#include "fuzz/fuzz.hpp"
#include "messages/image_codec.hpp"

namespace planemap::fuzz {

namespace {

using convert::RosBytes;

constexpr int kWidth = 8, kHeight = 6;
const PinholeCamera kCamera{kWidth, kHeight, 9, 9, 4, 3};

template <typename Read>
void attempt(const Read& read) {
    try {
        read();
    } catch (const std::runtime_error&) {
    }
}

void read_raw(Bytes bytes) {
    const convert::RosImage image = convert::read_image(bytes);
    const convert::RawImage raw{kWidth, kHeight, image.step, image.is_bigendian, image.encoding, image.data};
    attempt([&] { require(convert::depth_of(raw, kCamera).width == kWidth, "depth has the camera's size"); });
    attempt([&] { require(convert::color_of(raw, kCamera).height == kHeight, "colour, too"); });
}

void read_compressed(Bytes bytes) {
    const convert::RosCompressedImage image = convert::read_compressed_image(bytes);
    attempt([&] {
        require(convert::depth_of_compressed(image.format, image.data, kCamera).width == kWidth,
                "depth has the camera's size");
    });
    attempt([&] {
        SensorFrame frame;
        convert::read_compressed_color(image.data, kCamera, frame);
        require(frame.color.empty() != frame.color_jpeg.empty(), "it is either a JPEG or pixels");
    });
}

std::string seed(const RosBytes& message) {
    return {message.bytes().begin(), message.bytes().end()};
}

std::string raw(const std::string& encoding, std::uint32_t bytes_per_pixel) {
    return seed(
        convert::image(7000000, "optical", kWidth, kHeight, encoding, bytes_per_pixel * kWidth,
                       std::vector<std::uint8_t>(std::size_t{kHeight} * kWidth * bytes_per_pixel, 130)));
}

}  // namespace

void fuzz(Bytes bytes) {
    attempt([&] { read_raw(bytes); });
    attempt([&] { read_compressed(bytes); });
    attempt([&] { convert::read_camera_info(bytes); });
    attempt([&] { convert::read_transform(bytes); });
    attempt([&] { convert::read_transforms(bytes); });
    attempt([&] { convert::read_float(bytes); });
    attempt([&] { convert::read_key_value(bytes); });
}

std::vector<std::string> seeds() {
    const RosBytes compressed = RosBytes()
                                    .header(7000000, "optical")
                                    .text("bgr8; jpeg compressed bgr8")
                                    .data(messages::encode_jpeg(RgbImage(kWidth, kHeight, {9, 9, 9}), 90));
    return {raw("16UC1", 2),
            raw("32FC1", 4),
            raw("rgb8", 3),
            raw("bayer_rggb8", 1),
            raw("yuv422", 2),
            seed(compressed),
            seed(convert::camera_info(kWidth, kHeight, 9))};
}

}  // namespace planemap::fuzz
