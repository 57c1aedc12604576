// SPDX-License-Identifier: BSD-3-Clause
#include "bench_odometry/peers.hpp"

#include <limits>
#include <opencv2/core.hpp>
#include <opencv2/rgbd/depth.hpp>
#include <optional>

#include "evaluate/readings.hpp"
#include "messages/channels.hpp"
#include "messages/frame_decoder.hpp"
#include "messages/module_status.hpp"
#include "run/input.hpp"

namespace planemap::bench_odometry {

namespace {

cv::Mat luma(const GrayImage& gray) {
    return cv::Mat(gray.height, gray.width, CV_8U, const_cast<std::uint8_t*>(gray.pixels.data())).clone();
}

/// Metres; NaN where there is no reading to trust.
cv::Mat metric(const DepthImage& depth, const CameraInfo& camera) {
    cv::Mat metres(depth.height, depth.width, CV_32F, std::numeric_limits<float>::quiet_NaN());
    evaluation::for_each_reading(
        depth, camera, [&](int u, int v, double z) { metres.at<float>(v, u) = static_cast<float>(z); });
    return metres;
}

/// From frame to frame; the first frame is the origin.
class FrameToFrame {
  public:
    explicit FrameToFrame(const std::string& method)
        : odometry_(
              cv::rgbd::Odometry::create(method == "opencv-rgbd" ? "RgbdOdometry" : "RgbdICPOdometry")) {}

    /// The pose of the frame in the first one's camera frame; nothing when lost.
    std::optional<Pose> track(const messages::Frame& frame) {
        const GrayImage* gray = frame.gray();
        if (gray == nullptr) return std::nullopt;
        const CameraInfo& camera = frame.camera();
        if (camera.color != camera_) {
            camera_ = camera.color;
            odometry_->setCameraMatrix(
                cv::Mat(cv::Matx33d(camera_.fx, 0, camera_.cx, 0, camera_.fy, camera_.cy, 0, 0, 1)));
        }
        auto next = cv::rgbd::OdometryFrame::create(luma(*gray), metric(frame.depth_in_color(), camera));
        const double start_ms = messages::thread_cpu_ms();
        const bool tracked = align(next);
        ms_.add(messages::thread_cpu_ms() - start_ms);
        if (!tracked) return std::nullopt;
        last_ = next;
        return first_from_last_;
    }
    const Histogram& ms() const { return ms_; }

  private:
    bool align(cv::Ptr<cv::rgbd::OdometryFrame>& next) {
        if (last_.empty()) return true;
        cv::Mat next_from_last;
        if (!odometry_->compute(last_, next, next_from_last)) return false;
        Pose motion = Pose::Identity();
        for (int row = 0; row < 3; ++row)
            for (int column = 0; column < 4; ++column)
                motion.matrix()(row, column) = next_from_last.at<double>(row, column);
        if (!motion.matrix().allFinite()) return false;
        first_from_last_ = orthonormalised(first_from_last_ * motion.inverse());
        return true;
    }

    cv::Ptr<cv::rgbd::Odometry> odometry_;
    cv::Ptr<cv::rgbd::OdometryFrame> last_;
    PinholeCamera camera_;
    Pose first_from_last_ = Pose::Identity();
    Histogram ms_;
};

}  // namespace

MethodRun run_peer(const std::string& method, const std::string& input_name, std::int64_t max_frames,
                   const std::function<void(std::int64_t)>& on_frame) {
    cv::setNumThreads(1);
    messages::Bus bus("memq://");
    messages::FrameDecoder decoder(bus);
    FrameToFrame odometry(method);
    MethodRun run;
    bus.subscribe(messages::channels::kFrame, [&](const messages::RawMessage& message) {
        const auto frame = decoder.decode(message);
        if (!frame) return;
        const std::optional<Pose> pose = odometry.track(*frame);
        if (pose) run.trajectory.push_back({frame->color_utime(), *pose});
    });
    const std::unique_ptr<Input> input = open_input(input_name, bus);
    feed_all(*input, max_frames, [&](std::int64_t frames) {
        bus.drain();
        on_frame(frames);
    });
    run.frames = input->frames();
    run.tracking = stage_time(odometry.ms());
    run.decoding = stage_time(decoder.decode_ms());
    return run;
}

}  // namespace planemap::bench_odometry
