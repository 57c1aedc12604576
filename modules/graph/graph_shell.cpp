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

GraphShell::GraphShell(messages::Bus& bus, const GraphOptions& options, Optimising optimising)
    : bus_(bus), optimising_(optimising), graph_(options) {
    // Keyframes are few and each counts: a long queue.
    bus_.subscribe(messages::channels::kKeyframe,
                   status_.guard([this](const messages::RawMessage& m) { on_keyframe(m); }), 256);
}

void GraphShell::on_keyframe(const messages::RawMessage& message) {
    const keyframe_t received = messages::decode<keyframe_t>(message.bytes);
    const Keyframe keyframe = messages::from_message(received);
    if (!keyframe_guard_.admits(received.session, received.seq, received.utime, message.bytes)) return;
    if (odometry_started_again_ || !graph_.expects(keyframe.id)) {
        refuse(keyframe.id);
        // Of two, nobody knows which is the stray: the graph goes on with the second.
        if (graph_.trajectory().keyframes.size() > 1) return;
    }
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
        text += ": odometry started again; start planemap-graph and planemap-map again, too";
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
    if (!running_) return kIdleMs;
    if (done_.wait_for(std::chrono::seconds(0)) != std::future_status::ready) return kRunningMs;
    done_.get();
    graph_.apply(*running_);
    running_.reset();
    publish();
    start_if_due();
    return kIdleMs;
}

void GraphShell::finish() {
    if (running_) {
        done_.get();
        graph_.apply(*running_);
        running_.reset();
    }
    if (graph_.trajectory().keyframes.empty()) return;
    {
        const messages::ModuleStatus::Work work(status_);
        graph_.finish();
    }
    publish();
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
