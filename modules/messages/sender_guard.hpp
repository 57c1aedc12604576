// SPDX-License-Identifier: BSD-3-Clause
// LCM does not tell who sent a message. This is the one rule for telling senders apart.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace planemap::messages {

/// Follows one sender on a channel: the first. Another one is named and ignored until the first has been
/// silent for kSilence_us of the other's time stamps. Time comes from the messages, so that a replay repeats.
///
/// One that was started again and goes on with its state (messages/session.hpp) is followed at once.
///
/// Two messages are of different senders when they say different sender ids or are of different kinds.
/// Without ids, those that jump away from the stream and go on from there are another stream: of the same
/// sender after a pause, or one that started again, if nothing of the first comes in between; else of another
/// sender.
class SenderGuard {
  public:
    static constexpr std::int64_t kSilence_us = 2000000;

    /// What a message tells of its sender. Nothing: it does not say.
    struct Message {
        std::optional<std::uint64_t> sender;  ///< the id that its sender gave itself
        std::optional<std::uint32_t> kind;    ///< of what form it is
        std::optional<std::uint32_t> seq;     ///< counts messages of the sender
        std::optional<std::int64_t> utime;    ///< time stamp; without it only seq orders the stream
        std::uint32_t checksum = 0;           ///< of its bytes
    };

    enum class Verdict {
        kTake,      ///< the next of the stream
        kRepeated,  ///< the last one once more, byte for byte
        kLate,      ///< came after later ones, or twice
        kWentBack,  ///< its time stamp (without one: its seq) goes back, and the stream does not go on from
                    ///< there
        kJumped,    ///< far ahead of the stream; what comes next tells whether that goes on from there
        kForeign,   ///< of another sender
    };

    /// What says which message of a sender is the later one.
    enum class Order {
        kTime,    ///< its stamp, where it has one
        kNumber,  ///< its number: a module of ours, whose time goes back where its input's does
    };

    explicit SenderGuard(std::string channel, Order order = Order::kTime)
        : channel_(std::move(channel)), order_(order) {}

    Verdict judge(const Message& message);
    /// How often another stream became the one that is followed.
    int switches() const { return switches_; }
    /// A line that the last message gave reason to say, each once; else empty.
    const std::string& news() const { return news_; }

  private:
    /// Messages that go on from one another.
    struct Stream {
        Message last;
        std::optional<std::int64_t> since_utime;  ///< of its first one since the last of the one followed
        int run = 1;                              ///< messages since then, each after the one before
        int heard = 1;                            ///< messages in all
        bool interleaved = false;                 ///< the one followed went on after this one had begun
    };

    bool is_after(const Message& from, const Message& to) const;
    bool is_started_again(const Message& message) const;
    bool same_sender(const Message& a, const Message& b) const;
    bool goes_on(const Stream& stream, const Message& message) const;
    std::int64_t step_us() const;
    Verdict in_order(const Message& message);
    void say_back(const Message& message);
    void follow(const Message& message);
    Verdict aside(Stream& stream, const Message& message);
    Verdict switch_to(const Stream& stream);
    bool takes_over(const Stream& stream) const;
    Verdict judge_aside(const Stream& stream, bool foreign);

    std::string channel_, news_;
    Order order_;
    std::optional<Stream> followed_;
    std::vector<Stream> others_;              ///< a few, the one heard last at the end
    std::array<std::int64_t, 8> steps_us_{};  ///< of time between the last messages followed
    std::size_t n_steps_ = 0;
    int backs_ = 0;  ///< messages in a row that went back
    int switches_ = 0;
    bool named_ = false, back_said_ = false;  ///< in news()
};

/// CRC-32 of a message, for SenderGuard::Message::checksum.
std::uint32_t checksum_of(std::span<const std::uint8_t> bytes);

}  // namespace planemap::messages
