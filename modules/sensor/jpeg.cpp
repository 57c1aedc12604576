// SPDX-License-Identifier: BSD-3-Clause
#include "sensor/jpeg.hpp"

#include <turbojpeg.h>

#include <memory>
#include <stdexcept>
#include <string>

namespace planemap::sensor {

bool is_jpeg(std::string_view bytes) {
    return bytes.starts_with("\xff\xd8\xff");
}

void check_jpeg(std::string_view bytes, int width, int height) {
    if (!is_jpeg(bytes)) throw std::runtime_error("not a JPEG");
    const std::unique_ptr<void, int (*)(void*)> decoder(tjInitDecompress(), tjDestroy);
    if (!decoder) throw std::bad_alloc();
    int w = 0, h = 0, subsampling = 0, colorspace = 0;
    if (tjDecompressHeader3(decoder.get(), reinterpret_cast<const unsigned char*>(bytes.data()), bytes.size(),
                            &w, &h, &subsampling, &colorspace) != 0 ||
        w <= 0 || h <= 0) {
        throw std::runtime_error(std::string("bad JPEG header: ") + tjGetErrorStr2(decoder.get()));
    }
    if (w != width || h != height) {
        throw std::runtime_error("the image is " + std::to_string(w) + "x" + std::to_string(h) +
                                 ", the camera's is " + std::to_string(width) + "x" + std::to_string(height));
    }
    const auto last = bytes.find_last_not_of('\0');  // some writers pad with zeros
    if (last == std::string_view::npos || !bytes.substr(0, last + 1).ends_with("\xff\xd9")) {
        throw std::runtime_error("cut short JPEG: the end marker is missing");
    }
}

}  // namespace planemap::sensor
