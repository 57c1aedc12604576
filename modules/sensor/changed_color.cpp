// SPDX-License-Identifier: BSD-3-Clause
#include "sensor/changed_color.hpp"

#include "messages/image_codec.hpp"

namespace planemap::sensor {

void change_color(SensorFrame& frame, ReadResult& result, const PinholeCamera& camera,
                  const std::function<void(RgbImage&)>& change) {
    try {
        if (!frame.color_jpeg.empty())
            frame.color = messages::decode_jpeg_colors(frame.color_jpeg, camera.width, camera.height);
        if (!frame.color.empty()) change(frame.color);
    } catch (const messages::MessageError& error) {
        frame.color = {};
        frame.color_utime = 0;
        result.color_left_out = true;
        result.reason = error.what();
        result.message = "a colour image: " + result.reason + "; the frame is used without colour";
    }
    frame.color_jpeg.clear();
}

}  // namespace planemap::sensor
