// SPDX-License-Identifier: BSD-3-Clause
#include "messages/connection.hpp"

#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <spdlog/spdlog.h>
#include <sys/socket.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cstring>
#include <ctime>
#include <stdexcept>
#include <thread>
#include <utility>

#include "messages/interrupt.hpp"
#include "messages/reassembly.hpp"
#include "messages/wall_clock.hpp"

namespace planemap::messages {

namespace {

constexpr std::int64_t kRetryUs = 1000000;

/// Errors of a send that another interface, route or address may cure.
bool is_network_error(int error) {
    switch (error) {
        case ENETDOWN:
        case ENETUNREACH:
        case EHOSTDOWN:
        case EHOSTUNREACH:
        case ENODEV:
        case ENXIO:
        case EADDRNOTAVAIL:
            return true;
        default:
            return false;
    }
}

/// Without a byte taken or given for so long, a server in the middle of a message counts as hung.
constexpr int kStall_s = 3;

/// A server that vanishes or hangs without a word must not stop a module: the kernel asks an idle one after
/// five seconds, a message that stops in the middle ends the connection. Sending waits for slow receivers,
/// that is how nothing is lost, as long as some bytes go.
void bound_waiting(int socket) {
    const int on = 1, idle_s = 5, interval_s = 1, count = 5;
    const timeval stall = {kStall_s, 0};
    const unsigned stall_ms = 1000 * kStall_s;
    ::setsockopt(socket, SOL_SOCKET, SO_KEEPALIVE, &on, sizeof(on));
    ::setsockopt(socket, IPPROTO_TCP, TCP_KEEPIDLE, &idle_s, sizeof(idle_s));
    ::setsockopt(socket, IPPROTO_TCP, TCP_KEEPINTVL, &interval_s, sizeof(interval_s));
    ::setsockopt(socket, IPPROTO_TCP, TCP_KEEPCNT, &count, sizeof(count));
    // By itself SO_SNDTIMEO starts again for each piece of a message that the kernel finds room for.
    ::setsockopt(socket, IPPROTO_TCP, TCP_USER_TIMEOUT, &stall_ms, sizeof(stall_ms));
    ::setsockopt(socket, SOL_SOCKET, SO_RCVTIMEO, &stall, sizeof(stall));
    ::setsockopt(socket, SOL_SOCKET, SO_SNDTIMEO, &stall, sizeof(stall));
}

/// Why a server's connection is of no use any more, after a call of liblcm that began at this time and left
/// this errno (if it did).
std::string server_loss(std::int64_t began_us, int error) {
    const bool timed_out = error == ETIMEDOUT || error == EAGAIN;
    if (!timed_out && now_us() - began_us < std::int64_t{kStall_s} * 1000000) return "the server is gone";
    return "the server hangs: no byte of a message went for " + std::to_string(kStall_s) + " s";
}

std::string clock_text(std::int64_t utime) {
    const std::time_t seconds = utime / 1000000;
    std::tm parts = {};
    ::gmtime_r(&seconds, &parts);
    char text[32];
    std::strftime(text, sizeof(text), "%Y-%m-%d %H:%M:%S UTC", &parts);
    return text;
}

/// The tcpq socket on which liblcm sends or receives just now; -1: none.
std::atomic<int> waiting_socket{-1};
static_assert(std::atomic<int>::is_always_lock_free);

class Waiting {
  public:
    explicit Waiting(int socket) : before_(waiting_socket.exchange(socket)) {}
    ~Waiting() { waiting_socket = before_; }
    Waiting(const Waiting&) = delete;
    Waiting& operator=(const Waiting&) = delete;

