// SPDX-License-Identifier: BSD-3-Clause
// Depth images in files to label images and regions in files.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "core/camera.hpp"
#include "segmentation/segmentation.hpp"

namespace planemap {

struct SegmentImagesOptions {
    std::vector<std::filesystem::path> images;  ///< 16-bit PNG, of the size of the camera's depth image
    std::filesystem::path output;               ///< folder; made if it is not there
    int repeat = 0;                             ///< runs an image whose time is measured; 0: none
    bool overlay = false;                       ///< write STEM.overlay.png, too
    bool quiet = false;                         ///< no progress on stderr
    segmentation::SegmentationOptions segmentation;

    /// Throws std::invalid_argument that names every bad field, and for two images whose results would have
    /// the same name.
    void validate() const;
};

struct SegmentImagesReport {
    std::size_t regions = 0;          ///< in all images together
    std::vector<std::string> errors;  ///< one line for each image that could not be done: file and reason
    std::vector<std::string> notes;   ///< what else the user should know of the folder, a line each
};

/// Writes for each image output/STEM.png (labels, 16-bit greyscale; 0: none, i: region i) and
/// output/STEM.json (image, width, height, method, labels, time_ms, and regions: see regions_json()), both at
/// once; of an earlier run, that image's results are replaced. `sensed` is of the images as they are: what
/// its lens does is undone, and labels are in the pinhole's pixels. An image that cannot be read, has not the
/// camera's size, or whose results cannot be written, or would overwrite an input or an image of another
/// kind, costs itself only. Throws std::invalid_argument for bad options or a bad camera, std::runtime_error
/// if the folder cannot be made or written to, or another run writes there.
SegmentImagesReport segment_images(const SegmentImagesOptions& options, const CameraInfo& sensed);

/// Takes the arguments that are neither flags nor values of flags out of a command line: the files. Every
/// flag takes a value unless it is written --flag=value or stands in `switches`. What follows "--" is a file.
std::vector<std::string> take_files(std::vector<std::string>& arguments,
                                    const std::vector<std::string>& switches);

}  // namespace planemap
