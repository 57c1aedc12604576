// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <functional>
#include <lcm/lcm-cpp.hpp>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "messages/error.hpp"

namespace planemap {

/// One message as it came off the bus; the bytes live as long as the handler runs.
struct RawMessage {
    std::string_view channel;
    std::span<const std::uint8_t> bytes;
    std::int64_t recv_utime = 0;  ///< wall clock at reception, microseconds
};

/// One LCM connection. Handlers run in handle(), one after the other, on the caller's thread, and may throw:
/// nothing gets through the C library, the exception is counted and logged once per burst.
class Bus {
  public:
    using Handler = std::function<void(const RawMessage&)>;

    /// Opens an LCM URL; empty means LCM_DEFAULT_URL, or LCM's default. A udpm URL without recv_buf_size gets
    /// 4 MiB, since without it no camera frame arrives. Throws std::runtime_error that names the URL if it
    /// cannot be opened.
    explicit Bus(const std::string& url = "");
    ~Bus();
    Bus(const Bus&) = delete;
    Bus& operator=(const Bus&) = delete;

    /// The URL after completion.
    const std::string& url() const { return url_; }
    /// True for memq://, where nothing may be dropped.
    bool in_process() const { return url_.rfind("memq://", 0) == 0; }

    /// Sends a message. Throws std::runtime_error naming URL and channel if LCM refuses it (e.g. too large,
    /// no server).
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

    /// Waits at most timeout_ms for messages and handles one. Returns false on timeout.
    /// Throws std::runtime_error when the connection fails.
    bool handle(int timeout_ms);
    /// Handles until nothing waits; for memq://.
    void drain();

    /// Counts and logs (once per burst) a message that was dropped; for shells that find out after their
    /// handler returned.
    void report(std::string_view channel, const char* reason);
    /// Messages dropped so, and handlers that threw, since the start.
    std::int64_t handler_errors() const { return handler_errors_; }

  private:
    struct Subscriber;
    static void dispatch(const lcm::ReceiveBuffer* buffer, const std::string& channel,
                         Subscriber* subscriber);

    std::string url_;
    std::unique_ptr<lcm::LCM> lcm_;
    std::vector<std::unique_ptr<Subscriber>> subscribers_;
    std::vector<std::uint8_t> buffer_;
    std::int64_t handler_errors_ = 0;
    std::int64_t last_report_us_ = 0;
};

/// Wall clock, microseconds since the epoch.
std::int64_t now_us();

/// The line that tells how to raise the kernel's bound if it is below the URL's recv_buf_size; empty if all
/// is well.
std::string receive_buffer_advice(const std::string& url);

}  // namespace planemap
