// SPDX-License-Identifier: BSD-3-Clause
#include "convert/bag_source.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <deque>
#include <map>
#include <set>
#include <stdexcept>
#include <vector>

#include "convert/bag_reader.hpp"
#include "convert/lens_of.hpp"
#include "convert/pixels.hpp"
#include "convert/ros_messages.hpp"
#include "core/geometry/pose.hpp"
#include "core/stamp.hpp"

namespace planemap::convert {

namespace {

constexpr const char* kRealSenseImage = "/image/data";
constexpr std::size_t kMaxTransforms = 10000;
constexpr std::size_t kMaxWaiting = 300;  ///< images that wait for partners: 10 s

std::string lower(std::string text) {
    std::transform(text.begin(), text.end(), text.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return text;
}

bool holds(const std::string& text, const char* part) {
    return lower(text).find(part) != std::string::npos;
}

std::string without_end(const std::string& text, const std::string& end) {
    return text.ends_with(end) ? text.substr(0, text.size() - end.size()) : text;
}

std::string parent(const std::string& topic) {
    return topic.substr(0, topic.rfind('/'));
}

/// One topic with images.
struct ImageTopic {
    std::string name, encoding, frame;  ///< of the first message
    bool compressed = false;
    double unit_m = 0;  ///< of depth, where the message says it
    bool is_realsense() const { return name.ends_with(kRealSenseImage); }
    /// The topic without what image_transport appends.
    std::string base() const { return without_end(without_end(name, "/compressedDepth"), "/compressed"); }
    bool is_depth() const {
        if (compressed) return name.ends_with("/compressedDepth") || holds(encoding, "compresseddepth");
        return is_depth_encoding(encoding) && (encoding != "mono16" || holds(name, "depth"));
    }
    bool is_color() const {
        if (is_depth() || holds(name, "infra") || holds(name, "fisheye") || holds(name, "/ir/")) return false;
        return compressed || is_color_encoding(encoding);
    }
};

/// What a CameraInfo says.
struct SaidCamera {
    PinholeCamera pinhole;
    std::optional<LensDistortion> lens;
};

/// What a bag holds besides images, and where its cameras are.
class BagContents {
  public:
    BagContents(BagReader& bag, std::string file) : bag_(bag), file_(std::move(file)) {
        for (const auto& [topic, type] : bag_.types()) add_images(topic);
        add_transforms();
    }

    const std::vector<ImageTopic>& images() const { return images_; }

    /// The first message of a topic; nothing if it has none or is of another type.
    std::optional<std::vector<std::uint8_t>> first(const std::string& topic, const char* type) const {
        const auto found = bag_.types().find(topic);
        if (found == bag_.types().end() || found->second != type) return std::nullopt;
        bag_.select({topic});
        BagMessage message;
        if (!bag_.next(message)) return std::nullopt;
        return std::move(message.bytes);
    }

    /// Where the topic's CameraInfo is.
    std::string info_topic(const ImageTopic& topic) const {
        return topic.is_realsense() ? without_end(topic.name, kRealSenseImage) + "/info/camera_info"
                                    : parent(topic.base()) + "/camera_info";
    }
    std::optional<SaidCamera> camera(const ImageTopic& topic, std::vector<std::string>& notes) const;
    std::optional<Pose> color_from_depth(const ImageTopic& color, const ImageTopic& depth) const;
    double units_per_metre(const ImageTopic& depth) const;
    std::string serial() const;
    /// "/a sensor_msgs/Image (rgb8), /b std_msgs/String".
    std::string text() const;

  private:
    void add_images(const std::string& topic);
    void add_transforms();
    std::optional<Pose> stream_from_reference(const std::string& stream, std::string& reference) const;
    Pose root_from(std::string frame, std::string& root) const;

    BagReader& bag_;
    std::string file_;
    std::vector<ImageTopic> images_;
    std::map<std::string, std::pair<std::string, Pose>> parents_;  ///< by frame: parent_from_frame
};

void BagContents::add_images(const std::string& topic) {
    ImageTopic image;
    image.name = topic;
    if (const auto bytes = first(topic, "sensor_msgs/Image")) {
        const RosImage message = read_image(*bytes);
        image.encoding = message.encoding;
        image.frame = message.header.frame_id;
        image.unit_m = static_cast<double>(message.depth_unit_m);
    } else if (const auto compressed = first(topic, "sensor_msgs/CompressedImage")) {
        const RosCompressedImage message = read_compressed_image(*compressed);
        image.compressed = true;
        image.encoding = message.format;
        image.frame = message.header.frame_id;
    } else {
        return;
    }
    images_.push_back(image);
}

void BagContents::add_transforms() {
    std::vector<std::string> topics;
    for (const char* topic : {"/tf_static", "/tf"})
        if (bag_.types().count(topic) > 0) topics.emplace_back(topic);
    if (topics.empty()) return;
    bag_.select(topics);
    BagMessage message;
    for (std::size_t count = 0; count < kMaxTransforms && bag_.next(message); ++count) {
        for (const RosTransform& t : read_transforms(message.bytes))
            parents_.try_emplace(t.child_frame, t.frame, t.frame_from_child);
    }
}

std::optional<SaidCamera> BagContents::camera(const ImageTopic& topic,
                                              std::vector<std::string>& notes) const {
    const auto bytes = first(info_topic(topic), "sensor_msgs/CameraInfo");
    if (!bytes) return std::nullopt;
    const RosCameraInfo info = read_camera_info(*bytes);
    SaidCamera said;
    PinholeCamera& camera = said.pinhole;
    camera.width = static_cast<int>(std::min<std::uint32_t>(info.width, 100000));
    camera.height = static_cast<int>(std::min<std::uint32_t>(info.height, 100000));
    const bool rectified = (holds(topic.name, "rect") || holds(topic.name, "registered")) && info.P[0] > 0;
    if (rectified) {
        camera.fx = info.P[0], camera.fy = info.P[5], camera.cx = info.P[2], camera.cy = info.P[6];
    } else {
        camera.fx = info.K[0], camera.fy = info.K[4], camera.cx = info.K[2], camera.cy = info.K[5];
        SaidLens lens = lens_of(info.distortion_model, info.D);
        said.lens = std::move(lens.lens);
        if (!lens.note.empty()) notes.push_back(file_ + ": " + info_topic(topic) + ": " + lens.note);
    }
    return said;
}

/// The transform that RealSense's SDK writes: of points of the streams' common reference into the stream's.
std::optional<Pose> BagContents::stream_from_reference(const std::string& stream,
                                                       std::string& reference) const {
    const std::string prefix = stream + "/tf/";
    const auto found = bag_.types().lower_bound(prefix);
    if (found == bag_.types().end() || !found->first.starts_with(prefix)) return std::nullopt;
    const auto bytes = first(found->first, "geometry_msgs/Transform");
    if (!bytes) return std::nullopt;
    reference = found->first.substr(prefix.size());
    return read_transform(*bytes);
}

/// Up the tree of frames; nothing beyond a circle.
Pose BagContents::root_from(std::string frame, std::string& root) const {
    Pose root_from_frame = Pose::Identity();
    for (std::size_t steps = 0; steps < 64; ++steps) {
        const auto up = parents_.find(frame);
        if (up == parents_.end()) break;
        root_from_frame = up->second.second * root_from_frame;
        frame = up->second.first;
    }
    root = frame;
    return root_from_frame;
}

std::optional<Pose> BagContents::color_from_depth(const ImageTopic& color, const ImageTopic& depth) const {
    if (color.is_realsense() && depth.is_realsense()) {
        std::string color_reference, depth_reference;
        const auto color_pose =
            stream_from_reference(without_end(color.name, kRealSenseImage), color_reference);
        const auto depth_pose =
            stream_from_reference(without_end(depth.name, kRealSenseImage), depth_reference);
        if (!color_pose || !depth_pose || color_reference != depth_reference) return std::nullopt;
        return *color_pose * depth_pose->inverse();
    }
    std::string color_root, depth_root;
    const Pose from_color = root_from(color.frame, color_root),
               from_depth = root_from(depth.frame, depth_root);
    if (color.frame.empty() || depth.frame.empty() || color_root != depth_root) return std::nullopt;
    return from_color.inverse() * from_depth;
}

double BagContents::units_per_metre(const ImageTopic& depth) const {
    if (holds(depth.encoding, "32fc1")) return kFloatUnits;
    if (!depth.is_realsense()) return 1000;  // as REP 118 has it
    double metres = depth.unit_m;
    for (const auto& [topic, type] : bag_.types()) {
        if (metres > 0 ||
            !(topic.ends_with("/option/Depth_Units/value") || topic.ends_with("/option/Depth Units/value")))
            continue;
        if (const auto bytes = first(topic, "std_msgs/Float32"))
            metres = static_cast<double>(read_float(*bytes));
    }
    // Single precision: 0.001 is 0.0010000000475.
    return metres > 0 && std::isfinite(metres) ? std::round(1e3 / metres) / 1e3 : 1000;
}

std::string BagContents::serial() const {
    if (bag_.types().count("/device_0/info") == 0) return {};
    bag_.select({"/device_0/info"});
    for (BagMessage message; bag_.next(message);) {
        const auto [key, value] = read_key_value(message.bytes);
        if (key == "Serial Number" && value.size() <= 64) return value;
    }
    return {};
}

std::string BagContents::text() const {
    constexpr std::size_t kMost = 32;
    std::string text;
    std::size_t count = 0;
    for (const auto& [topic, type] : bag_.types()) {
        if (++count > kMost) continue;
        text.append(text.empty() ? "" : ", ").append(topic).append(" ").append(type);
        for (const ImageTopic& image : images_)
            if (image.name == topic) text += " (" + image.encoding + ")";
    }
    if (count > kMost) text += " and " + std::to_string(count - kMost) + " topics more";
    return text.empty() ? "nothing" : text;
}

/// Which images are read, and their camera.
struct Choice {
    ImageTopic depth;
    std::optional<ImageTopic> color;
    CameraInfo camera;
    std::vector<std::string> notes;
};

constexpr const char* kGiveCamera = "; give --camera camera.json";

/// Throws std::runtime_error (reason only) if the bag does not say what camera it is.
CameraInfo camera_of(const BagContents& bag, const Choice& choice, std::vector<std::string>& notes) {
    CameraInfo camera;
    const auto depth = bag.camera(choice.depth, notes);
    if (!depth) throw std::runtime_error("no CameraInfo on " + bag.info_topic(choice.depth) + kGiveCamera);
    camera.serial = bag.serial();
    camera.depth = camera.color = depth->pinhole;
    camera.depth_distortion = camera.color_distortion = depth->lens;
    camera.depth_units_per_metre = bag.units_per_metre(choice.depth);
    if (choice.color) {
        const auto color = bag.camera(*choice.color, notes);
        camera.registered = holds(choice.depth.name, "aligned") || holds(choice.depth.name, "registered") ||
                            (!choice.depth.is_realsense() && choice.depth.frame == choice.color->frame);
        if (!color && !camera.registered)
            throw std::runtime_error("no CameraInfo on " + bag.info_topic(*choice.color) + kGiveCamera);
        if (color) {
            camera.color = color->pinhole;
            camera.color_distortion = color->lens;
        }
        if (!camera.registered) {
            const auto color_from_depth = bag.color_from_depth(*choice.color, choice.depth);
            if (!color_from_depth) {
                throw std::runtime_error("nothing in it says how " + choice.depth.name + " lies to " +
                                         choice.color->name + kGiveCamera);
            }
            camera.color_from_depth = *color_from_depth;
        }
    }
    camera.validate();
    return camera;
}

const ImageTopic* find_topic(const BagContents& bag, const std::string& name) {
    for (const ImageTopic& image : bag.images())
        if (image.name == name) return &image;
    return nullptr;
}

/// Raw images before compressed ones, three colours before grey, then by name.
std::vector<ImageTopic> candidates(const BagContents& bag, bool depth, const std::string& asked) {
    std::vector<ImageTopic> out;
    for (const ImageTopic& image : bag.images())
        if (asked.empty() ? (depth ? image.is_depth() : image.is_color()) : image.name == asked)
            out.push_back(image);
    const auto rank = [](const ImageTopic& image) {
        return std::pair(image.compressed, image.encoding == "mono8" || image.encoding == "8UC1");
    };
    std::stable_sort(out.begin(), out.end(), [&](const auto& a, const auto& b) { return rank(a) < rank(b); });
    return out;
}

Choice choose(const BagContents& bag, const std::string& file, const BagOptions& options) {
    const auto require_topic = [&](const std::string& asked) {
        if (!asked.empty() && find_topic(bag, asked) == nullptr)
            throw std::runtime_error(file + ": no images on " + asked + "; in it are " + bag.text());
    };
    require_topic(options.depth_topic);
    require_topic(options.color_topic);
    const auto depths = candidates(bag, true, options.depth_topic);
    const auto colors = candidates(bag, false, options.color_topic);
    if (depths.empty())
        throw std::runtime_error(file + ": no topic with depth images; in it are " + bag.text());
    std::string why;
    for (const ImageTopic& depth : depths) {
        Choice choice{depth, colors.empty() ? std::nullopt : std::optional(colors.front()), {}, {}};
        try {
            choice.camera = options.camera ? *options.camera : camera_of(bag, choice, choice.notes);
        } catch (const std::exception& error) {
            if (why.empty()) why = error.what();
            continue;
        }
        choice.notes.push_back(file + ": depth from " + depth.name +
                               (choice.color ? ", colour from " + choice.color->name : ", no colour in it"));
        return choice;
    }
    throw std::runtime_error(file + ": " + why);
}

class BagSource : public FrameSource {
  public:
    BagSource(const std::filesystem::path& file, const BagOptions& options)
        : file_(file.string()), max_gap_us_(std::llround(options.max_color_gap_s * 1e6)), bag_(file) {
        choice_ = choose(BagContents(bag_, file_), file_, options);
        std::vector<std::string> topics = {choice_.depth.name};
        bag_.select(topics);
        size_ = bag_.size();
        if (choice_.color) topics.push_back(choice_.color->name);
        bag_.select(topics);
    }

    const CameraInfo& camera() const override { return choice_.camera; }
    std::optional<std::size_t> size() const override { return size_; }
    std::vector<std::string> notes() const override { return choice_.notes; }
    std::vector<std::string> complaints() const override {
        std::vector<std::string> lines = bag_.complaints();
        if (lone_colors_ > 0)
            lines.push_back(file_ + ": " + std::to_string(lone_colors_) +
                            " colour images without depth near in time");
        if (lone_depths_ > 0)
            lines.push_back(file_ + ": " + std::to_string(lone_depths_) +
                            " depth images without colour near in time");
        if (unreadable_colors_ > 0)
            lines.push_back(file_ + ": " + std::to_string(unreadable_colors_) +
                            " colour images could not be read");
        return lines;
    }
    ReadResult next(SensorFrame& frame) override;

  private:
    /// An image that waits for its partner, and why it cannot be used, if it cannot.
    struct Waiting {
        std::int64_t utime = 0;
        SensorFrame frame;
        std::string fault;
    };

    bool read_one();
    bool is_decided(const Waiting& depth) const;
    ReadResult broken(const Waiting& depth) const;
    void read_depth(const BagMessage& message, Waiting& out) const;
    void read_color(const BagMessage& message, Waiting& out) const;
    void join_color(SensorFrame& frame, ReadResult& result);

    std::string file_;
    std::int64_t max_gap_us_;
    BagReader bag_;
    bool ended_ = false;  ///< the bag
    Choice choice_;
    std::size_t size_ = 0;
    std::deque<Waiting> depths_, colors_;
    std::int64_t lone_colors_ = 0, lone_depths_ = 0, unreadable_colors_ = 0;
};

std::int64_t stamp_of(const RosHeader& header, const BagMessage& message) {
    return header.utime != 0 ? header.utime : message.utime;
}

RawImage raw_of(const RosImage& image) {
    constexpr std::uint32_t kMost = 100000;
    return {static_cast<int>(std::min(image.width, kMost)),
            static_cast<int>(std::min(image.height, kMost)),
            image.step,
            image.is_bigendian,
            image.encoding,
            image.data};
}

void BagSource::read_depth(const BagMessage& message, Waiting& out) const {
    const PinholeCamera& camera = choice_.camera.depth;
    if (choice_.depth.compressed) {
        const RosCompressedImage image = read_compressed_image(message.bytes);
        out.utime = stamp_of(image.header, message);
        out.frame.depth = depth_of_compressed(image.format, image.data, camera);
    } else {
        const RosImage image = read_image(message.bytes);
        out.utime = stamp_of(image.header, message);
        RawImage raw = raw_of(image);
        if (choice_.depth.is_realsense()) raw.big_endian = false;  // the SDK runs on little-endian machines
        out.frame.depth = depth_of(raw, camera);
    }
    out.frame.utime = out.utime;
}

void BagSource::read_color(const BagMessage& message, Waiting& out) const {
    const PinholeCamera& camera = choice_.camera.color;
    if (choice_.color->compressed) {
        const RosCompressedImage image = read_compressed_image(message.bytes);
        out.utime = stamp_of(image.header, message);
        read_compressed_color(image.data, camera, out.frame);
    } else {
        const RosImage image = read_image(message.bytes);
        out.utime = stamp_of(image.header, message);
        out.frame.color = color_of(raw_of(image), camera);
    }
}

/// The next message of the bag to those that wait; false at its end.
bool BagSource::read_one() {
    BagMessage message;
    if (!bag_.next(message)) return false;
    Waiting waiting;
    waiting.utime = message.utime;
    const bool is_depth = message.topic == choice_.depth.name;
    try {
        is_depth ? read_depth(message, waiting) : read_color(message, waiting);
    } catch (const std::exception& error) {
        waiting.frame = {};
        waiting.fault = error.what();
    }
    (is_depth ? depths_ : colors_).push_back(std::move(waiting));
    return true;
}

/// True when no colour can come any more that is nearer to the depth image than those that wait.
bool BagSource::is_decided(const Waiting& depth) const {
    if (!choice_.color || ended_ || depths_.size() > kMaxWaiting || colors_.size() > kMaxWaiting) return true;
    return std::any_of(colors_.begin(), colors_.end(),
                       [&](const Waiting& c) { return c.utime - depth.utime >= max_gap_us_; });
}

ReadResult BagSource::broken(const Waiting& depth) const {
    return {
        ReadResult::Status::kBroken,
        file_ + ": depth at " + seconds_text(depth.utime) + ": " + depth.fault + "; the frame is left out",
        depth.fault};
}

/// The nearest colour in time; what is too old for any later depth goes.
void BagSource::join_color(SensorFrame& frame, ReadResult& result) {
    while (!colors_.empty() && colors_.front().utime < frame.utime - max_gap_us_) {
        ++lone_colors_;
        colors_.pop_front();
    }
    const auto distance = [&](const Waiting& c) { return std::abs(c.utime - frame.utime); };
    const auto nearest =
        std::min_element(colors_.begin(), colors_.end(),
                         [&](const Waiting& a, const Waiting& b) { return distance(a) < distance(b); });
    if (nearest == colors_.end() || distance(*nearest) > max_gap_us_) {
        ++lone_depths_;
        return;
    }
    if (nearest->fault.empty()) {
        frame.color = std::move(nearest->frame.color);
        frame.color_jpeg = std::move(nearest->frame.color_jpeg);
        frame.color_utime = nearest->utime;
    } else {
        ++unreadable_colors_;
        result.color_left_out = true;
        result.reason = nearest->fault;
        result.message = file_ + ": colour at " + seconds_text(nearest->utime) + ": " + nearest->fault +
                         "; the frame is used without colour";
    }
    lone_colors_ += nearest - colors_.begin();
    colors_.erase(colors_.begin(), nearest + 1);
}

ReadResult BagSource::next(SensorFrame& frame) {
    frame = {};
    while (!ended_ && (depths_.empty() || !is_decided(depths_.front()))) ended_ = !read_one();
    if (depths_.empty()) {
        lone_colors_ += static_cast<std::int64_t>(colors_.size());
        colors_.clear();
        return {};
    }
    Waiting depth = std::move(depths_.front());
    depths_.pop_front();
    if (!depth.fault.empty()) return broken(depth);
    ReadResult result;
    result.status = ReadResult::Status::kFrame;
    frame = std::move(depth.frame);
    if (choice_.color) join_color(frame, result);
    return result;
}

}  // namespace

std::unique_ptr<FrameSource> open_bag(const std::filesystem::path& file, const BagOptions& options) {
    try {
        return std::make_unique<BagSource>(file, options);
    } catch (const std::exception& error) {
        const std::string what = error.what(), name = file.string() + ": ";
        throw std::runtime_error(what.starts_with(name) ? what : name + what);
    }
}

}  // namespace planemap::convert
