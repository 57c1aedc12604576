// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <functional>
#include <lcm/lcm-cpp.hpp>
#include <span>
#include <string>
#include <vector>

#include "messages/complaints.hpp"
#include "messages/connection.hpp"
#include "messages/error.hpp"
#include "messages/wall_clock.hpp"

namespace planemap::messages {

/// One message as it came off the bus; the bytes live as long as the handler runs.
struct RawMessage {
    std::string_view channel;
    std::span<const std::uint8_t> bytes;
    std::int64_t recv_utime = 0;  ///< wall clock at reception, microseconds
};

/// One LCM connection. Handlers run in handle(), one after the other, on the caller's thread, and may throw:
/// nothing gets through the C library, the exception is counted, and logged by its kind.
///
/// A bus outlives its network. Where there is no connection (no server, an interface that is down), handle()
/// tries every second to make a new one with the same subscriptions, and what is published meanwhile is
/// counted and not sent. A tcpq server that hangs (takes or gives no byte of a message for three seconds) is
/// one that there is no connection to; until then sending waits, since a slow one loses nothing.
class Bus {
  public:
    using Handler = std::function<void(const RawMessage&)>;

    /// Opens an LCM URL; empty means LCM_DEFAULT_URL, or LCM's default. A udpm URL without recv_buf_size gets
    /// 4 MiB, since without it no camera frame arrives. Throws std::runtime_error that names the URL and the
    /// reason if it is malformed, or a log that cannot be read.
    ///
    /// Each channel's name on the bus begins with `channel_prefix`, so that two cameras or robots can share a
    /// bus; whoever publishes, subscribes or handles a message here writes it without. Throws
    /// std::invalid_argument that names the prefix and what is allowed: at most channels::kMaxChannelPrefix
    /// letters, digits and characters of _-/.
    explicit Bus(const std::string& url = "", const std::string& channel_prefix = "");
    Bus(const Bus&) = delete;
    Bus& operator=(const Bus&) = delete;

    /// The URL after completion.
    const std::string& url() const { return connection_.endpoint().url(); }
    const std::string& channel_prefix() const { return prefix_; }
    /// True for memq://, where nothing may be dropped.
    bool in_process() const { return connection_.endpoint().in_process(); }
    /// True where what comes was sent just now: not on memq://, nor from a log.
    bool is_network() const { return connection_.endpoint().is_network(); }

    /// Tells what this process sends from what another one sends, or it itself before it started again: drawn
    /// at random, not 0. In one process 0, so that the same input gives the same bytes.
    std::int64_t session() const { return session_; }
    /// Goes on as what a process of this session sent (see messages/session.hpp); before anything is
    /// published.
    void go_on_as(std::int64_t session) { session_ = session; }

    /// Sends a message. Throws std::invalid_argument for a channel that is too long for LCM. One that cannot
    /// be sent (no connection, too large) is counted; trouble() says how many.
    template <typename T>
    void publish(const std::string& channel, const T& message) {
        const int size = message.getEncodedSize();
        buffer_.resize(static_cast<std::size_t>(size));
        if (message.encode(buffer_.data(), 0, size) != size)
            throw std::logic_error(channel + ": cannot be encoded");
        publish_bytes(channel, buffer_);
    }
    void publish_bytes(const std::string& channel, std::span<const std::uint8_t> bytes);

    /// Calls the handler for each message on a channel (an anchored regular expression). At most `capacity`
    /// messages wait; then the newest is dropped (liblcm's rule). On memq:// the queue is unlimited: nothing
    /// is dropped.
    void subscribe(const std::string& channel, Handler handler, int capacity = 30);

    /// Waits at most timeout_ms for messages and handles one. Returns false on timeout, a signal, or without
    /// a connection; then it is tried to make one, once a second (a second at most, a signal ends it).
    bool handle(int timeout_ms) { return connection_.receive(timeout_ms); }
    /// Handles until nothing waits; for memq://.
    void drain();

    /// False while there is no connection.
    bool connected() const { return connection_.is_up(); }
    /// True when a file:// URL's log has been read to its end, or to a record that liblcm cannot read.
    bool ended() const { return connection_.ended(); }
    /// What keeps the bus from working, how many messages could not be sent, and how often one that came
    /// could not be used, for the status; empty if all is well.
    std::string trouble() const;

    /// Counts and logs (by its kind) a message that was dropped; for shells that find out after their handler
    /// returned. Several shells of a process that drop one message for one reason are one complaint.
    void report(std::string_view channel, const char* reason);
    /// What went wrong on this bus, by its kind; shells add theirs.
    Complaints& complaints() { return complaints_; }
    const Complaints& complaints() const { return complaints_; }

  private:
    void dispatch(const Handler& handler, const std::string& channel, const lcm::ReceiveBuffer& buffer);
    std::string full_name(const std::string& channel) const;

    std::string prefix_;
    std::vector<std::uint8_t> buffer_;
    Complaints complaints_;
    std::int64_t session_ = 0;
    std::int64_t reported_ = 0;  ///< the message received when report() was last called
    std::string reported_reason_;
    Connection connection_;  ///< last: it uses complaints_, and ends before what its handlers use
};

/// The line that tells how to raise the kernel's bound if it is below the URL's recv_buf_size; empty if all
/// is well.
std::string receive_buffer_advice(const std::string& url);

}  // namespace planemap::messages