  private:
    int before_;  ///< handlers publish while a message is handled
};

}  // namespace

void interrupt_waiting() {
    const int socket = waiting_socket.load();
    if (socket >= 0) ::shutdown(socket, SHUT_RDWR);
}

Connection::Connection(const std::string& url, Complaints& complaints)
    : endpoint_(url), complaints_(complaints) {
    if (endpoint_.is_multicast()) reassemblies_failed_before_ = failed_reassemblies();
    if (!connect() && !endpoint_.is_network())
        throw std::runtime_error("LCM URL '" + endpoint_.url() + "': " + lost_reason_);
}

Connection::~Connection() {
    discard();
}

/// Ends the connection. Of one to a server that is gone, liblcm tries to make it again for each subscription
/// that it takes back, which may block for minutes: on a thread that nobody waits for.
void Connection::discard() {
    const bool server_gone = lcm_ && broken_ && is_to_server();
    if (server_gone) std::thread([gone = std::move(lcm_)] {}).detach();
    lcm_.reset();
}

/// Makes a new connection with all subscriptions.
bool Connection::connect() {
    last_attempt_us_ = now_us();
    discard();
    broken_ = false;
    if (const std::string reason = open(); !reason.empty()) {
        lose(reason);
        return false;
    }
    if (lost_us_ > 0) {
        spdlog::info("LCM URL '{}': connected after {:.0f} s; {} messages could not be sent so far",
                     endpoint_.url(), static_cast<double>(now_us() - lost_us_) * 1e-6, unsent_);
    }
    lost_us_ = 0;
    return true;
}

/// Returns why it cannot be opened; empty: it is open. Asks without liblcm first: that would block and print.
std::string Connection::open() {
    if (std::string reason = endpoint_.unreachable(); !reason.empty()) return reason;
    lcm_ = std::make_unique<lcm::LCM>(endpoint_.url_for_liblcm());
    if (!lcm_->good() || lcm_->getFileno() < 0) return "cannot be opened";
    if (is_to_server()) bound_waiting(lcm_->getFileno());
    for (const auto& subscriber : subscribers_)
        if (!attach(*subscriber)) return "cannot subscribe to " + subscriber->channels;
    return {};
}

/// Ends the use of the connection. Said once for each time that it is lost.
void Connection::lose(const std::string& reason) {
    broken_ = true;
    lost_reason_ = reason;
    if (lost_us_ > 0 || !endpoint_.is_network()) return;
    lost_us_ = now_us();
    complaints_.add("LCM URL '" + endpoint_.url() + "': no connection (" + reason + "); trying every second");
}

void Connection::wait_and_reconnect(int timeout_ms) {
    const std::int64_t left_us = last_attempt_us_ + kRetryUs - now_us();
    if (left_us <= 0 || left_us > kRetryUs) {  // also when the clock was set back
        connect();
        return;
    }
    ::poll(nullptr, 0, std::min(timeout_ms, static_cast<int>(left_us / 1000 + 1)));
}

std::string Connection::trouble() const {
    std::string text;
    if (lost_us_ > 0) {
        text = "no connection to " + endpoint_.url() + " since " + clock_text(lost_us_) + " (" +
               lost_reason_ + "), trying every second";
    }
    if (unsent_ > 0)
        text += (text.empty() ? "" : "; ") + std::to_string(unsent_) + " messages could not be sent";
    const std::int64_t incomplete =
        reassemblies_failed_before_
            ? failed_reassemblies().value_or(*reassemblies_failed_before_) - *reassemblies_failed_before_
            : 0;
    if (incomplete > 0) {
        text += (text.empty() ? "" : "; ") + std::to_string(incomplete) +
                " UDP packets reached this host incomplete, and what they held is lost (docs/hosts.md says "
                "what helps)";
    }
    return text;
}

void Connection::send(const std::string& channel, std::span<const std::uint8_t> bytes) {
    if (!is_up()) {
        ++unsent_;
        return;
    }
    // Of a message in parts, liblcm passes no error on but the last one's errno.
    const bool server = is_to_server();
    const Waiting waiting(server ? lcm_->getFileno() : -1);
    const std::int64_t began_us = now_us();
    errno = 0;
    const int result = lcm_->publish(channel, bytes.data(), static_cast<unsigned>(bytes.size()));
    const int error = errno;
    const bool network = !server && endpoint_.is_network() && is_network_error(error);
    const bool server_gone = server && result != 0;
    if (result == 0 && !network) return;
    ++unsent_;
    if (network || server_gone) {
        lose(network ? std::string("cannot send: ") + std::strerror(error) : server_loss(began_us, error));
        return;
    }
    complaints_.add("LCM URL '" + endpoint_.url() + "': " + channel + " (" + std::to_string(bytes.size()) +
                    " bytes) cannot be sent");
}

void Connection::subscribe(const std::string& channels, Listener listener, int capacity) {
    subscribers_.push_back(std::make_unique<Subscriber>(Subscriber{channels, std::move(listener), capacity}));
    if (!is_up() || attach(*subscribers_.back())) return;
    if (!endpoint_.is_network())
        throw std::runtime_error("LCM URL '" + endpoint_.url() + "': cannot subscribe to " + channels);
    lose("cannot subscribe to " + channels);
}

bool Connection::attach(Subscriber& subscriber) {
    lcm::Subscription* subscription =
        lcm_->subscribeFunction(subscriber.channels, &Connection::dispatch, &subscriber);
    if (subscription == nullptr || lcm_->getFileno() < 0) return false;
    subscription->setQueueCapacity(endpoint_.in_process() ? 0 : subscriber.capacity);
    return true;
}

void Connection::dispatch(const lcm::ReceiveBuffer* buffer, const std::string& channel,
                          Subscriber* subscriber) {
    const Waiting working(-1);
    subscriber->listener(channel, *buffer);
}

bool Connection::receive(int timeout_ms) {
    if (!is_up()) {
        wait_and_reconnect(timeout_ms);
        return false;
    }
    // Not handleTimeout(): its select() ends the process for a descriptor that is none, or above 1023.
    pollfd ready = {lcm_->getFileno(), POLLIN, 0};
    const int waiting = ready.fd < 0 ? -1 : ::poll(&ready, 1, timeout_ms);
    if (waiting == 0 || (waiting < 0 && errno == EINTR)) return false;
    ++received_;
    const std::int64_t began_us = now_us();
    errno = 0;
    {
        const Waiting receiving(is_to_server() ? ready.fd : -1);
        if (waiting > 0 && lcm_->handle() == 0) return true;
    }
    const int error = errno;
    if (endpoint_.is_log()) {
        spdlog::info("LCM URL '{}': the log is read to its end, or to a record that liblcm cannot read",
                     endpoint_.url());
        ended_ = true;
        return false;
    }
    if (!endpoint_.is_network())
        throw std::runtime_error("LCM URL '" + endpoint_.url() + "': receiving failed");
    lose(endpoint_.is_multicast() ? "receiving failed" : server_loss(began_us, error));
    last_attempt_us_ = 0;  // whatever broke may be whole at once
    return false;
}

}  // namespace planemap::messages
