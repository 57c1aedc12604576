// SPDX-License-Identifier: BSD-3-Clause
#include "graph/graph_shell.hpp"

#include <spdlog/spdlog.h>

#include <chrono>

#include "messages/channels.hpp"
#include "messages/convert.hpp"
#include "messages/decode.hpp"
#include "messages/keyframe_watch.hpp"

namespace planemap::graph {

namespace {
constexpr const char* kOutOfOrder = "keyframes with an id out of order";
constexpr const char* kFeatures =
    "features without a point before the camera, or beyond the most of a keyframe";
constexpr const char* kFailed = "optimisations in which the solver gave up";
}  // namespace

GraphShell::GraphShell(messages::Bus& bus, const GraphOptions& options, Optimising optimising,
                       const GraphFiles& files)
    : bus_(bus), optimising_(optimising), graph_(options), output_(files.output) {
    if (!files.journal.empty()) {
        journal_ = std::make_unique<GraphJournal>(files.journal);
        resume();
    }
    // Keyframes are few and each counts: a long queue.
    bus_.subscribe(messages::channels::kKeyframe,
                   status_.guard([this](const messages::RawMessage& m) { on_keyframe(m); }), 256);
    bus_.subscribe(messages::channels::kSurfaces,
                   status_.guard([this](const messages::RawMessage& m) { on_surfaces(m); }), 4);
    if (!output_.empty())
        bus_.subscribe(
            messages::channels::kOdometry, [this](const messages::RawMessage& m) { on_odometry(m); }, 256);
}

void GraphShell::on_odometry(const messages::RawMessage& message) {
    const OdometryEstimate e = messages::from_message(messages::decode<odometry_t>(message.bytes));
    if (!is_placed(e)) return;
    frames_.push_back({e.pose_utime, e.keyframe_id, e.keyframe_from_camera, e.odom_from_camera});
    if (frames_.size() <= kMostFrames) return;
    frames_.pop_front();
    status_.lost("oldest frames of trajectory.txt");
}

/// As planemap-run leaves them.
void GraphShell::write_trajectories() {
    const KeyframeTrajectory& graph = graph_.trajectory();
    poses_.update(graph.keyframes);
    std::vector<Trajectory> written;
    for (ComponentTrajectory& part : place_frames(frames_, poses_, graph)) {
        Trajectory& trajectory = part.trajectory;
        Trajectory before;  // of what came before this process there are the keyframes
        for (const KeyframePose& keyframe : graph.keyframes)
            if (keyframe.component == part.component &&
                (trajectory.empty() || keyframe.utime < trajectory.front().utime))
                before.push_back({keyframe.utime, keyframe.world_from_camera});
        trajectory.insert(trajectory.begin(), before.begin(), before.end());
        if (!trajectory.empty()) written.push_back(std::move(trajectory));
    }
    if (written.empty()) return;
    std::filesystem::create_directories(output_);
    planemap::write_trajectories(output_, written);
}

void GraphShell::on_keyframe(const messages::RawMessage& message) {
    const keyframe_t received = messages::decode<keyframe_t>(message.bytes);
    const Keyframe keyframe = messages::from_message(received);
    if (!keyframe_guard_.admits(received, message.bytes, lately_.contains(received.id))) return;
    // One that begins a chain beyond our ids is of an odometry that heard of us.
    if (keyframe.chain == keyframe.id && graph_.expects(keyframe.id)) odometry_started_again_ = false;
    if (odometry_started_again_ || !graph_.expects(keyframe.id)) {
        refuse(keyframe.id);
        // Of two, nobody knows which is the stray: the graph goes on with the second.
        if (graph_.trajectory().keyframes.size() > 1) return;
    }
    add(keyframe);
    took(received);
    if (journal_) journal_->add(message.bytes);
    publish();
    start_if_due();
}

void GraphShell::on_surfaces(const messages::RawMessage& message) {
    const surfaces_t received = messages::decode<surfaces_t>(message.bytes);
    Surfaces surfaces = messages::from_message(received);
    if (!surfaces_guard_.admits(received.session, received.seq, std::nullopt, message.bytes)) return;
    if (running_) {
        waiting_surfaces_ = std::move(surfaces);  // the newest says all
    } else {
        adopt(surfaces);
    }
}

void GraphShell::adopt(const Surfaces& surfaces) {
    const messages::ModuleStatus::Work work(status_);
    has_new_surfaces_ = graph_.adopt(surfaces) || has_new_surfaces_;
}

void GraphShell::add(const Keyframe& keyframe) {
    try {
        const messages::ModuleStatus::Work work(status_);
        if (optimising_ == Optimising::kInHandler)
            graph_.add(keyframe);
        else
            graph_.insert(keyframe);
    } catch (const std::invalid_argument& error) {
        throw messages::MessageError(error.what());
    }
    messages::remark_new_part(status_, keyframe.id, keyframe.previous_id, keyframe.utime);
}

void GraphShell::took(const keyframe_t& received) {
    constexpr std::size_t kLately = 256;
    if (received.session != keyframe_guard_.session()) lately_.clear();
    keyframe_guard_.took(received);
    lately_.insert(received.id);
    if (lately_.size() > kLately) lately_.erase(lately_.begin());
}

/// Takes the keyframes of the process before.
void GraphShell::resume() {
    const auto newest = journal_->replay(bus_.complaints(), [this](const keyframe_t& received) {
        const Keyframe keyframe = messages::from_message(received);
        if (!graph_.expects(keyframe.id)) return false;
        add(keyframe);
        took(received);
        return true;
    });
    if (!newest) return;
    keyframe_guard_.resume(newest->message, newest->bytes);
    spdlog::info("graph: goes on with {} keyframes of {}", graph_.trajectory().keyframes.size(),
                 journal_->file().string());
    publish();
    start_if_due();
}

/// Says what a refused keyframe looks like: of the first, and when some come in a row.
void GraphShell::refuse(int id) {
    constexpr int kRow = 3;
    const int last = graph_.trajectory().keyframes.back().id;
    status_.dropped();
    status_.lost(kOutOfOrder);
    refused_in_row_ = last_refused_ && id - 1 == *last_refused_ ? refused_in_row_ + 1 : 1;
    const bool is_first = !last_refused_;
    last_refused_ = id;
    std::string text = "keyframe " + std::to_string(id) + " does not follow keyframe " + std::to_string(last);
    // From then on no id of its can be told from one of before: none is taken.
    if (id <= last && refused_in_row_ >= kRow && graph_.trajectory().keyframes.size() > 1)
        odometry_started_again_ = true;
    if (odometry_started_again_)
        text += ": odometry started again; nothing of it is taken until its ids begin after those";
    status_.set_text(text);
    if (is_first || refused_in_row_ == kRow) spdlog::warn("graph: {}", text);
}

void GraphShell::start_if_due() {
    if (optimising_ != Optimising::kInBackground || running_ || !graph_.due()) return;
    running_ = graph_.prepare();
    done_ = std::async(std::launch::async, [this] { running_->run(); });
}

int GraphShell::poll() {
    constexpr int kIdleMs = 100, kRunningMs = 10;
    republish_if_due();
    if (journal_) journal_->tend(graph_.trajectory(), status_);
    if (!running_) return kIdleMs;
    if (done_.wait_for(std::chrono::seconds(0)) != std::future_status::ready) return kRunningMs;
    apply_finished();
    publish();
    start_if_due();
    return kIdleMs;
}

/// What the background found, and then what had to wait for it.
void GraphShell::apply_finished() {
    done_.get();
    graph_.apply(*running_);
    running_.reset();
    if (waiting_surfaces_) adopt(*waiting_surfaces_);
    waiting_surfaces_.reset();
}

void GraphShell::finish() {
    if (running_) apply_finished();
    if (graph_.trajectory().keyframes.empty()) return;
    {
        const messages::ModuleStatus::Work work(status_);
        graph_.finish();
        has_new_surfaces_ = false;
    }
    publish();
    if (!output_.empty()) write_trajectories();
}

/// What the graph did without since it was last told.
void GraphShell::tell_losses() {
    const GraphCounts now = graph_.counts();
    status_.lost(kFeatures, static_cast<std::int64_t>(now.features_left_out - told_.features_left_out));
    status_.lost(kFailed, static_cast<std::int64_t>(now.failed_optimisations - told_.failed_optimisations));
    told_ = now;
}

/// For those who come late while the camera stands still: the same message again, which is no work.
void GraphShell::republish_if_due() {
    if (published_us_ == 0 || messages::now_us() - published_us_ < messages::kRepeat_us) return;
    bus_.publish(messages::channels::kTrajectory,
                 messages::to_message(graph_.trajectory(), seq_ - 1, bus_.session()));
    published_us_ = messages::now_us();
}

void GraphShell::publish() {
    tell_losses();
    const KeyframeTrajectory& trajectory = graph_.trajectory();
    if (!output_.empty()) poses_.update(trajectory.keyframes);
    bus_.publish(messages::channels::kTrajectory, messages::to_message(trajectory, seq_++, bus_.session()));
    published_us_ = messages::now_us();
    status_.published();
    std::string text = std::to_string(trajectory.keyframes.size()) + " keyframes, " +
                       std::to_string(trajectory.loop_closures) + " loop closures";
    if (const std::size_t replaced = graph_.counts().replaced; replaced > 0)
        text += ", " + std::to_string(replaced) + " keyframes replaced by newer ones";
    status_.set_text(text);
}

}  // namespace planemap::graph
