// SPDX-License-Identifier: BSD-3-Clause
#include "messages/endpoint.hpp"

#include <arpa/inet.h>
#include <netdb.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <chrono>
#include <condition_variable>
#include <cstring>
#include <mutex>
#include <stdexcept>
#include <thread>
#include <vector>

#include "messages/file_bytes.hpp"

namespace planemap::messages {

namespace {

constexpr int kWaitMs = 300;
constexpr std::uint16_t kMulticastPort = 7667, kServerPort = 7700;  // liblcm's defaults

[[noreturn]] void malformed(const std::string& url, const std::string& why) {
    throw std::runtime_error("LCM URL '" + url + "': " + why);
}

/// A whole number from first to last; throws for anything else.
long number_in(const std::string& url, const char* what, const std::string& text, long first, long last) {
    long value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size() || value < first || value > last) {
        malformed(url, std::string(what) + " is '" + text + "', it must be " + std::to_string(first) +
                           " to " + std::to_string(last));
    }
    return value;
}

/// The parameters that liblcm knows; it takes others without a word.
std::vector<std::string> known_parameters(const std::string& provider) {
    if (provider == "udpm" || provider == "mpudpm") return {"recv_buf_size", "ttl"};
    if (provider == "file") return {"mode", "speed", "start_timestamp"};
    return {};
}

/// The value of a parameter KEY=VALUE of a URL; empty if it is not there.
std::string parameter(const std::string& parameters, const std::string& key) {
    for (std::size_t at = 0; at < parameters.size();) {
        const std::size_t end = std::min(parameters.find_first_of("&,", at), parameters.size());
        if (parameters.compare(at, key.size() + 1, key + "=") == 0)
            return parameters.substr(at + key.size() + 1, end - at - key.size() - 1);
        at = end + 1;
    }
    return {};
}

class Socket {
  public:
    explicit Socket(int type) : fd_(::socket(AF_INET, type | SOCK_NONBLOCK | SOCK_CLOEXEC, 0)) {}
    ~Socket() {
        if (fd_ >= 0) ::close(fd_);
    }
    Socket(const Socket&) = delete;
    Socket& operator=(const Socket&) = delete;
    int fd() const { return fd_; }
    /// False on timeout or a signal.
    bool wait(short events) const {
        pollfd poll = {fd_, events, 0};
        return ::poll(&poll, 1, kWaitMs) == 1;
    }
    template <typename T>
    bool set(int level, int option, const T& value) const {
        return ::setsockopt(fd_, level, option, &value, sizeof(value)) == 0;
    }

  private:
    int fd_;
};

std::string reason(const char* doing) {
    return std::string(doing) + ": " + std::strerror(errno);
}

const sockaddr* as_address(const sockaddr_in& address) {
    return reinterpret_cast<const sockaddr*>(&address);
}

/// Joins the group, sends liblcm's own self test and waits for anything to come back.
std::string multicast_unreachable(const sockaddr_in& group, unsigned char ttl) {
    const Socket socket(SOCK_DGRAM);
    if (socket.fd() < 0 || !socket.set(SOL_SOCKET, SO_REUSEADDR, 1)) return reason("no socket");
    if (::bind(socket.fd(), as_address(group), sizeof(group)) != 0) return reason("cannot bind");
    const ip_mreq membership = {group.sin_addr, {INADDR_ANY}};
    if (!socket.set(IPPROTO_IP, IP_ADD_MEMBERSHIP, membership)) return reason("cannot join the group");
    socket.set(IPPROTO_IP, IP_MULTICAST_TTL, ttl);
    static constexpr char kSelfTest[] = "LC02\0\0\0\0LCM_SELF_TEST\0lcm self test";
    if (::sendto(socket.fd(), kSelfTest, sizeof(kSelfTest) - 1, 0, as_address(group), sizeof(group)) < 0)
        return reason("cannot send");
    return socket.wait(POLLIN) ? std::string() : "nothing that is sent comes back (route, firewall)";
}

/// Connects and says hello, as a tcpq client does.
std::string server_unreachable(const sockaddr_in& server) {
    const Socket socket(SOCK_STREAM);
    if (socket.fd() < 0) return reason("no socket");
    if (::connect(socket.fd(), as_address(server), sizeof(server)) != 0) {
        if (errno != EINPROGRESS) return reason("cannot connect");
        if (!socket.wait(POLLOUT)) return "no answer";
        socklen_t size = sizeof(errno);
        ::getsockopt(socket.fd(), SOL_SOCKET, SO_ERROR, &errno, &size);
        if (errno != 0) return reason("cannot connect");
    }
    static constexpr std::array<unsigned char, 8> kClient{0x28, 0x76, 0x17, 0xfb, 0, 0, 1, 0};
    static constexpr std::array<unsigned char, 4> kServer{0x28, 0x76, 0x17, 0xfa};
    if (::send(socket.fd(), kClient.data(), kClient.size(), MSG_NOSIGNAL) < 0) return reason("cannot send");
    std::array<unsigned char, 8> answer{};
    for (std::size_t got = 0; got < answer.size();) {
        const bool ready = socket.wait(POLLIN);
        const ssize_t n = ready ? ::recv(socket.fd(), answer.data() + got, answer.size() - got, 0) : 0;
        if (n <= 0) return "whoever listens there does not answer as an LCM server";
        got += static_cast<std::size_t>(n);
    }
    return std::memcmp(answer.data(), kServer.data(), kServer.size()) == 0
               ? std::string()
               : "whoever listens there is no LCM server";
}

}  // namespace

/// One question to the resolver.
struct Endpoint::Lookup {
    std::mutex mutex;
    std::condition_variable changed;
    bool done = false;
    int error = 0;
    in_addr address = {};
};

