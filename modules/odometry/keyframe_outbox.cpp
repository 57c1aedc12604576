// SPDX-License-Identifier: BSD-3-Clause
#include "odometry/keyframe_outbox.hpp"

#include <spdlog/spdlog.h>

#include <planemap/module_status_t.hpp>
#include <utility>

#include "messages/channels.hpp"
#include "messages/convert.hpp"
#include "messages/decode.hpp"
#include "messages/keyframe_watch.hpp"

namespace planemap::odometry {

namespace {

using Clock = std::chrono::steady_clock;

constexpr std::chrono::seconds kSendAgain{5};  // keyframes of so long
constexpr std::size_t kMostSent = 32;

}  // namespace

KeyframeOutbox::KeyframeOutbox(messages::Bus& bus, messages::ModuleStatus& status,
                               const std::filesystem::path& journal)
    : bus_(bus), status_(status) {
    if (!journal.empty()) journal_ = std::make_unique<messages::Journal>(journal);
    if (!bus_.is_network()) return;
    for (const char* module : {"GRAPH", "MAP", "OCTOMAP"})
        bus_.subscribe(std::string(messages::channels::kStatusPrefix) + module,
                       [this](const messages::RawMessage& m) { on_status(m); });
}

std::vector<Keyframe> KeyframeOutbox::earlier() {
    std::vector<Keyframe> keyframes;
    if (!journal_) return keyframes;
    for (const std::string& complaint : journal_->complaints()) spdlog::warn("odometry: {}", complaint);
    journal_->replay([&](const messages::LogEvent& event) {
        try {
            keyframes.push_back(messages::from_message(messages::decode<keyframe_t>(event.bytes)));
        } catch (const messages::MessageError& error) {
            bus_.complaints().add(journal_->file().string() + ": a keyframe left out: " + error.what());
        }
    });
    if (!keyframes.empty())
        spdlog::info("odometry: knows {} keyframes of {}; lost until it finds a place that they saw",
                     keyframes.size(), journal_->file().string());
    return keyframes;
}

void KeyframeOutbox::publish(const Keyframe& keyframe) {
    const keyframe_t message = messages::to_message(keyframe, seq_++, bus_.session());
    std::vector<std::uint8_t> bytes = messages::to_bytes(message);
    if (journal_)
        journal_->add(messages::channels::kKeyframe, bytes);  // first: an id that is known is given once
    bus_.publish_bytes(messages::channels::kKeyframe, bytes);
    messages::remark_new_part(status_, keyframe.id, keyframe.previous_id, keyframe.utime);
    if (!bus_.is_network()) return;
    sent_.push_back({Clock::now(), std::move(bytes)});
    if (sent_.size() > kMostSent) sent_.pop_front();
}

/// A module that was started again has missed what was sent meanwhile.
void KeyframeOutbox::on_status(const messages::RawMessage& message) {
    const auto status = messages::decode<module_status_t>(message.bytes);
    if (status.state == module_status_t::STOPPED) return;
    const auto [known, is_first] = sessions_.try_emplace(status.module, status.session);
    if (is_first || known->second == status.session) return;
    known->second = status.session;
    send_again();
}

void KeyframeOutbox::send_again() {
    for (const Sent& sent : sent_)
        if (Clock::now() - sent.at < kSendAgain)
            bus_.publish_bytes(messages::channels::kKeyframe, sent.bytes);
}

/// As many keyframes as are looked at for a known place, and no more, are worth keeping.
void KeyframeOutbox::tend_journal() {
    if (!journal_) return;
    if (journal_->is_due_to_compact()) {
        constexpr std::int64_t kKept = 200;
        std::int64_t last = 0;
        journal_->replay([&](const messages::LogEvent& event) { last = event.number; });
        journal_->compact([&](const messages::LogEvent& event) { return event.number > last - kKept; });
    }
    if (const auto news = journal_->news()) status_.remark("journal", *news);
}

}  // namespace planemap::odometry
