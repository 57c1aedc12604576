// SPDX-License-Identifier: BSD-3-Clause
#include "messages/sender_guard.hpp"

#include <libdeflate.h>

#include <algorithm>

#include "core/stamp.hpp"
#include "core/time_step.hpp"
#include "messages/session.hpp"

namespace planemap::messages {

namespace {

using Message = SenderGuard::Message;
using Verdict = SenderGuard::Verdict;

constexpr std::int64_t kReordered = 8;       // places by which a network brings a message late
constexpr std::int64_t kMissed = 64;         // numbers that a stream may lack without being another one
constexpr std::int64_t kPauses = 30;         // usual steps of time that are no jump
constexpr std::int64_t kPause_us = 2000000;  // nor is this
constexpr int kAhead = 2, kBehind = 3;       // messages in a row that make a jump ahead, or back, believed
constexpr int kUntimed = 10;                 // the same for another sender without time stamps
constexpr std::size_t kStreams = 4;

std::optional<std::int64_t> seq_steps(const Message& from, const Message& to) {
    if (!from.seq || !to.seq) return std::nullopt;
    return static_cast<std::int32_t>(*to.seq - *from.seq);
}

std::optional<std::int64_t> elapsed_us(const Message& from, const Message& to) {
    if (!from.utime || !to.utime) return std::nullopt;
    // Stamps are anything; the difference of two must not overflow.
    return std::clamp(*to.utime, -kFarthestUtime, kFarthestUtime) -
           std::clamp(*from.utime, -kFarthestUtime, kFarthestUtime);
}

/// Whether both say the same id: then it is one sender, whatever its numbers and stamps do.
bool known_as_one(const Message& a, const Message& b) {
    return a.sender && a.sender == b.sender;
}

/// Longer steps from message to message are not usual, and times a count they must not overflow.
constexpr std::int64_t kLongestStep_us = std::int64_t{3600} * 1000000;

}  // namespace

std::uint32_t checksum_of(std::span<const std::uint8_t> bytes) {
    return libdeflate_crc32(0, bytes.data(), bytes.size());
}

/// In time, or by number where that says the order or there is no time.
bool SenderGuard::is_after(const Message& from, const Message& to) const {
    const auto elapsed = elapsed_us(from, to), steps = seq_steps(from, to);
    if (elapsed && (order_ == Order::kTime || !steps)) return *elapsed > 0;
    if (elapsed && *elapsed == 0) return false;  // of one moment there is one message
    return steps.value_or(0) > 0;
}

/// Whether the message is of a process that goes on with the state of the one that is followed, which is no
/// more then.
bool SenderGuard::is_started_again(const Message& message) const {
    const auto &before = followed_->last.sender, &now = message.sender;
    return before && now && *before != *now &&
           succeeds(static_cast<std::int64_t>(*now), static_cast<std::int64_t>(*before));
}

bool SenderGuard::same_sender(const Message& a, const Message& b) const {
    if (a.sender || b.sender) return a.sender == b.sender;
    return !a.kind || !b.kind || *a.kind == *b.kind;
}

/// The usual time from one message to the next (median); 0 while it is not known.
std::int64_t SenderGuard::step_us() const {
    const std::size_t n = std::min(n_steps_, steps_us_.size());
    if (n == 0) return 0;
    auto steps = steps_us_;
    return std::min(median_step(std::span(steps).first(n)), kLongestStep_us);
}

/// Whether a message can be of the stream: no further from its last one than pauses, losses and a network's
/// disorder explain.
bool SenderGuard::goes_on(const Stream& stream, const Message& message) const {
    const auto steps = seq_steps(stream.last, message);
    const auto elapsed = elapsed_us(stream.last, message);
    const bool is_ordered = order_ == Order::kNumber || elapsed.value_or(0) >= 0;
    if (steps && *steps > 0 && is_ordered && (*steps <= kMissed || message.sender)) return true;
    if (steps && (*steps < -kReordered || *steps > kMissed)) return false;
    if (!elapsed) return true;
    if (*elapsed > 0 && (n_steps_ == 0 || (message.sender && !steps))) return true;
    return *elapsed <= std::max(kPause_us, kPauses * step_us()) && *elapsed >= -kReordered * step_us();
}

Verdict SenderGuard::judge(const Message& message) {
    news_.clear();
    if (!followed_) {
        followed_ = Stream{message, {}};
        return Verdict::kTake;
    }
    const auto is_of = [&](const Stream& stream) {
        return same_sender(stream.last, message) && goes_on(stream, message);
    };
    if (is_started_again(message)) return switch_to({message, {}});
    if (is_of(*followed_)) return in_order(message);
    const auto found = std::find_if(others_.begin(), others_.end(), is_of);
    if (found == others_.end()) {
        if (others_.size() == kStreams) others_.erase(others_.begin());
        others_.push_back({message, message.utime});
        return judge_aside(others_.back(), !same_sender(followed_->last, message));
    }
    std::rotate(found, found + 1, others_.end());
    return aside(others_.back(), message);
}

/// A message of the stream that is followed.
Verdict SenderGuard::in_order(const Message& message) {
    const Message& last = followed_->last;
    if (is_after(last, message)) {
        follow(message);
        return Verdict::kTake;
    }
    const auto steps = seq_steps(last, message);
    const bool same_place = elapsed_us(last, message).value_or(0) == 0;
    if (same_place && message.checksum == last.checksum) return Verdict::kRepeated;
    if (same_place && steps.value_or(0) == 0) {
        if (!named_)
            news_ = (known_as_one(last, message) ? "the sender on " : "another sender on ") + channel_ +
                    " says other things under the same number and time";
        named_ = true;
        return Verdict::kForeign;
    }
    // What a network brings late has an old number; without numbers, two in a row may be late, not more.
    ++backs_;
    if (steps ? *steps <= 0 : backs_ <= 2) return Verdict::kLate;
    say_back(message);
    return Verdict::kWentBack;
}

/// Once, until another stream is followed.
void SenderGuard::say_back(const Message& message) {
    const auto elapsed = elapsed_us(followed_->last, message);
    if (back_said_ || !elapsed) return;
    back_said_ = true;
    const std::string how = *elapsed < 0 ? "went back by " + seconds_text(-*elapsed) : "did not go on";
    news_ = "a time stamp on " + channel_ + " " + how + "; such messages are not used";
}

void SenderGuard::follow(const Message& message) {
    if (const auto elapsed = elapsed_us(followed_->last, message); elapsed && *elapsed > 0)
        steps_us_[n_steps_++ % steps_us_.size()] = *elapsed;
    const auto kind = message.kind ? message.kind : followed_->last.kind;
    followed_->last = message;
    followed_->last.kind = kind;
    backs_ = 0;
    for (Stream& other : others_) {
        other.interleaved = true;
        other.since_utime.reset();
        other.run = 0;
    }
}

/// A message of a stream that is not followed.
Verdict SenderGuard::aside(Stream& stream, const Message& message) {
    const bool after = is_after(stream.last, message);
    stream.run = after ? stream.run + 1 : 1;
    if (!after || !stream.since_utime) stream.since_utime = message.utime;
    stream.last = message;
    ++stream.heard;
    if (takes_over(stream)) return switch_to(stream);
    return judge_aside(stream, stream.interleaved || !same_sender(followed_->last, message));
}

bool SenderGuard::takes_over(const Stream& stream) const {
    if (!stream.interleaved && same_sender(followed_->last, stream.last))
        return stream.run >= (is_after(followed_->last, stream.last) ? kAhead : kBehind);
    if (!stream.last.utime) return stream.run >= kUntimed;
    return stream.since_utime && *stream.last.utime - *stream.since_utime >= kSilence_us;
}

Verdict SenderGuard::switch_to(const Stream& stream) {
    const auto elapsed = elapsed_us(followed_->last, stream.last);
    const bool one = known_as_one(followed_->last, stream.last);
    if (is_started_again(stream.last)) {
        news_ = "the sender on " + channel_ + " was started again; going on with it";
    } else if ((stream.interleaved && !one) || !same_sender(followed_->last, stream.last)) {
        news_ = "the first sender on " + channel_ + " has been silent for " + seconds_text(kSilence_us) +
                "; another one is followed from here on";
    } else if (elapsed && *elapsed < 0) {
        news_ = "time on " + channel_ + " went back by " + seconds_text(-*elapsed) + "; going on from there";
    } else if (!elapsed) {
        news_ = "the sender on " + channel_ + " started again";
    }
    followed_ = Stream{stream.last, {}};
    others_.clear();
    backs_ = 0;
    named_ = back_said_ = false;
    ++switches_;
    return Verdict::kTake;
}

Verdict SenderGuard::judge_aside(const Stream& stream, bool foreign) {
    if (known_as_one(followed_->last, stream.last)) foreign = false;
    // One message alone may be a damaged one.
    if (foreign && stream.heard > 1 && !named_) {
        named_ = true;
        const bool jumps_only = same_sender(followed_->last, stream.last);
        news_ = jumps_only ? "another sender or messages out of order on " + channel_ +
                                 ": ignored while the first stream lives"
                           : "another sender on " + channel_ + " is ignored while the first one lives";
    }
    if (foreign) return Verdict::kForeign;
    if (is_after(followed_->last, stream.last)) return Verdict::kJumped;
    say_back(stream.last);
    return Verdict::kWentBack;
}

}  // namespace planemap::messages
