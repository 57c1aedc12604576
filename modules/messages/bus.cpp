// SPDX-License-Identifier: BSD-3-Clause
#include "messages/bus.hpp"

#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <spdlog/spdlog.h>
#include <sys/socket.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <fstream>
#include <stdexcept>
#include <thread>

#include "messages/channels.hpp"
#include "messages/interrupt.hpp"
#include "messages/reassembly.hpp"
#include "messages/session.hpp"

namespace planemap::messages {

namespace {

constexpr const char* kDefaultUrl = "udpm://239.255.76.67:7667?ttl=0";
constexpr const char* kReceiveBuffer = "recv_buf_size=";
constexpr long kReceiveBufferBytes = 4 << 20;

std::string completed(std::string url) {
    if (url.empty()) {
        const char* environment = std::getenv("LCM_DEFAULT_URL");
        url = environment != nullptr && *environment != '\0' ? environment : kDefaultUrl;
    }
    if (url.rfind("udpm://", 0) == 0 && url.find(kReceiveBuffer) == std::string::npos) {
        url += url.find('?') == std::string::npos ? '?' : '&';
        url += kReceiveBuffer + std::to_string(kReceiveBufferBytes);
    }
    return url;
}

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

struct Bus::Subscriber {
    Bus* bus;
    std::string channel;
    Handler handler;
    int capacity;
};

std::int64_t now_us() {
    using namespace std::chrono;
    return duration_cast<microseconds>(system_clock::now().time_since_epoch()).count();
}

std::string receive_buffer_advice(const std::string& url) {
    const auto at = url.find(kReceiveBuffer);
    if (url.rfind("udpm://", 0) != 0 || at == std::string::npos) return {};
    const long wanted = std::strtol(url.c_str() + at + std::string(kReceiveBuffer).size(), nullptr, 10);
    long allowed = 0;
    if (!(std::ifstream("/proc/sys/net/core/rmem_max") >> allowed) || allowed >= wanted) return {};
    return "the kernel caps the receive buffer at " + std::to_string(allowed) +
           " bytes, frames may be lost: run `sysctl -w net.core.rmem_max=" + std::to_string(wanted) + "`";
}

namespace {

/// Subscriptions are regular expressions: no character of a prefix may mean anything in one.
const std::string& checked_prefix(const std::string& prefix) {
    constexpr const char* kAllowed = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-/";
    if (prefix.size() <= channels::kMaxChannelPrefix &&
        prefix.find_first_not_of(kAllowed) == std::string::npos)
        return prefix;
    throw std::invalid_argument("the channel prefix '" + prefix + "' must be at most " +
                                std::to_string(channels::kMaxChannelPrefix) +
                                " letters, digits and characters of _-/");
}

}  // namespace

Bus::Bus(const std::string& url, const std::string& channel_prefix)
    : endpoint_(completed(url)), prefix_(checked_prefix(channel_prefix)) {
    if (!in_process()) session_ = random_session();
    if (endpoint_.is_multicast()) reassemblies_failed_before_ = failed_reassemblies();
    if (!connect() && !endpoint_.is_network())
        throw std::runtime_error("LCM URL '" + this->url() + "': " + lost_reason_);
    const std::string advice = receive_buffer_advice(this->url());
    if (!advice.empty()) spdlog::warn("{}", advice);
}

Bus::~Bus() {
    discard();
}

/// The channel as the bus knows it. liblcm would print a line, on some transports, and send nothing.
std::string Bus::full_name(const std::string& channel) const {
    std::string name = prefix_ + channel;
    if (name.size() <= channels::kMaxChannel) return name;
    throw std::invalid_argument("the channel " + name + " has " + std::to_string(name.size()) +
                                " characters; LCM allows " + std::to_string(channels::kMaxChannel));
}

/// Ends the connection. Of one to a server that is gone, liblcm tries to make it again for each subscription
/// that it takes back, which may block for minutes: on a thread that nobody waits for.
void Bus::discard() {
    const bool server_gone = lcm_ && broken_ && endpoint_.is_network() && !endpoint_.is_multicast();
    if (server_gone) std::thread([gone = std::move(lcm_)] {}).detach();
    lcm_.reset();
}

/// Makes a new connection with all subscriptions. Asks without liblcm first: that would block and print.
bool Bus::connect() {
    last_attempt_us_ = now_us();
    discard();
    broken_ = false;
    std::string reason = endpoint_.unreachable();
    if (reason.empty()) {
        lcm_ = std::make_unique<lcm::LCM>(endpoint_.url_for_liblcm());
        if (!lcm_->good() || lcm_->getFileno() < 0) {
            reason = "cannot be opened";
        } else {
            if (endpoint_.is_network() && !endpoint_.is_multicast()) bound_waiting(lcm_->getFileno());
            for (const auto& subscriber : subscribers_) {
                if (reason.empty() && !attach(*subscriber))
                    reason = "cannot subscribe to " + subscriber->channel;
            }
        }
    }
    if (!reason.empty()) {
        lose(reason);
        return false;
    }
    if (lost_us_ > 0) {
        spdlog::info("LCM URL '{}': connected after {:.0f} s; {} messages could not be sent so far", url(),
                     static_cast<double>(now_us() - lost_us_) * 1e-6, unsent_);
    }
    lost_us_ = 0;
    return true;
}

/// Ends the use of the connection. Said once for each time that it is lost.
void Bus::lose(const std::string& reason) {
    broken_ = true;
    lost_reason_ = reason;
    if (lost_us_ > 0 || !endpoint_.is_network()) return;
    lost_us_ = now_us();
    complaints_.add("LCM URL '" + url() + "': no connection (" + reason + "); trying every second");
}

void Bus::wait_and_reconnect(int timeout_ms) {
    const std::int64_t left_us = last_attempt_us_ + kRetryUs - now_us();
    if (left_us <= 0 || left_us > kRetryUs) {  // also when the clock was set back
        connect();
        return;
    }
    ::poll(nullptr, 0, std::min(timeout_ms, static_cast<int>(left_us / 1000 + 1)));
}

std::string Bus::trouble() const {
    std::string text;
    if (lost_us_ > 0) {
        text = "no connection to " + url() + " since " + clock_text(lost_us_) + " (" + lost_reason_ +
               "), trying every second";
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

void Bus::publish_bytes(const std::string& channel, std::span<const std::uint8_t> bytes) {
    const std::string name = full_name(channel);
    if (!connected()) {
        ++unsent_;
        return;
    }
    // Of a message in parts, liblcm passes no error on but the last one's errno.
    const bool server = endpoint_.is_network() && !endpoint_.is_multicast();
    const Waiting waiting(server ? lcm_->getFileno() : -1);
    const std::int64_t began_us = now_us();
    errno = 0;
    const int result = lcm_->publish(name, bytes.data(), static_cast<unsigned>(bytes.size()));
    const int error = errno;
    const bool network = !server && endpoint_.is_network() && is_network_error(error);
    const bool server_gone = server && result != 0;
    if (result == 0 && !network) return;
    ++unsent_;
    if (network || server_gone) {
        lose(network ? std::string("cannot send: ") + std::strerror(error) : server_loss(began_us, error));
        return;
    }
    complaints_.add("LCM URL '" + url() + "': " + name + " (" + std::to_string(bytes.size()) +
                    " bytes) cannot be sent");
}

void Bus::subscribe(const std::string& channel, Handler handler, int capacity) {
    subscribers_.push_back(
        std::make_unique<Subscriber>(Subscriber{this, channel, std::move(handler), capacity}));
    if (!connected() || attach(*subscribers_.back())) return;
    if (!endpoint_.is_network())
        throw std::runtime_error("LCM URL '" + url() + "': cannot subscribe to " + channel);
    lose("cannot subscribe to " + channel);
}

bool Bus::attach(Subscriber& subscriber) {
    const bool alternatives = subscriber.channel.find('|') != std::string::npos;
    const std::string pattern = alternatives ? "(" + subscriber.channel + ")" : subscriber.channel;
    lcm::Subscription* subscription = lcm_->subscribeFunction(prefix_ + pattern, &Bus::dispatch, &subscriber);
    if (subscription == nullptr || lcm_->getFileno() < 0) return false;
    subscription->setQueueCapacity(in_process() ? 0 : subscriber.capacity);
    return true;
}

void Bus::dispatch(const lcm::ReceiveBuffer* buffer, const std::string& channel, Subscriber* subscriber) {
    const Waiting working(-1);
    try {
        const auto* bytes = static_cast<const std::uint8_t*>(buffer->data);
        const std::string_view name = std::string_view(channel).substr(subscriber->bus->prefix_.size());
        subscriber->handler({name, {bytes, buffer->data_size}, buffer->recv_utime});
    } catch (const std::exception& error) {
        subscriber->bus->report(channel, error.what());
    } catch (...) {
        subscriber->bus->report(channel, "unknown exception");
    }
}

void Bus::report(std::string_view channel, const char* reason) {
    ++handler_errors_;
    if (reported_ == handled_ && reported_reason_ == reason) return;
    reported_ = handled_;
    reported_reason_ = reason;
    complaints_.add(std::string(channel) + ": message dropped: " + reason);
}

bool Bus::handle(int timeout_ms) {
    if (!connected()) {
        wait_and_reconnect(timeout_ms);
        return false;
    }
    // Not handleTimeout(): its select() ends the process for a descriptor that is none, or above 1023.
    pollfd ready = {lcm_->getFileno(), POLLIN, 0};
    const int waiting = ready.fd < 0 ? -1 : ::poll(&ready, 1, timeout_ms);
    if (waiting == 0 || (waiting < 0 && errno == EINTR)) return false;
    ++handled_;
    const std::int64_t began_us = now_us();
    errno = 0;
    {
        const bool server = endpoint_.is_network() && !endpoint_.is_multicast();
        const Waiting receiving(server ? ready.fd : -1);
        if (waiting > 0 && lcm_->handle() == 0) return true;
    }
    if (endpoint_.is_log()) {
        spdlog::info("LCM URL '{}': the log is read to its end, or to a record that liblcm cannot read",
                     url());
        ended_ = true;
        return false;
    }
    if (!endpoint_.is_network()) throw std::runtime_error("LCM URL '" + url() + "': receiving failed");
    lose(endpoint_.is_multicast() ? "receiving failed" : server_loss(began_us, errno));
    last_attempt_us_ = 0;  // whatever broke may be whole at once
    return false;
}

void Bus::drain() {
    while (handle(0)) {
    }
}

}  // namespace planemap::messages
