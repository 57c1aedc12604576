// SPDX-License-Identifier: BSD-3-Clause
#include "messages/bus.hpp"

#include <spdlog/spdlog.h>

#include <chrono>
#include <cstdlib>
#include <fstream>
#include <stdexcept>
#include <utility>

#include "messages/channels.hpp"
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

Bus::Bus(const std::string& url, const std::string& channel_prefix)
    : prefix_(checked_prefix(channel_prefix)), connection_(completed(url), complaints_) {
    if (!in_process()) session_ = random_session();
    const std::string advice = receive_buffer_advice(this->url());
    if (!advice.empty()) spdlog::warn("{}", advice);
}

/// The channel as the bus knows it. liblcm would print a line, on some transports, and send nothing.
std::string Bus::full_name(const std::string& channel) const {
    std::string name = prefix_ + channel;
    if (name.size() <= channels::kMaxChannel) return name;
    throw std::invalid_argument("the channel " + name + " has " + std::to_string(name.size()) +
                                " characters; LCM allows " + std::to_string(channels::kMaxChannel));
}

void Bus::publish_bytes(const std::string& channel, std::span<const std::uint8_t> bytes) {
    connection_.send(full_name(channel), bytes);
}

void Bus::subscribe(const std::string& channel, Handler handler, int capacity) {
    const bool alternatives = channel.find('|') != std::string::npos;
    const std::string pattern = alternatives ? "(" + channel + ")" : channel;
    connection_.subscribe(
        prefix_ + pattern,
        [this, handler = std::move(handler)](const std::string& name, const lcm::ReceiveBuffer& buffer) {
            dispatch(handler, name, buffer);
        },
        capacity);
}

void Bus::dispatch(const Handler& handler, const std::string& channel, const lcm::ReceiveBuffer& buffer) {
    try {
        const auto* bytes = static_cast<const std::uint8_t*>(buffer.data);
        const std::string_view name = std::string_view(channel).substr(prefix_.size());
        handler({name, {bytes, buffer.data_size}, buffer.recv_utime});
    } catch (const std::exception& error) {
        report(channel, error.what());
    } catch (...) {
        report(channel, "unknown exception");
    }
}

void Bus::report(std::string_view channel, const char* reason) {
    if (reported_ == connection_.received() && reported_reason_ == reason) return;
    reported_ = connection_.received();
    reported_reason_ = reason;
    complaints_.add(std::string(channel) + ": message dropped: " + reason);
}

std::string Bus::trouble() const {
    return connection_.trouble();
}

void Bus::drain() {
    while (handle(0)) {
    }
}

}  // namespace planemap::messages
