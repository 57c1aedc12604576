// SPDX-License-Identifier: BSD-3-Clause
// What an LCM URL names, and whether it can be reached now. liblcm itself says neither in a usable way: it
// takes names of tcpq servers for addresses, blocks for minutes in connect() or in its self test, prints a
// page each time, and calls a connection good that there is not.
#pragma once

#include <netinet/in.h>

#include <cstdint>
#include <memory>
#include <string>

namespace planemap::messages {

class Endpoint {
  public:
    /// Throws std::runtime_error that names the URL and what is wrong with it if no network can ever make it
    /// good: an unknown provider or option, an address or port that is none, a log that cannot be read.
    explicit Endpoint(const std::string& url);
    ~Endpoint();

    const std::string& url() const { return url_; }
    bool is_network() const { return provider_ == "udpm" || provider_ == "mpudpm" || provider_ == "tcpq"; }
    bool is_multicast() const { return provider_ == "udpm" || provider_ == "mpudpm"; }
    bool is_log() const { return provider_ == "file"; }
    /// True for memq://, on which a process hears nobody but itself.
    bool in_process() const { return provider_ == "memq"; }

    /// Empty if it can be reached now, else the reason. Takes a second at most, and ends early on a signal.
    std::string unreachable();
    /// The URL as liblcm understands it: after unreachable(), the server's address in place of its name.
    std::string url_for_liblcm() const;

  private:
    struct Lookup;
    void check_parameters() const;
    void check_multicast() const;
    void check_log() const;
    std::string resolve();

    std::string url_, provider_, host_, parameters_;
    std::uint16_t port_ = 0;
    in_addr address_ = {};
    bool resolved_ = false;
    std::shared_ptr<Lookup> lookup_;  ///< shared with the thread that asks, which nothing can interrupt
};

}  // namespace planemap::messages
