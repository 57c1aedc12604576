// SPDX-License-Identifier: BSD-3-Clause
#include "messages/reassembly.hpp"

#include <gtest/gtest.h>

#include "core/files.hpp"
#include "temporary_folder.hpp"

namespace planemap::messages {
namespace {

TEST(Reassembly, ReadsTheKernelsCount) {
    const test::TemporaryFolder folder;
    const auto read = [&](const std::string& text) {
        write_file(folder / "snmp", text);
        return failed_reassemblies(folder / "snmp");
    };
    EXPECT_EQ(
        read("Ip: Forwarding ReasmReqds ReasmOKs ReasmFails FragOKs\nIp: 2 11703 223 87 0\nIcmp: InMsgs\n"
             "Icmp: 9\n"),
        87);
    EXPECT_EQ(read("Icmp: InMsgs\nIcmp: 9\nIp: ReasmFails\nIp: 5\n"), 5);
    EXPECT_EQ(read("Ip: Forwarding\nIp: 2\n"), std::nullopt);
    EXPECT_EQ(read("Ip: ReasmFails\n"), std::nullopt);
    EXPECT_EQ(read(""), std::nullopt);
    EXPECT_EQ(failed_reassemblies(folder / "none"), std::nullopt);
    EXPECT_TRUE(failed_reassemblies().has_value()) << "of this machine";
}

}  // namespace
}  // namespace planemap::messages
