// SPDX-License-Identifier: BSD-3-Clause
#include "messages/stream_guard.hpp"

#include <spdlog/spdlog.h>

namespace planemap::messages {

namespace {

SenderGuard::Message told(std::int64_t session, std::int32_t seq, std::optional<std::int64_t> utime,
                          std::span<const std::uint8_t> bytes) {
    SenderGuard::Message message;
    if (session != 0) message.sender = static_cast<std::uint64_t>(session);
    message.seq = static_cast<std::uint32_t>(seq);
    message.utime = utime;
    message.checksum = checksum_of(bytes);
    return message;
}

}  // namespace

void StreamGuard::resume(std::int64_t session, std::int32_t seq, std::optional<std::int64_t> utime,
                         std::span<const std::uint8_t> bytes) {
    guard_ = SenderGuard(channel_, SenderGuard::Order::kNumber);
    guard_.judge(told(session, seq, utime, bytes));
}

bool StreamGuard::admits(std::int64_t session, std::int32_t seq, std::optional<std::int64_t> utime,
                         std::span<const std::uint8_t> bytes) {
    using Verdict = SenderGuard::Verdict;
    const SenderGuard::Message message = told(session, seq, utime, bytes);
    const Verdict verdict = guard_.judge(message);
    if (!guard_.news().empty()) spdlog::warn("{}", guard_.news());
    if (verdict == Verdict::kRepeated) {
        // A sender with a session sends on purpose what another module missed: no reason to warn.
        if (main_stream_ && session == 0) status_.lost(things_ + " that came twice");
        if (main_stream_ && session != 0) status_.count_loss(things_ + " that came twice");
        return false;
    }
    if (verdict == Verdict::kLate && !main_stream_) {
        status_.lost(things_ + " that came late");
        return false;
    }
    if (main_stream_ && verdict != Verdict::kForeign) status_.received(message.seq);
    if (verdict != Verdict::kForeign && verdict != Verdict::kWentBack) return true;
    status_.lost(things_ +
                 (verdict == Verdict::kForeign ? " of another sender" : " from before those that came"));
    if (main_stream_) status_.dropped();
    return false;
}

}  // namespace planemap::messages