Endpoint::~Endpoint() = default;

Endpoint::Endpoint(const std::string& url) : url_(url) {
    const std::size_t colon = url.find("://");
    provider_ = url.substr(0, std::min(colon, url.size()));
    if (colon == std::string::npos || (!is_network() && provider_ != "memq" && provider_ != "file")) {
        malformed(url, "the provider must be udpm, mpudpm, tcpq, memq or file");
    }
    const std::string rest = url.substr(colon + 3);
    const std::size_t question = std::min(rest.find('?'), rest.size());
    host_ = rest.substr(0, question);
    parameters_ = rest.substr(std::min(question + 1, rest.size()));
    check_parameters();
    if (is_log()) check_log();
    if (!is_network()) return;
    const std::size_t port = host_.find(':');
    port_ = is_multicast() ? kMulticastPort : kServerPort;
    if (port != std::string::npos) {
        port_ = static_cast<std::uint16_t>(number_in(url, "the port", host_.substr(port + 1), 1, 65535));
        host_.resize(port);
    }
    if (host_.empty()) host_ = is_multicast() ? "239.255.76.67" : "127.0.0.1";
    resolved_ = ::inet_pton(AF_INET, host_.c_str(), &address_) == 1;
    if (is_multicast()) {
        check_multicast();
    } else if (host_.find_first_not_of("abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789.-_") !=
               std::string::npos) {
        malformed(url, "'" + host_ + "' is neither a name nor an IPv4 address");
    }
}

void Endpoint::check_parameters() const {
    const std::vector<std::string> known = known_parameters(provider_);
    std::vector<std::string> seen;
    for (std::size_t at = 0; at < parameters_.size();) {
        const std::size_t end = std::min(parameters_.find_first_of("&,", at), parameters_.size());
        const std::string parameter = parameters_.substr(at, end - at);
        const std::string key = parameter.substr(0, parameter.find('='));
        at = end + 1;
        if (std::find(known.begin(), known.end(), key) == known.end()) {
            std::string names;
            for (const std::string& name : known) names += (names.empty() ? "" : ", ") + name;
            malformed(url_, "'" + key + "' is not an option of " + provider_ +
                                (names.empty() ? ", which has none" : "; they are " + names));
        }
        if (parameter.size() <= key.size() + 1) malformed(url_, key + " has no value");
        if (std::find(seen.begin(), seen.end(), key) != seen.end()) malformed(url_, key + " is given twice");
        seen.push_back(key);
    }
}

void Endpoint::check_multicast() const {
    if (!resolved_ || !IN_MULTICAST(ntohl(address_.s_addr)))
        malformed(url_, "'" + host_ + "' is no multicast address (224.0.0.0 to 239.255.255.255)");
    const std::string ttl = parameter(parameters_, "ttl"), buffer = parameter(parameters_, "recv_buf_size");
    if (!ttl.empty()) number_in(url_, "ttl", ttl, 0, 255);
    if (!buffer.empty()) number_in(url_, "recv_buf_size", buffer, 1, 0x7fffffff);
}

void Endpoint::check_log() const {
    if (host_.empty()) malformed(url_, "names no file");
    const std::string mode = parameter(parameters_, "mode");
    if (!mode.empty() && mode != "r" && mode != "w" && mode != "a")
        malformed(url_, "mode is '" + mode + "', it must be r, w or a");
    if (mode.empty() || mode == "r") FileBytes readable(host_);
}

/// Asks on a thread of its own: without a network the resolver takes many seconds.
std::string Endpoint::resolve() {
    if (!lookup_) {
        lookup_ = std::make_shared<Lookup>();
        std::thread([lookup = lookup_, host = host_] {
            addrinfo wanted = {};
            wanted.ai_family = AF_INET;
            addrinfo* found = nullptr;
            const int error = ::getaddrinfo(host.c_str(), nullptr, &wanted, &found);
            const std::lock_guard lock(lookup->mutex);
            if (error == 0) lookup->address = reinterpret_cast<const sockaddr_in*>(found->ai_addr)->sin_addr;
            if (found != nullptr) ::freeaddrinfo(found);
            lookup->error = error;
            lookup->done = true;
            lookup->changed.notify_all();
        }).detach();
    }
    std::unique_lock lock(lookup_->mutex);
    if (!lookup_->changed.wait_for(lock, std::chrono::milliseconds(kWaitMs), [&] { return lookup_->done; }))
        return "still looking up " + host_;
    const int error = lookup_->error;
    address_ = lookup_->address;
    lock.unlock();
    lookup_.reset();  // a server may move: asked again for the next connection
    return error == 0 ? std::string() : host_ + ": " + ::gai_strerror(error);
}

std::string Endpoint::unreachable() {
    if (!is_network()) return {};
    if (!resolved_) {
        std::string why = resolve();
        if (!why.empty()) return why;
    }
    sockaddr_in address = {};
    address.sin_family = AF_INET;
    address.sin_port = htons(port_);
    address.sin_addr = address_;
    if (!is_multicast()) return server_unreachable(address);
    const std::string ttl = parameter(parameters_, "ttl");
    return multicast_unreachable(
        address, static_cast<unsigned char>(ttl.empty() ? 0 : number_in(url_, "ttl", ttl, 0, 255)));
}

std::string Endpoint::url_for_liblcm() const {
    if (!is_network()) return url_;
    std::array<char, INET_ADDRSTRLEN> text{};
    ::inet_ntop(AF_INET, &address_, text.data(), text.size());
    return provider_ + "://" + text.data() + ":" + std::to_string(port_) +
           (parameters_.empty() ? "" : "?" + parameters_);
}

}  // namespace planemap::messages
