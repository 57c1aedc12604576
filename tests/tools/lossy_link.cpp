// SPDX-License-Identifier: BSD-3-Clause
// lossy_link A B LOSS JITTER_MS: a cable between two network interfaces that loses packets and delays each by
// up to JITTER_MS, so that they also arrive out of order; what `tc netem` does where the kernel has it.
// Prints at SIGTERM how many UDP packets came and how many of them it lost. The same packets in the same
// order are lost in every run.
#include <linux/if_packet.h>
#include <net/ethernet.h>
#include <net/if.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <random>
#include <vector>

namespace {

using Clock = std::chrono::steady_clock;

constexpr std::size_t kOffloads = 10;  // struct virtio_net_hdr, whose header is no C++

volatile std::sig_atomic_t stopped = 0;

[[noreturn]] void fail(const char* what) {
    std::perror(what);
    std::exit(1);
}

/// All packets that come in at an interface. Their headers say what sums and cuts the kernel left to the
/// hardware, and go along, so that the other side's kernel makes up for it.
int open_interface(const char* name) {
    const int fd = ::socket(AF_PACKET, SOCK_RAW, htons(ETH_P_ALL));
    if (fd < 0) fail("socket");
    sockaddr_ll address = {};
    address.sll_family = AF_PACKET;
    address.sll_protocol = htons(ETH_P_ALL);
    address.sll_ifindex = static_cast<int>(::if_nametoindex(name));
    const int on = 1, bytes = 16 << 20;
    if (address.sll_ifindex == 0 ||
        ::bind(fd, reinterpret_cast<const sockaddr*>(&address), sizeof(address)) != 0 ||
        ::setsockopt(fd, SOL_PACKET, PACKET_VNET_HDR, &on, sizeof(on)) != 0)
        fail(name);
    ::setsockopt(fd, SOL_PACKET, PACKET_IGNORE_OUTGOING, &on, sizeof(on));
    if (::setsockopt(fd, SOL_SOCKET, SO_RCVBUFFORCE, &bytes, sizeof(bytes)) != 0)
        ::setsockopt(fd, SOL_SOCKET, SO_RCVBUF, &bytes, sizeof(bytes));
    return fd;
}

bool is_udp(const std::vector<std::uint8_t>& packet) {
    constexpr std::size_t kEthernet = kOffloads, kIp = kEthernet + ETH_HLEN;
    return packet.size() > kIp + 9 && packet[kEthernet + 12] == 0x08 && packet[kEthernet + 13] == 0x00 &&
           packet[kIp + 9] == IPPROTO_UDP;
}

struct Packet {
    int to;
    std::vector<std::uint8_t> bytes;
};

}  // namespace

int main(int argc, char** argv) {
    if (argc != 5) {
        std::fprintf(stderr, "lossy_link A B LOSS JITTER_MS\n");
        return 2;
    }
    const std::array<int, 2> ends = {open_interface(argv[1]), open_interface(argv[2])};
    const double loss = std::atof(argv[3]);
    const auto jitter = static_cast<std::uint64_t>(1000 * std::atof(argv[4]));
    struct sigaction action = {};
    action.sa_handler = [](int) { stopped = 1; };
    ::sigaction(SIGTERM, &action, nullptr);

    std::mt19937_64 random(1);
    std::multimap<Clock::time_point, Packet> under_way;
    std::vector<std::uint8_t> buffer(kOffloads + (1 << 17));
    long udp = 0, lost = 0;
    while (stopped == 0) {
        std::array<pollfd, 2> polls = {pollfd{ends[0], POLLIN, 0}, pollfd{ends[1], POLLIN, 0}};
        ::poll(polls.data(), polls.size(), under_way.empty() ? 100 : 1);
        for (std::size_t from = 0; from < 2; ++from) {
            for (ssize_t n = 0; (n = ::recv(ends[from], buffer.data(), buffer.size(), MSG_DONTWAIT)) > 0;) {
                Packet packet{ends[1 - from], {buffer.begin(), buffer.begin() + n}};
                const bool counts = is_udp(packet.bytes);
                udp += counts;
                if (std::generate_canonical<double, 53>(random) < loss) {
                    lost += counts;
                    continue;
                }
                const auto delay = std::chrono::microseconds(jitter == 0 ? 0 : random() % (jitter + 1));
                under_way.emplace(Clock::now() + delay, std::move(packet));
            }
        }
        while (!under_way.empty() && under_way.begin()->first <= Clock::now()) {
            const Packet& packet = under_way.begin()->second;
            if (::send(packet.to, packet.bytes.data(), packet.bytes.size(), 0) < 0) std::perror("send");
            under_way.erase(under_way.begin());
        }
    }
    std::printf("udp %ld lost %ld\n", udp, lost);
    return 0;
}
