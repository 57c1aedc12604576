// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <functional>
#include <lcm/lcm-cpp.hpp>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "messages/complaints.hpp"
#include "messages/endpoint.hpp"

namespace planemap::messages {

/// A connection of liblcm that outlives its network: where there is none (no server, an interface that is
/// down), receive() tries every second to make a new one with the same subscriptions, and what is sent
/// meanwhile is counted. Knows channels by the names that they have on the network, and nothing of what the
/// messages hold.
class Connection {
  public:
    /// Hears of one message; the buffer lives as long as it runs. Does not throw: C code calls it.
    using Listener = std::function<void(const std::string& channel, const lcm::ReceiveBuffer& buffer)>;

    /// Connects, if that is possible now. Throws std::runtime_error that names the URL and the reason if it
    /// is malformed, or what it names is no network and cannot be opened. The complaints must outlive it.
    Connection(const std::string& url, Complaints& complaints);
    ~Connection();
    Connection(const Connection&) = delete;
    Connection& operator=(const Connection&) = delete;

    const Endpoint& endpoint() const { return endpoint_; }
    /// False while there is no connection.
    bool is_up() const { return lcm_ != nullptr && !broken_; }
    /// True when a log has been read to its end, or to a record that liblcm cannot read.
    bool ended() const { return ended_; }
    /// Messages received so far; while listeners run, the number of theirs.
    std::int64_t received() const { return received_; }
    /// What keeps messages from going or coming, for the status; empty if all is well.
    std::string trouble() const;

    /// Calls the listener for each message on the channels that an anchored regular expression matches. At
    /// most `capacity` messages wait, on memq:// any number. Throws std::runtime_error if what the URL names
    /// is no network and refuses.
    void subscribe(const std::string& channels, Listener listener, int capacity);
    /// Sends a message on a channel that is not too long for LCM; counts it if that fails.
    void send(const std::string& channel, std::span<const std::uint8_t> bytes);
    /// Waits at most timeout_ms for messages and gives one to its listeners. False on timeout, a signal, or
    /// without a connection; then it is tried to make one, once a second (a second at most, a signal ends
    /// it).
    bool receive(int timeout_ms);

  private:
    struct Subscriber {
        std::string channels;
        Listener listener;
        int capacity;
    };
    static void dispatch(const lcm::ReceiveBuffer* buffer, const std::string& channel,
                         Subscriber* subscriber);
    bool is_to_server() const { return endpoint_.is_network() && !endpoint_.is_multicast(); }
    bool connect();
    std::string open();
    void discard();
    bool attach(Subscriber& subscriber);
    void wait_and_reconnect(int timeout_ms);
    void lose(const std::string& reason);

    Endpoint endpoint_;
    Complaints& complaints_;
    std::unique_ptr<lcm::LCM> lcm_;
    std::vector<std::unique_ptr<Subscriber>> subscribers_;
    std::int64_t received_ = 0, unsent_ = 0;
    bool broken_ = false;  ///< lcm_ is of no use any more; it goes where none of its handlers runs
    bool ended_ = false;
    std::string lost_reason_;
    std::optional<std::int64_t> reassemblies_failed_before_;  ///< multicast only
    std::int64_t lost_us_ = 0, last_attempt_us_ = 0;
};

}  // namespace planemap::messages
