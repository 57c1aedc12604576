// SPDX-License-Identifier: BSD-3-Clause
#include "messages/bus.hpp"

#include <spdlog/spdlog.h>

#include <cerrno>
#include <chrono>
#include <cstdlib>
#include <fstream>
#include <stdexcept>

namespace planemap {

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

/// liblcm's own word on an unknown provider is a second line on stderr; ours says what there is.
void check_provider(const std::string& url) {
    for (const char* provider : {"udpm://", "mpudpm://", "tcpq://", "memq://", "file://"}) {
        if (url.rfind(provider, 0) == 0) return;
    }
    throw std::runtime_error("LCM URL '" + url + "': the provider must be udpm, tcpq, memq or file");
}

}  // namespace

struct Bus::Subscriber {
    Bus* bus;
    Handler handler;
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

Bus::Bus(const std::string& url) : url_(completed(url)) {
    check_provider(url_);
    lcm_ = std::make_unique<lcm::LCM>(url_);
    if (!lcm_->good()) throw std::runtime_error("LCM URL '" + url_ + "' cannot be opened");
    const std::string advice = receive_buffer_advice(url_);
    if (!advice.empty()) spdlog::warn("{}", advice);
}

Bus::~Bus() = default;

void Bus::publish_bytes(const std::string& channel, std::span<const std::uint8_t> bytes) {
    if (lcm_->publish(channel, bytes.data(), static_cast<unsigned>(bytes.size())) != 0) {
        throw std::runtime_error("LCM URL '" + url_ + "': " + channel + " (" + std::to_string(bytes.size()) +
                                 " bytes) cannot be sent");
    }
}

void Bus::subscribe(const std::string& channel, Handler handler, int capacity) {
    subscribers_.push_back(std::make_unique<Subscriber>(Subscriber{this, std::move(handler)}));
    lcm::Subscription* subscription =
        lcm_->subscribeFunction(channel, &Bus::dispatch, subscribers_.back().get());
    if (subscription == nullptr)
        throw std::runtime_error("LCM URL '" + url_ + "': cannot subscribe to " + channel);
    subscription->setQueueCapacity(in_process() ? 0 : capacity);
}

void Bus::dispatch(const lcm::ReceiveBuffer* buffer, const std::string& channel, Subscriber* subscriber) {
    try {
        const auto* bytes = static_cast<const std::uint8_t*>(buffer->data);
        subscriber->handler({channel, {bytes, buffer->data_size}, buffer->recv_utime});
    } catch (const std::exception& error) {
        subscriber->bus->report(channel, error.what());
    } catch (...) {
        subscriber->bus->report(channel, "unknown exception");
    }
}

void Bus::report(std::string_view channel, const char* reason) {
    ++handler_errors_;
    const std::int64_t now = now_us();
    if (now - last_report_us_ < 1000000) return;  // once per burst
    last_report_us_ = now;
    spdlog::warn("{}: message dropped ({} so far): {}", channel, handler_errors_, reason);
}

bool Bus::handle(int timeout_ms) {
    errno = 0;
    const int result = lcm_->handleTimeout(timeout_ms);
    if (result < 0 && errno == EINTR) return false;  // a signal, most likely the one that asks to stop
    if (result < 0) throw std::runtime_error("LCM URL '" + url_ + "': receiving failed");
    return result > 0;
}

void Bus::drain() {
    while (handle(0)) {
    }
}

}  // namespace planemap
