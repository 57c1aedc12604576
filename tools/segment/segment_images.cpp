// SPDX-License-Identifier: BSD-3-Clause
#include "segment/segment_images.hpp"

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "core/files.hpp"
#include "core/undistortion.hpp"
#include "evaluate/statistics.hpp"
#include "messages/module_status.hpp"
#include "results/progress_line.hpp"
#include "results/result_folder.hpp"
#include "segment/overlay.hpp"
#include "segment/read_image.hpp"
#include "segment/region_json.hpp"

namespace planemap {

namespace {

/// Thread CPU time of `repeat` runs; the segmenter has been run on the image before.
nlohmann::ordered_json measure(segmentation::Segmenter& segmenter, const DepthImage& depth,
                               const CameraInfo& camera, int repeat) {
    std::vector<double> ms;
    segmentation::Segmentation unused;
    segmenter.segment(depth, camera, unused);
    for (int i = 0; i < repeat; ++i) {
        const double start = messages::thread_cpu_ms();
        segmenter.segment(depth, camera, unused);
        ms.push_back(messages::thread_cpu_ms() - start);
    }
    return {{"median", nearest_rank(ms, 0.5)}, {"p95", nearest_rank(ms, 0.95)}, {"repeats", repeat}};
}

/// Images that are cut short behind their last pixel, in one line; empty for none.
std::string ends_missing_text(const std::vector<std::filesystem::path>& images) {
    if (images.empty()) return {};
    std::string text = images.front().string() + ": " + sensor::kEndMissing;
    if (images.size() > 1) text += "; and " + std::to_string(images.size() - 1) + " more such images";
    return text;
}

/// The names of one image's results.
struct ResultNames {
    std::string labels, json, overlay;

    explicit ResultNames(const std::filesystem::path& image) {
        const std::string stem = image.stem().string();
        labels = stem + ".png";
        json = stem + ".json";
        overlay = stem + ".overlay.png";
    }
    std::vector<std::string> all() const { return {labels, overlay, json}; }
};

/// Throws if an image of the results would take the place of an input, or of one that is not of an earlier
/// run: then its JSON would be there.
void refuse_to_overwrite(const std::filesystem::path& folder, const ResultNames& names,
                         const std::vector<std::filesystem::path>& inputs) {
    std::error_code no_file;
    for (const std::string& name : {names.labels, names.overlay}) {
        const std::filesystem::path file = folder / name;
        for (const std::filesystem::path& input : inputs) {
            if (std::filesystem::equivalent(file, input, no_file))
                throw std::runtime_error(file.string() + ": is an input; give another --output");
        }
        if (std::filesystem::exists(file, no_file) &&
            !std::filesystem::exists(folder / names.json, no_file)) {
            throw std::runtime_error(file.string() + ": is there, and not of an earlier run (there is no " +
                                     names.json + "); give another --output");
        }
    }
}

/// All that is written for all images.
std::vector<std::string> names_of(const std::vector<std::filesystem::path>& images) {
    std::vector<std::string> names;
    for (const std::filesystem::path& image : images)
        for (const std::string& name : ResultNames(image).all()) names.push_back(name);
    return names;
}

}  // namespace

void SegmentImagesOptions::validate() const {
    FieldErrors errors("segment options");
    errors.require(!images.empty(), "images", "none", "at least one file");
    errors.require(!output.empty(), "output", "empty", "a folder");
    errors.require(repeat >= 0, "repeat", repeat, "at least 0");
    std::map<std::string, std::string> image_of;
    for (const std::filesystem::path& image : images) {
        const auto [other, is_new] = image_of.try_emplace(image.stem().string(), image.string());
        errors.require(is_new, "images", image.string(),
                       "of another name than " + other->second + ", whose results it would overwrite");
    }
    errors.throw_if_any();
    segmentation.validate();
}

SegmentImagesReport segment_images(const SegmentImagesOptions& options, const CameraInfo& sensed) {
    options.validate();
    sensed.validate();
    const Undistortion undistortion(sensed);
    const CameraInfo& camera = undistortion.pinhole();
    // What a run that did not end left is a part of one image's results, which can be made again.
    ResultFolder folder(options.output, names_of(options.images), ".partial",
                        ResultFolder::Leftovers::kRemove);
    const std::unique_ptr<segmentation::Segmenter> segmenter =
        segmentation::make_segmenter(options.segmentation);
    SegmentImagesReport report;
    ProgressLine progress(options.quiet || options.images.size() < 2);
    segmentation::Segmentation segmentation;
    std::vector<std::filesystem::path> cut;
    const auto segment_one = [&](const std::filesystem::path& image) {
        const ResultNames names(image);
        refuse_to_overwrite(options.output, names, options.images);
        bool end_missing = false;
        DepthImage depth = read_image(image, camera, sensor::decode_depth_png, &end_missing);
        undistortion.undistort(depth);
        if (end_missing) cut.push_back(image);
        segmenter->segment(depth, camera, segmentation);
        nlohmann::ordered_json json{{"image", image.string()}, {"width", depth.width},
                                    {"height", depth.height},  {"method", options.segmentation.method},
                                    {"labels", names.labels},  {"regions", regions_json(segmentation)}};
        if (options.repeat > 0) json["time_ms"] = measure(*segmenter, depth, camera, options.repeat);
        folder.make(
            {names.labels, [&](const auto& file) { sensor::write_depth_png(file, segmentation.labels); }});
        if (options.overlay) {
            folder.make({names.overlay, [&](const auto& file) {
                             sensor::write_color_png(file, draw_overlay(depth, camera, segmentation));
                         }});
        }
        folder.make({names.json, [&](const auto& file) { write_file(file, json.dump(1) + "\n"); }});
        folder.replace(names.all());
        report.regions += segmentation.regions.size();
    };
    for (std::size_t i = 0; i < options.images.size(); ++i) {
        if (progress.is_due())
            progress.show("image " + std::to_string(i) + " of " + std::to_string(options.images.size()));
        try {
            segment_one(options.images[i]);
        } catch (const std::exception& failure) {
            report.errors.emplace_back(failure.what());
            folder.discard();
        }
    }
    report.notes = folder.take_notes();
    if (const std::string text = ends_missing_text(cut); !text.empty()) report.notes.push_back(text);
    return report;
}

std::vector<std::string> take_files(std::vector<std::string>& arguments,
                                    const std::vector<std::string>& switches) {
    std::vector<std::string> files, flags;
    for (auto argument = arguments.begin(); argument != arguments.end(); ++argument) {
        if (*argument == "--") {
            files.insert(files.end(), argument + 1, arguments.end());
            break;
        }
        if (argument->size() < 2 || argument->front() != '-') {
            files.push_back(*argument);
            continue;
        }
        flags.push_back(*argument);
        const bool has_value = argument->find('=') == std::string::npos &&
                               std::find(switches.begin(), switches.end(), *argument) == switches.end();
        if (has_value && argument + 1 != arguments.end()) flags.push_back(*++argument);
    }
    arguments = flags;
    return files;
}

}  // namespace planemap
