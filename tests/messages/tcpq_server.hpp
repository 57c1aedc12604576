// SPDX-License-Identifier: BSD-3-Clause
// A server of LCM's tcpq protocol that a test can start late and take away: everything published goes to
// every client, whatever it subscribed to (liblcm's clients sort out what they want).
#pragma once

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <string>
#include <thread>
#include <vector>

namespace planemap::test {

class TcpqServer {
  public:
    /// port 0: any that is free. greets: false for one that accepts and says nothing.
    explicit TcpqServer(std::uint16_t port = 0, bool greets = true)
        : listener_(::socket(AF_INET, SOCK_STREAM, 0)), greets_(greets) {
        const int on = 1;
        ::setsockopt(listener_, SOL_SOCKET, SO_REUSEADDR, &on, sizeof(on));
        sockaddr_in address = {};
        address.sin_family = AF_INET;
        address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
        address.sin_port = htons(port);
        EXPECT_EQ(::bind(listener_, reinterpret_cast<sockaddr*>(&address), sizeof(address)), 0);
        EXPECT_EQ(::listen(listener_, 8), 0);
        socklen_t size = sizeof(address);
        ::getsockname(listener_, reinterpret_cast<sockaddr*>(&address), &size);
        port_ = ntohs(address.sin_port);
        thread_ = std::thread([this] { serve(); });
    }
    /// Goes as a server does that is killed: all connections end.
    ~TcpqServer() {
        stop_ = true;
        thread_.join();
        ::close(listener_);
        for (const Client& client : clients_) ::close(client.fd);
    }
    TcpqServer(const TcpqServer&) = delete;
    TcpqServer& operator=(const TcpqServer&) = delete;

    std::uint16_t port() const { return port_; }
    std::string url() const { return "tcpq://127.0.0.1:" + std::to_string(port_); }
    /// Leaves what comes from now on in the kernel, as a server does that hangs.
    void take_no_more() { hung_ = true; }
    void go_on() { hung_ = false; }
    int subscriptions() const { return subscriptions_; }  ///< that clients asked for so far

  private:
    struct Client {
        int fd;
        std::string received;
        bool greeted = false;
    };

    void serve() {
        while (!stop_) {
            if (hung_) {
                std::this_thread::sleep_for(std::chrono::milliseconds(5));
                continue;
            }
            std::vector<pollfd> polls{{listener_, POLLIN, 0}};
            for (const Client& client : clients_) polls.push_back({client.fd, POLLIN, 0});
            ::poll(polls.data(), polls.size(), 10);
            std::vector<Client> alive;
            for (std::size_t i = 0; i < clients_.size(); ++i) {
                if (polls[i + 1].revents == 0 || receive(clients_[i])) {
                    alive.push_back(std::move(clients_[i]));
                } else {
                    ::close(clients_[i].fd);
                }
            }
            clients_ = std::move(alive);
            if (polls[0].revents != 0) clients_.push_back({::accept(listener_, nullptr, nullptr), {}});
            for (Client& client : clients_) take_messages(client);
        }
    }
    static bool receive(Client& client) {
        std::array<char, 65536> bytes;
        const ssize_t n = ::recv(client.fd, bytes.data(), bytes.size(), MSG_DONTWAIT);
        if (n > 0) client.received.append(bytes.data(), static_cast<std::size_t>(n));
        return n > 0;
    }
    static std::uint32_t word(const std::string& bytes, std::size_t at) {
        std::uint32_t value = 0;
        for (std::size_t i = 0; i < 4; ++i) value = value << 8 | static_cast<std::uint8_t>(bytes[at + i]);
        return value;
    }
    void take_messages(Client& client) {
        std::string& in = client.received;
        if (!client.greeted && in.size() >= 8 && greets_) {
            in.erase(0, 8);
            client.greeted = true;
            static constexpr std::array<unsigned char, 8> kHello{0x28, 0x76, 0x17, 0xfa, 0, 0, 1, 0};
            ::send(client.fd, kHello.data(), kHello.size(), MSG_NOSIGNAL);
        }
        while (client.greeted && in.size() >= 8) {
            const std::uint32_t type = word(in, 0), channel = word(in, 4);
            std::size_t size = 8 + channel;
            if (type == 1) {
                if (in.size() < size + 4) return;
                size += 4 + word(in, size);
            }
            if (in.size() < size) return;
            if (type == 2) ++subscriptions_;
            if (type == 1) {
                for (const Client& to : clients_) {
                    if (to.greeted) ::send(to.fd, in.data(), size, MSG_NOSIGNAL);
                }
            }
            in.erase(0, size);
        }
    }

    int listener_;
    bool greets_;
    std::uint16_t port_ = 0;
    std::vector<Client> clients_;
    std::atomic<bool> stop_{false}, hung_{false};
    std::atomic<int> subscriptions_{0};
    std::thread thread_;
};

}  // namespace planemap::test
